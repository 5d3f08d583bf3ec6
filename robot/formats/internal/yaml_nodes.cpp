// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/internal/yaml_nodes.h"

#include <algorithm>
#include <set>
#include <sstream>
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
  try {
    const std::optional<Node> document = only_document(std::string(text));
    gathered.unless(document.has_value(), {}, "does not hold exactly one YAML document");
    return *document;
  } catch (const YAML::Exception& error) {
    gathered.refuse("line " + std::to_string(error.mark.line + 1), "is not YAML: " + error.msg);
  }
}

std::string yaml_scalar(const Node& node, const std::string& what, const SphereGatherer& gathered) {
  gathered.unless(node.IsScalar(), place_of(node), what + " is not a text");
  return node.Scalar();
}

YamlMembers yaml_members(const Node& node, const std::string& what,
                         const SphereGatherer& gathered) {
  gathered.unless(node.IsMap(), place_of(node), what + " is not a map");
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
