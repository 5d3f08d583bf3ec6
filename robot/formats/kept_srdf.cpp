// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "base/parser_fault.h"
#include "robot/files/format_text.h"
#include "robot/files/xml_file.h"
#include "robot/formats/sphere_documents.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

constexpr std::string_view kBlank = " \t\r";
constexpr std::string_view kIndent = "    ";  // where no line shows how far

// An element that is a child of the root, as its bytes from `begin` to before `end`.
struct XmlPart {
  std::string_view tag;
  std::size_t begin = 0;
  std::size_t end = 0;
};

// Positions of the elements of a well-formed document; meaningless of any other.
struct XmlParts {
  std::vector<XmlPart> children;
  std::size_t root_end = 0;  // where the root's end tag starts, or the "/>" of a root without one
  bool has_end_tag = true;
};

XmlParts parts_of(std::string_view text) {
  XmlParts parts;
  int depth = 0;
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at)) {
    const std::size_t other = end_of_other_markup(text, at);
    if (other != at) {
      at = other;
      continue;
    }
    const std::size_t end = end_of_tag(text, at);
    const std::string_view markup = text.substr(at, end - at);
    const bool closes = markup.starts_with("</");
    const bool is_whole = !closes && markup.ends_with("/>");
    if (closes) --depth;
    if (depth == 0 && (closes || is_whole)) {
      parts.root_end = closes ? at : end - 2;
      parts.has_end_tag = closes;
      break;
    }
    if (depth == 1 && !closes) {
      const std::string_view tag = markup.substr(1);
      parts.children.push_back({tag.substr(0, tag.find_first_of(" \t\r\n/>")), at, end});
    }
    if (depth == 1 && closes && !parts.children.empty()) parts.children.back().end = end;
    if (!closes && !is_whole) ++depth;
    at = end;
  }
  return parts;
}

// Where the line of a place starts, if nothing but blanks stands before it there.
std::optional<std::size_t> blank_line_start(std::string_view text, std::size_t at) {
  while (at > 0 && kBlank.find(text[at - 1]) != std::string_view::npos) --at;
  if (at > 0 && text[at - 1] != '\n') return std::nullopt;
  return at;
}

// Behind the end of the line if nothing more stands on it, else `at`.
std::size_t behind_line(std::string_view text, std::size_t at) {
  const std::size_t end = text.find_first_not_of(kBlank, at);
  return end != std::string_view::npos && text[end] == '\n' ? end + 1 : at;
}

std::string indent_at(std::string_view text, std::size_t at) {
  const auto start = blank_line_start(text, at);
  return std::string(start ? text.substr(*start, at - *start) : kIndent);
}

// Replaces [begin, end) of a text, by lines of their own unless `is_raw`.
struct Change {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::string text{};
  bool is_raw = false;
};

std::string changed(std::string_view text, std::vector<Change> changes) {
  const std::string_view line_end = text.find("\r\n") == std::string_view::npos ? "\n" : "\r\n";
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Change& a, const Change& b) { return a.begin < b.begin; });
  std::string result;
  std::size_t at = 0;
  for (const Change& change : changes) {
    if (change.begin > at) result.append(text.substr(at, change.begin - at));
    at = std::max(at, change.end);
    const bool starts_line = result.empty() || result.back() == '\n';
    if (!change.is_raw && !change.text.empty() && !starts_line) result += line_end;
    for (const char c : change.text) result.append(c == '\n' ? line_end : std::string_view(&c, 1));
  }
  return result.append(text.substr(at));
}

using Names = std::pair<std::string, std::string>;

// Pairs of which the file says that they are not tested, or that they are.
std::set<Names> decided_pairs(const XmlElement& robot) {
  std::set<Names> pairs;
  for (const char* const tag : {"disable_collisions", "enable_collisions"}) {
    for (const XmlElement& element : robot.children(tag)) {
      pairs.insert(std::minmax(element.needed("link1"), element.needed("link2")));
    }
  }
  return pairs;
}

// What the parser finds below the root: the number of pairs and of spheres, and the other elements
// as text.
struct RootContent {
  std::size_t pairs = 0;
  std::size_t spheres = 0;
  std::vector<std::string> rest{};

  bool operator==(const RootContent&) const = default;
};

