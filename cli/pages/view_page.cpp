// SPDX-License-Identifier: BSD-3-Clause
#include "cli/pages/view_page.h"

#include "base/error.h"
#include "base/files.h"
#include "cli/pages/view_page_parts.h"
#include "cli/text/json.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"

#include <Eigen/Geometry>

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string_view>

namespace spherule {
namespace {

static_assert(std::endian::native == std::endian::little, "pages have the words as they stand");

void extend(Eigen::AlignedBox3d& box, const TriangleMesh& mesh) {
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
}
void extend(Eigen::AlignedBox3d& box, std::span<const Sphere> spheres) {
  for (const Sphere& sphere : spheres) {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(sphere.radius);
    box.extend(sphere.center - reach).extend(sphere.center + reach);
  }
}
void extend(Eigen::AlignedBox3d& box, const SphereTree& tree) {
  extend(box, tree.spheres());
}
void extend(Eigen::AlignedBox3d& box, const ViewLeaks& leaks) {
  for (const LeakPoint& leak : leaks.points) box.extend(leak.point);
}

// Writes content into the JSON of a part, coordinates relative to the middle of the scene.
struct ContentWriter {
  const Eigen::Vector3d& middle;
  Json& json;

  void operator()(const TriangleMesh& mesh) const {
    std::vector<Eigen::Vector3f> positions;
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      positions.emplace_back((vertex - middle).cast<float>());
    }
    json["positions"] = encode_words(positions);
    json["corners"] = encode_words(mesh.triangles);
  }
  void operator()(std::span<const Sphere> spheres) const {
    std::vector<float> list;
    list.reserve(spheres.size() * 4);
    for (const Sphere& sphere : spheres) {
      for (const double x : sphere.center - middle) list.push_back(static_cast<float>(x));
      list.push_back(static_cast<float>(sphere.radius));
    }
    json["levels"].push_back(encode_words(list));
  }
  void operator()(const SphereTree& tree) const {
    for (int level = 0; level < tree.depth(); ++level) (*this)(tree.level(level));
    (*this)(tree.spheres());  // in the order in which they are numbered
  }
  void operator()(const ViewLeaks& leaks) const {
    std::vector<Sphere> spheres;
    for (const LeakPoint& leak : leaks.points) spheres.push_back({leak.point, leak.depth});
    (*this)(spheres);
    if (leaks.surface == nullptr) return;
    (*this)(leaks.surface->mesh);
    json["depths"] = encode_words(
        std::vector<float>(leaks.surface->depths.begin(), leaks.surface->depths.end()));
  }
};

// What the page calls the contents, in the order of ViewContent.
constexpr std::array<const char*, 4> kKinds = {"mesh", "spheres", "tree", "leaks"};

Json json_of(const ViewItem& item, const Eigen::Vector3d& middle) {
  const char* kind = item.external ? "external" : kKinds.at(item.parts.front().content.index());
  Json json{{"name", item.name}, {"kind", kind}, {"shown", item.shown}};
  if (!item.facts.empty()) json["facts"] = item.facts;
  if (!item.of.empty()) json["of"] = item.of;
  if (item.checked) json["checked"] = true;
  for (const ViewPart& part : item.parts) {
    Json& written = json["parts"].emplace_back(Json{{"link", part.link}});
    std::visit(ContentWriter{middle, written}, part.content);
    if (!part.name.empty()) written["name"] = part.name;
    if (part.background) written["background"] = true;
  }
  return json;
}

std::string escaped(std::string_view plain, const std::map<char, const char*>& escapes) {
  std::string text;
  for (const char c : plain) {
    const auto escape = escapes.find(c);
    if (escape == escapes.end()) {
      text += c;
    } else {
      text += escape->second;
    }
  }
  return text;
}

void replace(std::string& text, std::string_view mark, const std::string& with) {
  const std::size_t place = text.find(mark);
  if (place != std::string::npos) text.replace(place, mark.size(), with);
}

}  // namespace

std::string base64(std::span<const std::byte> bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = i; k < i + 3; ++k) {
      group = group << 8 | (k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return text;
}

std::string make_view_page(const ViewScene& scene) {
  Eigen::AlignedBox3d box;
  for (const ViewItem& item : scene.items) {
    for (const ViewPart& part : item.parts) {
      std::visit([&](const auto& content) { extend(box, content); }, part.content);
    }
  }
  if (box.isEmpty()) throw Error("view", "there is nothing to show");
  const Eigen::Vector3d middle =
      scene.robot.is_null() ? Eigen::Vector3d(box.center()) : Eigen::Vector3d::Zero();
  Json json{{"middle", to_json(middle)}, {"robot", scene.robot}, {"items", Json::array()}};
  if (!scene.trajectory.is_null()) json["trajectory"] = scene.trajectory;
  for (const ViewItem& item : scene.items) {
    if (!item.parts.empty()) json["items"].push_back(json_of(item, middle));
  }
  // The scene goes in last: no mark is searched for in what the user named. No "</script>" and no
  // "<!--" can occur in it.
  std::string page(kViewPageHtml);
  replace(page, "/*STYLE*/", kViewPageStyle);
  replace(page, "/*THREE*/", kViewPageThree);
  replace(page, "/*SCRIPT*/", kViewPageScript);
  replace(page, "<!--TITLE-->",
          escaped(scene.title, {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}}));
  replace(page, "/*SCENE*/", escaped(to_text(json, Layout::kCompact), {{'<', "\\u003c"}}));
  return page;
}

void write_page(const std::string& page, const ViewScene& scene) {
  const std::string text = make_view_page(scene);
  write_uninterrupted([&] { write_file_atomically(page, text); });
}

std::string page_line(const std::string& page) {
  return "page: " + one_line(page) + " (" +
         std::to_string(std::filesystem::file_size(page) / 1024) + " KiB); open it in a browser\n";
}

}  // namespace spherule
