// SPDX-License-Identifier: BSD-3-Clause
#include "tests/robot/formats/sphere_sets.h"

#include <cstring>
#include <limits>
#include <regex>
#include <sstream>
#include <utility>

namespace spherule {
namespace {

double random_length(test::Random& random) {
  switch (random.index(8)) {
    case 0:
      return std::numeric_limits<double>::denorm_min();
    case 1:
      return 3e-310 * (1.0 + random.unit());
    case 2:
      return 1e15;
    case 3:
      return 1e14 * random.unit();
    case 4:
      return 1e-20 * random.unit();
    case 5:
      return static_cast<double>(random.index(5));  // without a fraction
    default:
      return random.unit();
  }
}

Sphere random_sphere(test::Random& random) {
  Sphere sphere;
  for (int axis = 0; axis < 3; ++axis) {
    sphere.center[axis] = random_length(random) * (random.index(2) == 0 ? 1.0 : -1.0);
  }
  do {
    sphere.radius = random_length(random);
  } while (sphere.radius == 0.0);
  return sphere;
}

std::string escaped(std::string text) {
  for (const auto& [from, to] : {std::pair("&", "&amp;"), {"<", "&lt;"}, {"\"", "&quot;"}}) {
    text = std::regex_replace(text, std::regex(from), to);
  }
  return text;
}

bool same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

// Names that a format has to quote, escape or leave alone.
std::vector<std::string> awkward_names() {
  std::istringstream names(
      "panda_link0$two words$ led and trailed $quote\"s$it's$a: b$a #b$#b$- a$null$~$yes$1.5$0x1F$"
      ".inf$1e3$<<${a}$[b, c]$*anchor$&anchor$!tag$%directive$|$>$@at$`tick`$back\\slash$\\u0041$"
      "a/b$Gelenk\u00e4rm$\u673a\u5668\u4eba$\U0001F916$a\u2028b$&amp;$<b>$a=b$?$:$---$format$"
      "centers$radii$robot_cfg$collision_spheres$a_sphere1$link,with,commas$0$true$a\u00a0b$x:");
  std::vector<std::string> result;
  for (std::string name; std::getline(names, name, '$');) result.push_back(name);
  return result;
}

}  // namespace

RobotSpheres random_spheres(test::Random& random, std::size_t links) {
  static const std::vector<std::string> names = awkward_names();
  RobotSpheres spheres;
  spheres.robot = names[random.index(names.size())];
  const std::size_t first = random.index(names.size());
  for (std::size_t i = 0; i < links; ++i) {
    LinkSpheres link;
    const std::size_t which = first + i;
    link.link = names[which % names.size()];
    for (std::size_t round = which / names.size(); round-- > 0;) link.link += "+";
    const std::size_t count = random.index(4) == 0 ? 0 : random.index(6);
    for (std::size_t k = 0; k < count; ++k) link.spheres.push_back(random_sphere(random));
    spheres.links.push_back(std::move(link));
  }
  for (std::size_t a = 0; a < links; ++a) {
    if (random.index(2) == 0) {
      spheres.self_collision_buffer[spheres.links[a].link] = random_length(random);
    }
    for (std::size_t b = a + 1; b < links; ++b) {
      if (random.index(3) != 0) continue;
      spheres.self_collision_ignore.push_back({spheres.links[a].link, spheres.links[b].link, {}});
    }
  }
  return spheres;
}

std::string urdf_text(const std::vector<LinkSpheres>& links) {
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"r\">\n";
  for (const LinkSpheres& link : links) {
    text += "<link name=\"" + escaped(link.link) +
            "\"><visual><geometry><mesh filename=\"meshes/a.dae\"/></geometry></visual>"
            "<collision><geometry><mesh filename=\"package://p/a.stl\"/></geometry></collision>"
            "<collision><geometry><box size=\"1 1 1\"/></geometry></collision></link>\n";
  }
  return text + "</robot>\n";
}

std::string difference(const std::vector<LinkSpheres>& a, const std::vector<LinkSpheres>& b) {
  if (a.size() != b.size()) {
    return std::to_string(a.size()) + " links and " + std::to_string(b.size());
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::string link = "link " + a[i].link;
    if (a[i].link != b[i].link) return link + " and " + b[i].link;
    if (a[i].spheres.size() != b[i].spheres.size()) return link + " has another count";
    for (std::size_t k = 0; k < a[i].spheres.size(); ++k) {
      const Sphere& x = a[i].spheres[k];
      const Sphere& y = b[i].spheres[k];
      if (!same_bits(x.radius, y.radius)) return link + " has another radius";
      for (int axis = 0; axis < 3; ++axis) {
        if (!same_bits(x.center[axis], y.center[axis])) return link + " has another center";
      }
    }
  }
  return {};
}

}  // namespace spherule
