// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/yaml_nodes.h"

#include <algorithm>
#include <array>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <yaml-cpp/eventhandler.h>

namespace spherule::internal {

using YAML::Node;

namespace {

// Counts documents. yaml-cpp 0.7 finds empty ones without end behind some tokens that are out of
// place, such as "}" at the beginning, and LoadAll() would collect them.
class DocumentCounter : public YAML::EventHandler {
 public:
  int documents() const { return documents_; }

  void OnDocumentStart(const YAML::Mark&) override { ++documents_; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

 private:
  int documents_ = 0;
};

std::string place_of(const YAML::Mark& mark) {
  if (mark.is_null()) return {};
  const std::string line = "line " + std::to_string(mark.line + 1);
  // Column 0 is also what yaml-cpp says where it knows none, at the end of a text.
  return mark.column == 0 ? line : line + ", column " + std::to_string(mark.column + 1);
}

// Whether the line at a place is indented by a tab, which yaml-cpp does not say.
bool is_indented_by_tab(const YAML::Mark& mark, std::string_view text) {
  for (int line = 0; line < mark.line; ++line) {
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    if (text.empty()) return false;
  }
  return text.substr(0, text.find_first_not_of(" \t")).find('\t') != std::string_view::npos;
}

// What yaml-cpp says of the faults that are common, for those who write files by hand.
std::string plain_words(const YAML::Exception& error, std::string_view text) {
  const std::array<std::pair<std::string_view, const char*>, 11> words{{
      {YAML::ErrorMsg::END_OF_SEQ_FLOW, "a '[' before is not closed"},
      {YAML::ErrorMsg::END_OF_MAP_FLOW, "a '{' before is not closed"},
      {YAML::ErrorMsg::END_OF_SEQ, "the indentation does not fit the lines before"},
      {YAML::ErrorMsg::END_OF_MAP, "the indentation does not fit the lines before"},
      {YAML::ErrorMsg::MAP_VALUE, "a ':' where no key can stand"},
      {YAML::ErrorMsg::MAP_KEY, "a '?' where no key can stand"},
      {YAML::ErrorMsg::BLOCK_ENTRY, "a '-' where no entry of a list can stand"},
      {YAML::ErrorMsg::UNKNOWN_TOKEN, "no value begins so; put a text in quotes"},
      {YAML::ErrorMsg::EOF_IN_SCALAR, "a text in quotes is not ended"},
      {YAML::ErrorMsg::UNKNOWN_ANCHOR, "an alias (*) names no anchor (&) before it"},
      {YAML::ErrorMsg::FLOW_END, "a ']' or '}' that closes nothing"},
  }};
  const auto known =
      std::ranges::find_if(words, [&](const auto& word) { return word.first == error.msg; });
  const std::string reason = known != words.end() ? known->second : error.msg;
  return is_indented_by_tab(error.mark, text)
             ? reason + "; the line is indented by a tab, where YAML takes blanks"
             : reason;
}

}  // namespace

std::optional<Node> only_document(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentCounter counter;
  while (counter.documents() < 2 && parser.HandleNextDocument(counter)) {
  }
  if (counter.documents() != 1) return std::nullopt;
  return YAML::Load(text);
}

std::string place_of(const Node& node) {
  return node.Mark().is_null() ? std::string() : "line " + std::to_string(node.Mark().line + 1);
}

Node yaml_document(std::string_view text, const SphereGatherer& gathered) {
  // yaml-cpp copies the whole tag to each node that has its handle.
  const bool has_handles =
      text.starts_with("%TAG") || text.find("\n%TAG") != std::string_view::npos;
  gathered.unless(!has_handles, {}, "%TAG directives are not read");
  try {
    const std::optional<Node> document = only_document(std::string(text));
    gathered.unless(document.has_value(), {}, "does not hold exactly one YAML document");
    return *document;
  } catch (const YAML::Exception& error) {
    gathered.refuse(place_of(error.mark), "is not YAML: " + plain_words(error, text));
  }
}

std::string yaml_scalar(const Node& node, const std::string& what, const SphereGatherer& gathered) {
  gathered.unless(node.IsScalar(), place_of(node), what + " is not a text");
  return node.Scalar();
}

YamlMembers yaml_members(const Node& node, const std::string& what,
                         const SphereGatherer& gathered) {
  gathered.unless(node.IsMap(), place_of(node), what + " is not a map");
  gathered.take(node.size(), place_of(node));
  YamlMembers found;
  std::set<std::string> keys;
  for (const auto& member : node) {
    const Node& key = member.first;
    gathered.unless(key.IsScalar(), place_of(key), what + " has a key that is not a text");
    gathered.unless(key.Scalar() != "<<" || key.Tag() == "!", place_of(key),
                    "merge keys (<<) are not read");
    gathered.unless(keys.insert(key.Scalar()).second, place_of(key),
                    what + " has the key \"" + key.Scalar() + "\" twice");
    found.push_back({key.Scalar(), key, member.second});
  }
  return found;
}

std::optional<Node> find_member(const YamlMembers& members, std::string_view key) {
  const auto found = std::find_if(members.begin(), members.end(),
                                  [&](const YamlMember& member) { return member.key == key; });
  if (found == members.end() || found->value.IsNull()) return std::nullopt;
  return found->value;
}

YamlMembers members_if_there(const YamlMembers& parent, const std::string& key,
                             const SphereGatherer& gathered) {
  const auto node = find_member(parent, key);
  return node ? yaml_members(*node, key, gathered) : YamlMembers{};
}

std::string xrdf_geometry(const YamlMembers& root, const SphereGatherer& gathered) {
  const YamlMembers collision = members_if_there(root, "collision", gathered);
  const auto name = find_member(collision, "geometry");
  if (!name) gathered.refuse({}, "names no geometry for collision");
  return yaml_scalar(*name, "the name of a geometry", gathered);
}

}  // namespace spherule::internal