RootContent content_of(const XmlElement& robot) {
  RootContent content;
  for (const XmlElement& child : robot.children()) {
    if (child.tag() == "disable_collisions") {
      ++content.pairs;
    } else if (child.tag() == "link_sphere_approximation") {
      ++content.spheres;
    } else {
      content.rest.push_back(child.printed());
    }
  }
  return content;
}

// The parser accepts texts that are not well-formed ("< group>"), in which the positions of
// parts_of() are meaningless.
bool reads_as(const RootContent& expected, const std::string& text, const std::string& name) {
  try {
    return content_of(XmlFile(name, text, "robot").root()) == expected;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

std::string srdf_pairs(std::span<const DisabledPair> pairs, const std::string& indent) {
  std::string text;
  for (const DisabledPair& pair : pairs) {
    text += indent + "<disable_collisions link1=\"" + xml_escaped(pair.link_a) + "\" link2=\"" +
            xml_escaped(pair.link_b) + "\"";
    if (!pair.reason.empty()) text += " reason=\"" + xml_escaped(pair.reason) + "\"";
    text += "/>\n";
  }
  return text;
}

std::string srdf_spheres(std::span<const LinkSpheres> links, const std::string& indent) {
  std::string text;
  for (const LinkSpheres& link : links) {
    const auto put = [&](const Sphere& sphere) {
      text += indent + std::string(kIndent) + "<sphere center=\"" + decimals(sphere.center, " ") +
              "\" radius=\"" + decimal(sphere.radius) + "\"/>\n";
    };
    text += indent + "<link_sphere_approximation link=\"" + xml_escaped(link.link) + "\">\n";
    for (const Sphere& sphere : link.spheres) put(sphere);
    if (link.spheres.empty()) put({});
    text += indent + "</link_sphere_approximation>\n";
  }
  return text;
}

std::string kept_srdf(const RobotSpheres& spheres, const std::filesystem::path& original) {
  const std::string text = read_file(original);
  const XmlFile file(original.string(), text, "robot");
  const XmlParts parts = parts_of(text);
  const std::set<Names> decided = decided_pairs(file.root());
  std::vector<DisabledPair> missing;
  for (const DisabledPair& pair : spheres.self_collision_ignore) {
    if (!decided.contains(std::minmax(pair.link_a, pair.link_b))) missing.push_back(pair);
  }
  std::vector<Change> changes;
  std::size_t end = parts.root_end;
  if (!parts.has_end_tag) {
    end += 2;
    changes.push_back({parts.root_end, end, ">", true});
  } else {
    end = blank_line_start(text, end).value_or(end);
  }
  std::size_t pairs_at = end;
  std::size_t spheres_at = end;
  std::string indent(kIndent);
  if (!parts.children.empty()) indent = indent_at(text, parts.children.front().begin);
  std::string pairs_indent = indent;
  for (const XmlPart& part : parts.children) {
    if (part.tag == "disable_collisions") {
      pairs_at = behind_line(text, part.end);
      pairs_indent = indent_at(text, part.begin);
    } else if (part.tag == "link_sphere_approximation") {
      Change removal{part.begin, behind_line(text, part.end)};
      const auto start = blank_line_start(text, part.begin);
      const bool is_whole_line = removal.end > part.end && start;
      if (is_whole_line) removal.begin = *start;
      if (!is_whole_line) removal.end = part.end;
      if (spheres_at == end) {
        spheres_at = removal.begin;
        indent = indent_at(text, part.begin);
      }
      changes.push_back(removal);
    }
  }
  changes.push_back({pairs_at, pairs_at, srdf_pairs(missing, pairs_indent)});
  changes.push_back({spheres_at, spheres_at, srdf_spheres(spheres.links, indent)});
  if (!parts.has_end_tag) changes.push_back({end, end, "</robot>", true});
  std::string result = changed(text, std::move(changes));
  RootContent expected = content_of(file.root());
  expected.pairs += missing.size();
  expected.spheres = spheres.links.size();
  if (!reads_as(expected, result, original.string())) {
    throw Error(original.string(),
                "cannot be kept: with the new spheres it does not read back as before (is it "
                "well-formed XML?)");
  }
  return result;
}

}  // namespace spherule::internal
