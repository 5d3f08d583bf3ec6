// SPDX-License-Identifier: BSD-3-Clause
#include "cli/view_page.h"

#include "cli/json.h"
#include "cli/view_page_parts.h"
#include "spheretree/error.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <cstring>
#include <string_view>

namespace spherule {
namespace {

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return text;
}

// The page reads little-endian words, which is what all machines that run it have.
template <class Word>
std::string encode(const std::vector<Word>& words) {
  static_assert(sizeof(Word) == 4);
  std::string bytes;
  bytes.reserve(words.size() * 4);
  for (const Word word : words) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &word, 4);
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(bits >> shift & 255u);
  }
  return base64(bytes);
}

void append(std::vector<float>& list, const Eigen::Vector3d& point) {
  for (int axis = 0; axis < 3; ++axis) list.push_back(static_cast<float>(point[axis]));
}

void extend(Eigen::AlignedBox3d& box, const Sphere& sphere) {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(sphere.radius);
  box.extend(sphere.center - reach).extend(sphere.center + reach);
}

Eigen::AlignedBox3d box_of(std::span<const ViewItem> items) {
  Eigen::AlignedBox3d box;
  for (const ViewItem& item : items) {
    if (!item.shown) continue;
    if (const auto* mesh = std::get_if<TriangleMesh>(&item.content)) {
      for (const Eigen::Vector3d& vertex : mesh->vertices) box.extend(vertex);
    } else if (const auto* tree = std::get_if<SphereTree>(&item.content)) {
      for (const Sphere& sphere : tree->spheres()) extend(box, sphere);
    } else {
      for (const Sphere& sphere : std::get<std::vector<Sphere>>(item.content)) extend(box, sphere);
    }
  }
  return box;
}

// x, y, z, radius of each sphere.
std::string encode_spheres(std::span<const Sphere> spheres, const Eigen::Vector3d& middle) {
  std::vector<float> list;
  list.reserve(spheres.size() * 4);
  for (const Sphere& sphere : spheres) {
    append(list, sphere.center - middle);
    list.push_back(static_cast<float>(sphere.radius));
  }
  return encode(list);
}

struct ContentEncoder {
  const Eigen::Vector3d& middle;

  Json operator()(const TriangleMesh& mesh) const {
    std::vector<float> positions;
    for (const Eigen::Vector3d& vertex : mesh.vertices) append(positions, vertex - middle);
    std::vector<std::int32_t> corners;
    for (const Eigen::Vector3i& triangle : mesh.triangles) {
      corners.insert(corners.end(), triangle.data(), triangle.data() + 3);
    }
    return {{"kind", "mesh"}, {"positions", encode(positions)}, {"corners", encode(corners)}};
  }
  Json operator()(const std::vector<Sphere>& spheres) const {
    return {{"kind", "spheres"}, {"levels", Json::array({encode_spheres(spheres, middle)})}};
  }
  Json operator()(const SphereTree& tree) const {
    Json levels = Json::array();
    for (int level = 0; level <= tree.depth(); ++level) {
      levels.push_back(encode_spheres(tree.level(level), middle));
    }
    return {{"kind", "tree"}, {"levels", std::move(levels)}};
  }
};

// JSON that may stand inside a script element: no "</script>" and no "<!--" can occur in it.
std::string script_text(const Json& json) {
  std::string text;
  for (const char c : to_text(json, Layout::kCompact)) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

std::string html_text(std::string_view plain) {
  std::string text;
  for (const char c : plain) {
    switch (c) {
      case '&':
        text += "&amp;";
        break;
      case '<':
        text += "&lt;";
        break;
      case '>':
        text += "&gt;";
        break;
      default:
        text += c;
    }
  }
  return text;
}

void replace(std::string& text, std::string_view mark, const std::string& with) {
  const std::size_t place = text.find(mark);
  if (place != std::string::npos) text.replace(place, mark.size(), with);
}

}  // namespace

std::string make_view_page(const std::string& title, std::span<const ViewItem> items) {
  const Eigen::AlignedBox3d box = box_of(items);
  if (box.isEmpty()) throw Error("view", "there is nothing to show");
  const Eigen::Vector3d middle = box.center();
  Json scene;
  scene["size"] = box.diagonal().norm();
  scene["middle"] = to_json(middle);
  scene["items"] = Json::array();
  for (const ViewItem& item : items) {
    Json json = std::visit(ContentEncoder{middle}, item.content);
    json["name"] = item.name;
    json["shown"] = item.shown;
    scene["items"].push_back(std::move(json));
  }
  // The scene goes in last: no mark is looked for in what the user named.
  std::string page(kViewPageHtml);
  replace(page, "/*STYLE*/", std::string(kViewPageStyle));
  replace(page, "/*SCRIPT*/", std::string(kViewPageScript));
  replace(page, "<!--TITLE-->", html_text(title));
  replace(page, "/*SCENE*/", script_text(scene));
  return page;
}

}  // namespace spherule
