// SPDX-License-Identifier: BSD-3-Clause
#include "base/text.h"
#include "io/collada_document.h"
#include "io/collada_geometry.h"
#include "io/collada_nodes.h"
#include "io/collada_skin.h"
#include "io/placed_part.h"
#include "io/scene_budget.h"
#include "io/scene_file.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

using Element = ColladaDocument::Element;

// What an entry of a map costs, in steps of the budget.
constexpr std::size_t kMapEntry = 16;

class ColladaReader {
 public:
  ColladaReader(std::string_view bytes, const std::string& subject)
      : subject_(subject), budget_(subject, steps_of(bytes)), document_(bytes, subject, budget_) {}

  // A number takes two bytes or more, so each can be read at least twice.
  static std::size_t steps_of(std::string_view bytes) {
    return (std::size_t{1} << 24) + bytes.size();
  }

  TriangleMesh run() {
    scene_ = &shown_scene();
    const double unit = metres(document_);
    if (unit != 1.0) {
      chain_.push_back(
          {Eigen::Matrix3d(unit * Eigen::Matrix3d::Identity()), Eigen::Vector3d::Zero()});
    }
    root_chain_ = chain_;
    visit_children(*scene_);
    return std::move(result_);
  }

  // What the file states of its unit. An asset of a part of the file would override it there, and
  // the axes, too: the ones that differ are refused.
  static double metres(const ColladaDocument& document) {
    const Element* const asset = document.root().FirstChildElement("asset");
    const auto stated = [&](const char* name) {
      return asset == nullptr ? nullptr : asset->FirstChildElement(name);
    };
    const double unit = metres_of(document, stated("unit"));
    const std::vector<std::string> axis = axis_of(document, stated("up_axis"));
    for (const Element* other : document.assets()) {
      for (const Element* at : document.children(*other)) {
        const std::string_view name = at->Name();
        if ((name == "unit" && metres_of(document, at) != unit) ||
            (name == "up_axis" && axis_of(document, at) != axis)) {
          document.fail(*at, "differs from that of the whole file, which is not supported");
        }
      }
    }
    return unit;
  }

 private:
  static double metres_of(const ColladaDocument& document, const Element* unit) {
    const char* const text = unit == nullptr ? nullptr : unit->Attribute("meter");
    if (text == nullptr) return 1.0;
    const double size = finite_number(text).value_or(0.0);
    if (!(size > 0.0 && size <= 1e15)) document.fail(*unit, "states no usable size in metres");
    return size;
  }

  static std::vector<std::string> axis_of(const ColladaDocument& document, const Element* axis) {
    return axis == nullptr ? std::vector<std::string>{"Y_UP"} : document.words(*axis);
  }

  const Element& shown_scene() const {
    if (const Element* const scene = document_.root().FirstChildElement("scene")) {
      return document_.referred("visual_scene", document_.child(*scene, "instance_visual_scene"),
                                "url");
    }
    const Element* const library = document_.root().FirstChildElement("library_visual_scenes");
    if (library == nullptr) document_.fail(document_.root(), "names no scene to show");
    return document_.child(*library, "visual_scene");
  }

  void visit_children(const Element& parent) {
    for (const Element* at : document_.children(parent)) {
      const std::string_view name = at->Name();
      if (name == "node") {
        visit(*at);
      } else if (name == "instance_node") {
        const Element& node = document_.referred("node", *at, "url");
        if (std::find(open_.begin(), open_.end(), &node) != open_.end()) {
          document_.fail(*at, "shows a node within itself");
        }
        visit(node);
      } else if (name == "instance_geometry") {
        TriangleMesh part = mesh_of(document_.referred("geometry", *at, "url"));
        budget_.take(part);
        budget_.take_moves(part.vertices.size(), chain_.size());
        place(part, chain_, 0.0, kColladaEntryError);
        append(result_, part, subject_);
      } else if (name == "instance_controller") {
        show_controller(*at);
      }
    }
  }

  void visit(const Element& node) {
    budget_.take_node();
    if (!may_have_surface(node)) return;
    const std::size_t before = chain_.size();
    const std::vector<Affine>& own = transforms_of(node);
    chain_.insert(chain_.end(), own.begin(), own.end());
    budget_.check_depth(chain_.size());
    open_.push_back(&node);
    budget_.check_depth(open_.size());
    visit_children(node);
    open_.pop_back();
    chain_.erase(chain_.begin() + static_cast<std::ptrdiff_t>(before), chain_.end());
  }

  // Cameras and lights have none, and their transforms do not matter.
  bool may_have_surface(const Element& node) const {
    return std::ranges::any_of(document_.children(node), [](const Element* at) {
      const std::string_view name = at->Name();
      return name == "node" || name == "instance_node" || name == "instance_geometry" ||
             name == "instance_controller";
    });
  }

  // The results of the following are kept: each element is parsed once however often it is shown.
  const TriangleMesh& mesh_of(const Element& geometry) {
    const auto [it, is_new] = meshes_.try_emplace(&geometry);
    if (is_new) it->second = collada_mesh(document_, geometry, subject_);
    return it->second;
  }

