// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/yaml_compare.h"

#include <algorithm>
#include <map>
#include <string>

namespace spherule::internal {
namespace {

using YAML::Node;

constexpr int kDeepest = 64;

Node unshared(const Node& node, std::size_t& nodes_left, int depth = 0) {
  Node copy;
  if (nodes_left == 0 || depth > kDeepest) return copy;
  --nodes_left;
  if (node.IsScalar()) {
    nodes_left -= std::min(nodes_left, node.Scalar().size() / 16);
    copy = node.Scalar();
    copy.SetTag(node.Tag());
  } else if (node.IsSequence()) {
    copy = Node(YAML::NodeType::Sequence);
    for (const Node& item : node) copy.push_back(unshared(item, nodes_left, depth + 1));
  } else if (node.IsMap()) {
    copy = Node(YAML::NodeType::Map);
    for (const auto& member : node) {
      copy.force_insert(unshared(member.first, nodes_left, depth + 1),
                        unshared(member.second, nodes_left, depth + 1));
    }
  }
  return copy;
}

class Comparison {
 public:
  explicit Comparison(std::size_t text_length) : nodes_left_(2 * text_length) {}

  bool same(const Node& a, const Node& b, int depth = 0) {
    if (depth > kDeepest || nodes_left_ == 0 || a.Type() != b.Type() || a.size() != b.size()) {
      return false;
    }
    --nodes_left_;
    if (a.IsScalar()) return a.Scalar() == b.Scalar() && a.Tag() == b.Tag();
    if (a.IsSequence()) {
      for (std::size_t i = 0; i < a.size(); ++i) {
        if (!same(a[i], b[i], depth + 1)) return false;
      }
      return true;
    }
    return !a.IsMap() || same_members(a, b, depth);
  }

 private:
  bool same_members(const Node& a, const Node& b, int depth) {
    std::map<std::string, Node> others;
    for (const auto& member : b) {
      if (!member.first.IsScalar()) return false;
      others.insert({member.first.Scalar(), member.second});
    }
    return std::all_of(a.begin(), a.end(), [&](const auto& member) {
      if (!member.first.IsScalar()) return false;
      const auto found = others.find(member.first.Scalar());
      return found != others.end() && same(member.second, found->second, depth + 1);
    });
  }

  std::size_t nodes_left_;
};

}  // namespace

Node unshared_yaml(const Node& document, std::size_t text_length) {
  std::size_t nodes_left = 2 * text_length;
  return unshared(document, nodes_left);
}

bool is_same_yaml(const Node& a, const Node& b, std::size_t text_length) {
  return Comparison(text_length).same(a, b);
}

}  // namespace spherule::internal
