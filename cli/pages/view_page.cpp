// SPDX-License-Identifier: BSD-3-Clause
#include "cli/pages/view_page.h"

#include "base/error.h"
#include "base/files.h"
#include "cli/pages/view_page_parts.h"
#include "cli/text/json.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
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
std::string encode(std::span<const Word> words) {
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

struct BoxExtender {
  Eigen::AlignedBox3d& box;

  void operator()(const TriangleMesh& mesh) const {
    for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  }
  void operator()(const SphereTree& tree) const {
    for (const Sphere& sphere : tree.spheres()) extend(box, sphere);
  }
  void operator()(const std::vector<Sphere>& spheres) const {
    for (const Sphere& sphere : spheres) extend(box, sphere);
  }
  void operator()(const ViewLeaks& leaks) const {
    for (const LeakPoint& leak : leaks.points) box.extend(leak.point);
  }
};

// Of what is shown at first; of everything if that is nothing.
Eigen::AlignedBox3d box_of(std::span<const ViewItem> items) {
  Eigen::AlignedBox3d shown;
  Eigen::AlignedBox3d all;
  for (const ViewItem& item : items) {
    for (const ViewPart& part : item.parts) {
      std::visit(BoxExtender{all}, part.content);
      if (item.shown) std::visit(BoxExtender{shown}, part.content);
    }
  }
  return shown.isEmpty() ? all : shown;
}

// x, y, z, radius of each sphere.
std::string encode_spheres(std::span<const Sphere> spheres, const Eigen::Vector3d& middle) {
  std::vector<float> list;
  list.reserve(spheres.size() * 4);
  for (const Sphere& sphere : spheres) {
    append(list, sphere.center - middle);
    list.push_back(static_cast<float>(sphere.radius));
  }
  return encode_words(std::span<const float>(list));
}

struct ContentEncoder {
  const Eigen::Vector3d& middle;

  Json operator()(const TriangleMesh& mesh) const {
    Json json = Json::object();
    add_triangles(mesh, json);
    return json;
  }
  void add_triangles(const TriangleMesh& mesh, Json& json) const {
    std::vector<float> positions;
    for (const Eigen::Vector3d& vertex : mesh.vertices) append(positions, vertex - middle);
    std::vector<std::int32_t> corners;
    for (const Eigen::Vector3i& triangle : mesh.triangles) {
      corners.insert(corners.end(), triangle.data(), triangle.data() + 3);
    }
    json["positions"] = encode_words(std::span<const float>(positions));
    json["corners"] = encode_words(std::span<const std::int32_t>(corners));
  }
  Json operator()(const std::vector<Sphere>& spheres) const {
    return {{"levels", Json::array({encode_spheres(spheres, middle)})}};
  }
  Json operator()(const SphereTree& tree) const {
    Json levels = Json::array();
    for (int level = 0; level < tree.depth(); ++level) {
      levels.push_back(encode_spheres(tree.level(level), middle));
    }
    // In the order in which they are numbered.
    levels.push_back(encode_spheres(tree.spheres(), middle));
    return {{"levels", std::move(levels)}};
  }
  Json operator()(const ViewLeaks& leaks) const {
    std::vector<Sphere> spheres;
    for (const LeakPoint& leak : leaks.points) spheres.push_back({leak.point, leak.depth});
    Json json = (*this)(spheres);
    if (leaks.surface == nullptr) return json;
    add_triangles(leaks.surface->mesh, json);
    const std::vector<float> depths(leaks.surface->depths.begin(), leaks.surface->depths.end());
    json["depths"] = encode_words(std::span<const float>(depths));
    return json;
  }
};

// What the page calls an item of this content.
const char* kind_of(const ViewItem& item) {
  struct Kind {
    const char* operator()(const TriangleMesh&) const { return "mesh"; }
    const char* operator()(const std::vector<Sphere>&) const { return "spheres"; }
    const char* operator()(const SphereTree&) const { return "tree"; }
    const char* operator()(const ViewLeaks&) const { return "leaks"; }
  };
  return item.external ? "external" : std::visit(Kind{}, item.parts.front().content);
}

Json json_of(const ViewItem& item, const Eigen::Vector3d& middle) {
  Json json{{"name", item.name}, {"kind", kind_of(item)}, {"shown", item.shown}};
  if (!item.facts.empty()) json["facts"] = item.facts;
  if (!item.of.empty()) json["of"] = item.of;
  if (item.checked) json["checked"] = true;
  json["parts"] = Json::array();
  for (const ViewPart& part : item.parts) {
    Json& encoded = json["parts"].emplace_back(std::visit(ContentEncoder{middle}, part.content));
    encoded["link"] = part.link;
    if (!part.name.empty()) encoded["name"] = part.name;
    if (part.background) encoded["background"] = true;
  }
  return json;
}

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

std::string encode_words(std::span<const float> words) {
  return encode(words);
}

std::string encode_words(std::span<const std::int32_t> words) {
  return encode(words);
}

void write_page(const std::string& page, const ViewScene& scene) {
  const std::string text = make_view_page(scene);
  write_uninterrupted([&] { write_file_atomically(page, text); });
}

std::string page_line(const std::string& page) {
  return "page: " + one_line(page) + " (" +
         std::to_string(std::filesystem::file_size(page) / 1024) + " KiB); open it in a browser\n";
}

std::string make_view_page(const ViewScene& scene) {
  const Eigen::AlignedBox3d box = box_of(scene.items);
  if (box.isEmpty()) throw Error("view", "there is nothing to show");
  const Eigen::Vector3d middle =
      scene.robot.is_null() ? Eigen::Vector3d(box.center()) : Eigen::Vector3d::Zero();
  Json json = Json::object();
  json["middle"] = to_json(middle);
  json["robot"] = scene.robot;
  if (!scene.trajectory.is_null()) json["trajectory"] = scene.trajectory;
  json["items"] = Json::array();
  for (const ViewItem& item : scene.items) {
    if (!item.parts.empty()) json["items"].push_back(json_of(item, middle));
  }
  // The scene goes in last: no mark is searched for in what the user named.
  std::string page(kViewPageHtml);
  replace(page, "/*STYLE*/", kViewPageStyle);
  replace(page, "/*THREE*/", kViewPageThree);
  replace(page, "/*SCRIPT*/", kViewPageScript);
  replace(page, "<!--TITLE-->", html_text(scene.title));
  replace(page, "/*SCENE*/", script_text(json));
  return page;
}

}  // namespace spherule
