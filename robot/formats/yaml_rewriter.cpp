// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/yaml_rewriter.h"

#include "robot/files/format_text.h"
#include "robot/formats/yaml_nodes.h"

#include <utility>

namespace spherule::internal {
namespace {

using YAML::Node;

class Rewriter {
 public:
  Rewriter(const RobotSpheres& spheres, const SphereGatherer& gathered,
           std::vector<std::string> place)
      : spheres_(spheres), gathered_(gathered), place_(std::move(place)) {}

  std::string write(const Node& root) {
    put_map(root, 0, 0);
    return std::move(text_);
  }

 private:
  static constexpr int kDeepest = 64;  // an anchor may hold itself
  static constexpr std::size_t kLongest = 1u
                                          << 28;  // or twice another that does the same, and so on

  // `found` is how far the keys down to here are those of the place; beyond it, more than all.
  void put_map(const Node& node, int indent, std::size_t found) {
    const bool on_the_way = found < place_.size();
    bool seen = false;
    for (const auto& [key, written_key, value] : yaml_members(node, "a part", gathered_)) {
      text_ += std::string(static_cast<std::size_t>(indent), ' ') + scalar(written_key) + ":";
      const bool next = on_the_way && key == place_[found];
      seen = seen || next;
      if (next && found + 1 == place_.size()) {
        put_spheres(indent);
      } else {
        put_value(value, indent, next ? found + 1 : place_.size());
      }
    }
    gathered_.unless(seen || !on_the_way, place_of(node), "has no place for spheres");
  }

  void put_spheres(int indent) { text_.append("\n").append(yaml_spheres(spheres_, indent + 2)); }

  void put_value(const Node& node, int indent, std::size_t found) {
    gathered_.unless(indent <= 2 * kDeepest && text_.size() < kLongest, place_of(node),
                     "is too deep or too long");
    if (node.IsMap() && node.size() > 0) {
      text_ += "\n";
      put_map(node, indent + 2, found);
    } else if (node.IsSequence() && node.size() > 0) {
      text_ += "\n";
      for (const auto& item : node) {
        text_ += std::string(static_cast<std::size_t>(indent), ' ') + "-";
        put_value(item, indent + 2, place_.size());
      }
    } else {
      text_.append(" ").append(scalar(node)).append("\n");
    }
  }

  static std::string scalar(const Node& node) {
    if (node.IsMap()) return "{}";
    if (node.IsSequence()) return "[]";
    if (node.IsNull()) return "null";
    const std::string& tag = node.Tag();
    // Plain texts, numbers and truth values stay as they are; those over several lines cannot.
    if (tag == "?" && node.Scalar().find('\n') == std::string::npos) return node.Scalar();
    const bool has_type = !tag.empty() && tag != "?" && tag != "!";
    const std::string type = has_type ? std::string("!<").append(tag).append("> ") : "";
    return type + yaml_text(node.Scalar());
  }

  const RobotSpheres& spheres_;
  const SphereGatherer& gathered_;
  const std::vector<std::string> place_;
  std::string text_;
};

}  // namespace

std::string rewritten_yaml(const Node& document, const RobotSpheres& spheres,
                           const std::vector<std::string>& place, const SphereGatherer& gathered) {
  return Rewriter(spheres, gathered, place).write(document);
}

}  // namespace spherule::internal
