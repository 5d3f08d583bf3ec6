// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/internal/urdf_tree.h"

#include <map>
#include <set>

namespace spherule::internal {
namespace {

class Gatherer {
 public:
  explicit Gatherer(const XmlElement& robot) : robot_(robot) {
    for (const XmlElement& link : robot.children("link")) {
      const std::string name = link.needed("name");
      if (!links_.emplace(name, link).second) link.refuse("link '" + name + "' is not unique");
    }
    std::set<std::string> names;
    for (const XmlElement& joint : robot.children("joint")) {
      const std::string name = joint.needed("name");
      if (!names.insert(name).second) joint.refuse("joint '" + name + "' is not unique");
      add(joint);
    }
  }

  UrdfTree tree() const {
    UrdfTree result{.links = {root()}, .joints = {}};
    std::vector<XmlElement> waiting;
    for (;;) {
      const auto below = below_.find(result.links.back().needed("name"));
      if (below != below_.end()) {
        waiting.insert(waiting.end(), below->second.rbegin(), below->second.rend());
      }
      if (waiting.empty()) break;
      result.joints.push_back(waiting.back());
      waiting.pop_back();
      result.links.push_back(links_.at(link_at(result.joints.back(), "child")));
    }
    if (result.links.size() < links_.size()) refuse_ring(result.links);
    return result;
  }

 private:
  void add(const XmlElement& joint) {
    for (const std::string_view end : {"parent", "child"}) {
      const std::string link = link_at(joint, end);
      if (!links_.contains(link)) joint.needed_child(end).refuse("link '" + link + "' not found");
    }
    const std::string child = link_at(joint, "child");
    const auto [other, is_first] = above_.emplace(child, joint);
    if (!is_first) {
      joint.refuse("link '" + child + "' is below two joints, this one and '" +
                   other->second.needed("name") + "'");
    }
    below_[link_at(joint, "parent")].push_back(joint);
  }

  XmlElement root() const {
    std::vector<XmlElement> roots;
    for (const XmlElement& link : robot_.children("link")) {
      const std::string name = link.needed("name");
      if (above_.contains(name)) continue;
      if (!roots.empty()) {
        link.refuse("it is a root, below no joint, as is link '" + roots[0].needed("name") + "'");
      }
      roots.push_back(link);
    }
    if (links_.empty()) robot_.refuse("it has no <link>");
    if (roots.empty()) refuse_ring({});
    return roots[0];
  }

  // `reached` are the links at and below the root. Upwards from any other there is no end.
  [[noreturn]] void refuse_ring(const std::vector<XmlElement>& reached) const {
    std::map<std::string, XmlElement> others = links_;
    for (const XmlElement& link : reached) others.erase(link.needed("name"));
    std::string at = others.begin()->first;
    std::set<std::string> way;
    while (way.insert(at).second) at = link_at(above_.at(at), "parent");
    above_.at(at).refuse("link '" + at + "' is above itself");
  }

  XmlElement robot_;
  std::map<std::string, XmlElement> links_{};
  std::map<std::string, XmlElement> above_{};               // the joint above a link
  std::map<std::string, std::vector<XmlElement>> below_{};  // those below it
};

}  // namespace

UrdfTree urdf_tree(const XmlElement& robot) {
  return Gatherer(robot).tree();
}

std::string link_at(const XmlElement& joint, std::string_view end) {
  return joint.needed_child(end).needed("link");
}

}  // namespace spherule::internal