  const std::vector<Affine>& transforms_of(const Element& node) {
    const auto [it, is_new] = transforms_.try_emplace(&node);
    if (is_new) it->second = collada_transforms(document_, node);
    return it->second;
  }

  struct SkinnedMesh {
    const TriangleMesh* rest = nullptr;
    ColladaSkin skin;
  };

  const SkinnedMesh& skinned_mesh_of(const Element& controller) {
    const auto [it, is_new] = skinned_meshes_.try_emplace(&controller);
    if (!is_new) return it->second;
    const Element* const skin = controller.FirstChildElement("skin");
    if (skin == nullptr) document_.fail(controller, "is no skin: morphs are not supported");
    it->second.rest = &mesh_of(document_.referred("geometry", *skin, "source"));
    it->second.skin = collada_skin(document_, *skin, it->second.rest->vertices.size());
    return it->second;
  }

  using Joints = std::map<std::string_view, const Element*>;

  // The first node of each sid at or below `root`.
  const Joints& joints_below(const Element& root) {
    const auto [it, is_new] = joints_.try_emplace(&root);
    if (is_new) gather_joints(root, it->second);
    return it->second;
  }

  void gather_joints(const Element& node, Joints& joints) {
    if (const char* const sid = node.Attribute("sid")) {
      const std::string_view name = sid;
      budget_.take_steps(kMapEntry + name.size());
      joints.try_emplace(name, &node);
    }
    for (const Element* at : document_.children(node, "node")) gather_joints(*at, joints);
  }

  void show_controller(const Element& instance) {
    const SkinnedMesh& shown = skinned_mesh_of(document_.referred("controller", instance, "url"));
    const TriangleMesh& rest = *shown.rest;
    const ColladaSkin& skin = shown.skin;
    budget_.take(rest);
    budget_.take_steps(skin.joints.size());
    SkinnedPart part(rest, kColladaEntryError);
    for (std::size_t j = 0; j <= skin.joints.size(); ++j) {
      if (skin.weights[j].empty()) continue;
      std::vector<Affine> chain = root_chain_;
      if (j < skin.joints.size()) {
        chain = chain_of_joint(joint_of(skin, j, instance), instance);
        chain.push_back(skin.inverse_bind[j]);
      }
      chain.push_back(skin.bind_shape);
      budget_.take_moves(skin.weights[j].size(), chain.size());
      part.add(chain, skin.weights[j]);
    }
    append(result_, part.take(), subject_);
  }

  const Element& joint_of(const ColladaSkin& skin, std::size_t j, const Element& instance) {
    if (skin.are_ids) return document_.with_id("node", skin.joints[j], instance);
    for (const Element* at : document_.children(instance, "skeleton")) {
      const std::vector<std::string> words = document_.words(*at);
      const std::string id = words.empty() ? "" : words.front();
      if (!id.starts_with('#')) document_.fail(*at, "names no node of this file");
      const Joints& joints = joints_below(document_.with_id("node", id.substr(1), *at));
      const auto found = joints.find(skin.joints[j]);
      if (found != joints.end()) return *found->second;
    }
    document_.fail(instance, "has no skeleton with the joint " + skin.joints[j]);
  }

  std::vector<Affine> chain_of_joint(const Element& joint, const Element& instance) {
    std::vector<Affine> upward;
    const tinyxml2::XMLElement* at = &joint;
    for (; at != nullptr && at != scene_;
         at = at->Parent() == nullptr ? nullptr : at->Parent()->ToElement()) {
      budget_.take_steps(1);
      const std::vector<Affine>& own = transforms_of(*at);
      upward.insert(upward.end(), own.rbegin(), own.rend());
    }
    if (at == nullptr) document_.fail(instance, "has a joint that is not in the scene shown");
    budget_.check_depth(upward.size());
    std::vector<Affine> chain = root_chain_;
    chain.insert(chain.end(), upward.rbegin(), upward.rend());
    return chain;
  }

  const std::string& subject_;
  SceneBudget budget_;
  ColladaDocument document_;
  const Element* scene_ = nullptr;
  std::vector<const Element*> open_;  // nodes
  std::vector<Affine> chain_;
  std::vector<Affine> root_chain_;
  std::map<const Element*, TriangleMesh> meshes_;
  std::map<const Element*, std::vector<Affine>> transforms_;
  std::map<const Element*, SkinnedMesh> skinned_meshes_;
  std::map<const Element*, Joints> joints_;
  TriangleMesh result_;
};

}  // namespace

TriangleMesh read_collada(std::string_view bytes, const std::string& subject) {
  return ColladaReader(bytes, subject).run();
}

double collada_unit(std::string_view text, const std::string& subject) {
  SceneBudget budget(subject, ColladaReader::steps_of(text));
  return ColladaReader::metres(ColladaDocument(text, subject, budget));
}

}  // namespace spherule::internal
