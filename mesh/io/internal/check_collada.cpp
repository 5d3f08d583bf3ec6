// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/io/internal/scene_file.h"
#include "mesh/io/internal/xml_events.h"
#include "spheretree/error.h"
#include "spheretree/text.h"

#include <assimp/fast_atof.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace spherule::internal {
namespace {

// Stands for assimp's own exception, which its library does not export. Not thrown: what is given
// to the parser is a number.
struct UnreadableNumber {
  template <class... Parts>
  explicit UnreadableNumber(Parts&&...) {}
};

// Every number of the text, wherever it stands.
void check_decimals(std::string_view text, const std::string& subject) {
  constexpr std::string_view kSeparators = " \t\r\n<>\"'=";
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = std::min(text.find_first_not_of(kSeparators, at), text.size());
    const std::size_t end = std::min(text.find_first_of(kSeparators, begin), text.size());
    at = end;
    const std::string token(text.substr(begin, end - begin));
    const std::optional<double> value = finite_number(token);
    if (!value) continue;
    ai_real read = 0;
    Assimp::fast_atoreal_move<ai_real, UnreadableNumber>(token.c_str(), read);
    // Below the normal floats the error is absolute and far below any model's size.
    const double error = std::abs(static_cast<double>(read) - *value);
    if (!(error <= kDecimalError * std::abs(*value) + 0x1p-100) && std::abs(*value) <= 0x1p127) {
      throw Error(subject, "the number " + token.substr(0, 60) + " cannot be read exactly enough");
    }
  }
}

// The indices of triangles and the corner counts of polygons: digits and white space only. At
// anything else assimp reads on for ever; a negative index it takes for zero, a long one wraps.
void check_indices(std::string_view text, std::string_view element, const std::string& subject) {
  constexpr std::size_t kMaxDigits = 9;
  std::string opening("<");
  opening.append(element);
  for (std::size_t at = text.find(opening); at < text.size(); at = text.find(opening, at)) {
    at += opening.size();
    if (at < text.size() && std::string_view("> \t\r\n").find(text[at]) == std::string_view::npos) {
      continue;  // another element whose name begins alike
    }
    std::size_t digits = 0;
    for (at = std::min(text.find('>', at), text.size() - 1) + 1; at < text.size(); ++at) {
      const char c = text[at];
      digits = c >= '0' && c <= '9' ? digits + 1 : 0;
      if (digits > kMaxDigits) throw Error(subject, "an index of more than nine digits");
      if (c == '<') break;
      if (digits == 0 && std::string_view(" \t\r\n").find(c) == std::string_view::npos) {
        throw Error(subject, "an index that is not a whole number");
      }
    }
    if (text.substr(at, 2) != "</") throw Error(subject, "something between the indices");
  }
}

// Reads <unit meter="...">, which stands before the libraries.
class UnitFinder : public XmlHandler {
 public:
  struct Done {};

  void open(std::string_view name, const XmlAttributes& attributes, std::size_t) override {
    name.remove_prefix(name.rfind('|') + 1);
    if (name.starts_with("library_")) throw Done();
    if (name != "unit") return;
    const std::string_view text = attributes.find("meter").value_or("1");
    const double size = finite_number(text).value_or(0.0);
    if (size > 0.0) metres = size;
    throw Done();
  }
  void close() override {}

  double metres = 1.0;
};

}  // namespace

double collada_unit(std::string_view text, const std::string& subject) {
  UnitFinder finder;
  try {
    parse_xml(text, subject, finder);
  } catch (const UnitFinder::Done&) {
  } catch (const Error&) {
    // What is wrong with the text, the reader of the mesh says, which is less strict.
  }
  return finder.metres;
}

void check_collada(std::string_view text, const std::string& subject) {
  check_decimals(text, subject);
  for (const std::string_view element : {"p", "ph", "vcount", "v"}) {
    check_indices(text, element, subject);
  }
}

}  // namespace spherule::internal
