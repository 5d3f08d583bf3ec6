// SPDX-License-Identifier: BSD-3-Clause
#include "tests/structure/standard_headers.h"

#include "tests/structure/repository.h"

#include <algorithm>
#include <array>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>

namespace spherule {
namespace {

namespace fs = std::filesystem;

// The names of a header that our sources are likely to use, with blanks between.
struct Header {
  std::string_view name;
  std::string_view declares;
};
constexpr Header kHeaders[] = {
    {"algorithm",
     "all_of any_of binary_search clamp copy copy_if copy_n count count_if equal equal_range "
     "fill fill_n find find_if for_each generate is_sorted lexicographical_compare lower_bound max "
     "max_element merge min min_element minmax minmax_element move none_of nth_element partition "
     "pop_heap push_heap make_heap remove_if replace reverse rotate shuffle sort stable_sort "
     "transform unique upper_bound"},
    {"array", "array get to_array"},
    {"atomic", "atomic"},
    {"chrono", "chrono"},
    {"cmath",
     "nan abs acos asin atan atan2 cbrt ceil copysign cos exp fabs floor fma fmod frexp hypot "
     "isfinite "
     "isinf isnan ldexp llround log log10 log2 lround nextafter pow remainder round signbit sin "
     "sqrt tan trunc"},
    {"cstddef", "byte max_align_t ptrdiff_t size_t"},
    {"cstdint", "int16_t int32_t int64_t int8_t uint16_t uint32_t uint64_t uint8_t"},
    {"cstdio", "size_t"},
    {"cstdlib", "abs size_t"},
    {"cstring", "size_t"},
    {"ctime", "size_t"},
    {"filesystem", "filesystem"},
    {"functional", "cref function greater hash invoke less plus ref reference_wrapper"},
    {"initializer_list", "initializer_list"},
    {"limits", "numeric_limits"},
    {"map", "map multimap"},
    {"memory",
     "addressof enable_shared_from_this make_shared make_unique shared_ptr unique_ptr weak_ptr"},
    {"optional", "nullopt nullopt_t optional"},
    {"set", "multiset set"},
    {"span", "span"},
    {"sstream", "istringstream ostringstream stringstream"},
    {"string", "getline size_t stod stoi string to_string"},
    {"string_view", "string_view"},
    {"tuple", "get make_tuple tie tuple"},
    {"type_traits",
     "conditional_t decay_t enable_if_t is_base_of_v is_convertible_v is_floating_point_v "
     "is_integral_v "
     "is_invocable_v is_same_v remove_const_t remove_cvref_t remove_reference_t"},
    {"utility", "as_const exchange forward get initializer_list make_pair move pair swap"},
    {"variant", "get get_if holds_alternative monostate variant visit"},
    {"vector", "vector"}};

// The headers that declare a name; none for a name that is not listed.
const std::map<std::string, std::set<std::string>>& declaring() {
  static const auto kDeclaring = [] {
    std::map<std::string, std::set<std::string>> result;
    for (const Header& header : kHeaders) {
      std::istringstream names{std::string(header.declares)};
      for (std::string name; names >> name;) result[name].emplace(header.name);
    }
    return result;
  }();
  return kDeclaring;
}

// The headers in angle brackets that a file includes, or that ours do which it includes.
void collect_includes(const fs::path& root, const fs::path& file, std::set<fs::path>& seen,
                      std::set<std::string>& headers) {
  if (!seen.insert(file).second || !fs::exists(root / file)) return;
  static const std::regex kInclude(R"re((?:^|\n) *# *include +([<"])([^>"]+))re");
  const std::string text = text_of(root / file);
  for (std::sregex_iterator at(text.begin(), text.end(), kInclude), end; at != end; ++at) {
    if ((*at)[1] == "<") {
      headers.insert((*at)[2]);
    } else {
      collect_includes(root, (*at)[2].str(), seen, headers);
    }
  }
}

}  // namespace

std::vector<std::string> missing_standard_headers(const fs::path& root, const fs::path& file) {
  std::set<fs::path> seen;
  std::set<std::string> headers;
  collect_includes(root, file, seen, headers);
  static const std::regex kNoCode(R"re(//[^\n]*|"(\\.|[^"\\\n])*")re");
  static const std::regex kName(R"re(std::(?:ranges::)?(\w+))re");
  const std::string code = std::regex_replace(text_of(root / file), kNoCode, "");
  std::set<std::string> names;
  for (std::sregex_iterator at(code.begin(), code.end(), kName), end; at != end; ++at) {
    names.insert((*at)[1]);
  }
  std::vector<std::string> missing;
  for (const std::string& name : names) {
    const auto known = declaring().find(name);
    if (known == declaring().end()) continue;
    const std::set<std::string>& choice = known->second;
    const auto is_there = [&](const std::string& header) { return headers.contains(header); };
    if (std::any_of(choice.begin(), choice.end(), is_there)) continue;
    missing.push_back("std::" + name + " needs <" + *choice.begin() + ">");
  }
  static const std::regex kGeometry(
      R"re(Eigen::(AlignedBox|AngleAxis|Isometry|Quaternion|Translation)|\.cross\()re");
  if (std::regex_search(code, kGeometry)) {
    if (!headers.contains("Eigen/Geometry") && !headers.contains("Eigen/Dense")) {
      missing.emplace_back("Eigen:: needs <Eigen/Geometry>");
    }
  } else if (code.find("Eigen::") != std::string::npos &&
             std::none_of(headers.begin(), headers.end(),
                          [](const std::string& header) { return header.starts_with("Eigen/"); })) {
    missing.emplace_back("Eigen:: needs <Eigen/Core>");
  }
  return missing;
}

}  // namespace spherule
