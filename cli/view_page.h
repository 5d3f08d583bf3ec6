// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere_tree.h"
#include "spheretree/triangle_mesh.h"

#include <span>
#include <string>
#include <variant>
#include <vector>

namespace spherule {

// One thing to look at. Of a tree, a slider on the page chooses the level.
struct ViewItem {
  std::string name;
  std::variant<TriangleMesh, std::vector<Sphere>, SphereTree> content;
  bool shown = true;  // at first; the page has a switch for each item
};

// A self-contained HTML page (no network) that draws the items in one scene. Coordinates are
// written as 32-bit floats relative to the middle of the scene: the page is for looking only.
std::string make_view_page(const std::string& title, std::span<const ViewItem> items);

}  // namespace spherule
