// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/text/json.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/leaks.h"
#include "spheretree/sphere_tree.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace spherule {

std::string base64(std::span<const std::byte> bytes);

// Numbers of 32 bits as the page of `view` carries them: their bytes, the lowest first, in base64.
template <class Row>
std::string encode_words(const std::vector<Row>& rows) {
  static_assert(sizeof(Row) % 4 == 0);
  return base64(std::as_bytes(std::span(rows)));
}

// Where a surface is outside of spheres: points of it, the deepest first, and if it is known the
// part that is.
struct ViewLeaks {
  std::vector<LeakPoint> points;
  std::shared_ptr<const LeakSurface> surface{};  // null: not known
};

using ViewContent = std::variant<TriangleMesh, std::vector<Sphere>, SphereTree, ViewLeaks>;

// A piece of an item, in the frame of a link of the scene's robot, or of the world.
struct ViewPart {
  ViewContent content;
  int link = -1;            // -1: the world
  std::string name{};       // of an obstacle or an attached object
  bool background = false;  // seen, but not what the first view is about
};

// One thing to examine. Of trees, a slider on the page chooses the level.
struct ViewItem {
  std::string name;
  std::vector<ViewPart> parts;  // of one kind
  bool external = false;        // spheres that are external ones
  std::string facts{};          // a line of text below the name
  bool shown = true;            // at first; the page has a switch for each item
  std::string of{};             // leaks: the item whose spheres they are of, if that is known
  bool checked = false;         // what the contacts of the trajectory number the spheres of
};

struct ViewScene {
  std::string title;
  std::vector<ViewItem> items;
  Json robot = nullptr;       // its links and joints (cli/pages/view_robot.h)
  Json trajectory = nullptr;  // and how it was checked (cli/pages/check_view.h)
};

// A self-contained HTML page (no network) that draws the items in one scene. Coordinates are
// written as 32-bit floats, without a robot relative to the middle of the scene: the page is for
// looking only. Throws Error where there is nothing to show.
std::string make_view_page(const ViewScene& scene);

// Writes it.
void write_page(const std::string& page, const ViewScene& scene);

// "page: FILE (N KiB); open it in a browser", for a person.
std::string page_line(const std::string& page);

}  // namespace spherule
