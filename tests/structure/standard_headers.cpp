// SPDX-License-Identifier: BSD-3-Clause
#include "tests/structure/standard_headers.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string_view>

namespace spherule {
namespace {

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
     "pop_heap push_heap make_heap remove remove_if replace reverse rotate shuffle sort "
     "stable_sort "
     "transform unique upper_bound"},
    {"array", "array get to_array"},
    {"atomic", "atomic"},
    {"bit",
     "bit_cast bit_ceil bit_floor bit_width countl_zero countr_one countr_zero endian "
     "has_single_bit popcount"},
    {"bitset", "bitset"},
    {"charconv", "chars_format from_chars to_chars"},
    {"chrono", "chrono"},
    {"condition_variable", "condition_variable"},
    {"cmath",
     "nan abs acos asin atan atan2 cbrt ceil copysign cos exp fabs floor fma fmod frexp hypot "
     "isfinite "
     "isinf isnan ldexp llround log log10 log2 lround nextafter pow remainder round signbit sin "
     "sqrt tan trunc"},
    {"cstddef", "byte max_align_t ptrdiff_t size_t"},
    {"cstdint", "int16_t int32_t int64_t int8_t uint16_t uint32_t uint64_t uint8_t"},
    {"cstdio", "fclose fflush fopen fprintf fputs printf puts remove rename size_t snprintf"},
    {"cstdlib", "abort abs atexit exit getenv size_t strtod strtol system"},
    {"cstring", "memchr memcmp memcpy memset size_t strcmp strerror strlen"},
    {"ctime", "size_t time time_t"},
    {"deque", "deque"},
    {"exception", "current_exception exception exception_ptr rethrow_exception terminate"},
    {"filesystem", "filesystem"},
    {"fstream", "fstream ifstream ofstream"},
    {"functional", "cref function greater hash invoke less plus ref reference_wrapper"},
    {"future", "async future promise"},
    {"initializer_list", "initializer_list"},
    {"iomanip", "quoted setfill setprecision setw"},
    {"iostream", "cerr cin cout"},
    {"iterator",
     "back_inserter distance inserter istream_iterator istreambuf_iterator make_move_iterator next "
     "ostream_iterator prev"},
    {"limits", "numeric_limits"},
    {"list", "list"},
    {"map", "map multimap"},
    {"memory",
     "addressof enable_shared_from_this make_shared make_unique shared_ptr unique_ptr weak_ptr"},
    {"mutex", "call_once lock_guard mutex once_flag scoped_lock unique_lock"},
    {"numbers", "numbers"},
    {"numeric",
     "accumulate exclusive_scan gcd inclusive_scan inner_product iota lcm partial_sum reduce"},
    {"optional", "nullopt nullopt_t optional"},
    {"queue", "priority_queue queue"},
    {"random",
     "mt19937 mt19937_64 normal_distribution uniform_int_distribution uniform_real_distribution"},
    {"regex", "regex regex_match regex_replace regex_search smatch sregex_iterator"},
    {"set", "multiset set"},
    {"span", "span"},
    {"sstream", "istringstream ostringstream stringstream"},
    {"stdexcept",
     "domain_error invalid_argument logic_error out_of_range range_error runtime_error"},
    {"stop_token", "stop_callback stop_source stop_token"},
    {"string", "getline size_t stod stoi string to_string"},
    {"string_view", "string_view"},
    {"system_error",
     "errc error_code error_condition make_error_code system_category system_error"},
    {"thread", "jthread this_thread thread"},
    {"tuple", "get make_tuple tie tuple"},
    {"type_traits",
     "conditional_t decay_t enable_if_t is_base_of_v is_convertible_v is_floating_point_v "
     "is_integral_v "
     "is_invocable_v is_same_v remove_const_t remove_cvref_t remove_reference_t"},
    {"unordered_map", "unordered_map"},
    {"unordered_set", "unordered_set"},
    {"utility", "as_const exchange forward get initializer_list make_pair move pair swap"},
    {"variant", "get get_if holds_alternative monostate variant visit"},
    {"vector", "vector"}};

// The namespaces of others, and how their headers begin.
struct Others {
  std::string_view name;
  std::string_view headers;
};
constexpr Others kOthers[] = {
    {"CLI", "CLI/"},     {"YAML", "yaml-cpp/"},   {"benchmark", "benchmark/"},
    {"boost", "boost/"}, {"fcl", "fcl/"},         {"nlohmann", "nlohmann/"},
    {"ompl", "ompl/"},   {"openvdb", "openvdb/"}, {"pybind11", "pybind11/"},
    {"tbb", "tbb/"},     {"testing", "gtest/"},   {"tinyxml2", "tinyxml2.h"}};

// Begin the names of Eigen that <Eigen/Core> does not declare.
constexpr std::string_view kGeometry[] = {"AlignedBox", "AngleAxis", "Isometry", "Quaternion",
                                          "Translation"};

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

}  // namespace

std::vector<std::string> missing_standard_headers(const Sources& sources, const std::string& file) {
  const std::set<const Source*> seen = with_included(sources, file);
  std::set<std::string> headers;
  for (const Source* source : seen) {
    for (const Include& include : source->includes) {
      if (!include.is_ours) headers.insert(include.target);
    }
  }
  const SourceNames& used = sources.at(file).names;
  const auto names_of = [&](std::string_view scope) {
    const auto found = used.of_scope.find(scope);
    return found == used.of_scope.end() ? std::set<std::string>() : found->second;
  };
  std::vector<std::string> missing;
  for (const std::string& name : names_of("std")) {
    const auto known = declaring().find(name);
    if (known == declaring().end()) continue;
    const std::set<std::string>& choice = known->second;
    const auto is_there = [&](const std::string& header) { return headers.contains(header); };
    if (std::any_of(choice.begin(), choice.end(), is_there)) continue;
    missing.push_back("std::" + name + " needs <" + *choice.begin() + ">");
  }
  const auto includes = [&](std::string_view start) {
    return std::any_of(headers.begin(), headers.end(),
                       [&](const std::string& header) { return header.starts_with(start); });
  };
  for (const Others& others : kOthers) {
    if (names_of(others.name).empty() || includes(others.headers)) continue;
    // Classes of theirs may be declared for themselves.
    const auto opens = [&](const Source* source) {
      return source->names.namespaces.contains(others.name);
    };
    if (std::none_of(seen.begin(), seen.end(), opens)) {
      missing.push_back(std::string(others.name) + ":: needs <" + std::string(others.headers) +
                        "...>");
    }
  }
  const std::set<std::string> of_eigen = names_of("Eigen");
  const auto is_geometry = [](const std::string& name) {
    return std::any_of(std::begin(kGeometry), std::end(kGeometry),
                       [&](std::string_view start) { return name.starts_with(start); });
  };
  if (std::any_of(of_eigen.begin(), of_eigen.end(), is_geometry) ||
      names_of(".").contains("cross")) {
    if (!includes("Eigen/Geometry") && !includes("Eigen/Dense")) {
      missing.emplace_back("Eigen:: needs <Eigen/Geometry>");
    }
  } else if (!of_eigen.empty() && !includes("Eigen/")) {
    missing.emplace_back("Eigen:: needs <Eigen/Core>");
  }
  return missing;
}

}  // namespace spherule
