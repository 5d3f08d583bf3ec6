// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/link_parts.h"

#include "collide/solids/primitive.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <variant>

namespace spherule::internal {
namespace {

// Chord error of the meshes around curved primitives.
constexpr double kChordError = LinkMeshOptions{}.chord_error;

bool has_curved_shapes(const LinkDescription& link, LinkGeometry geometry) {
  return std::ranges::any_of(link_shapes(link, geometry), [](const LinkShape& shape) {
    const auto* const primitive = std::get_if<Primitive>(&shape.geometry);
    return primitive != nullptr && !std::holds_alternative<Box>(*primitive);
  });
}

// `first` are the first links of the same shapes.
void find_equal(std::vector<LinkParts>& parts, const std::vector<std::size_t>& first) {
  std::map<std::size_t, std::vector<std::size_t>> different;  // parts by their first link
  for (LinkParts& part : parts) {
    std::vector<std::size_t>& known = different[first[part.index]];
    const auto equal = std::ranges::find_if(
        known, [&](std::size_t other) { return parts[other].spheres == part.spheres; });
    if (equal != known.end()) {
      part.first_equal = *equal;
    } else {
      known.push_back(part.index);
    }
  }
}

}  // namespace

std::vector<LinkParts> parts_of(const RobotDescription& robot, std::span<const LinkSpheres> spheres,
                                LinkGeometry geometry, std::vector<std::string>* unknown) {
  std::vector<LinkParts> parts;
  std::map<std::string, std::size_t> index;
  for (const LinkDescription& link : robot.links) {
    index[link.name] = parts.size();
    parts.push_back({link.name,
                     parts.size(),
                     parts.size(),
                     link_mesh(link, {.geometry = geometry, .chord_error = kChordError}),
                     has_curved_shapes(link, geometry) ? kChordError : 0.0,
                     {}});
  }
  if (std::none_of(parts.begin(), parts.end(), [](const auto& part) { return part.mesh; })) {
    throw Error("robot \"" + robot.name + "\"", geometry == LinkGeometry::kVisual
                                                    ? "has no visual geometry"
                                                    : "has no collision geometry");
  }
  std::set<std::string> seen;
  for (const LinkSpheres& link : spheres) {
    const std::string subject = "link \"" + link.link + "\"";
    if (!seen.insert(link.link).second) throw Error(subject, "has spheres twice");
    if (!std::all_of(link.spheres.begin(), link.spheres.end(), is_usable)) {
      throw Error(subject, "has a sphere that is not usable");
    }
    const auto found = index.find(link.link);
    if (found != index.end()) {
      parts[found->second].spheres = link.spheres;
    } else if (unknown && !link.spheres.empty()) {
      unknown->push_back(link.link);
    }
  }
  find_equal(parts, first_equal_links(robot, geometry));
  return parts;
}

namespace {

// Nobody wants the hundred million spheres that such a link requires.
constexpr double kMostErrorsAcross = 1e4;
// A link above the first length is probably in millimetres, as is one above the second that is
// also so many times its E across.
constexpr double kMostMetresAcross = 100.0;
constexpr double kUsualMetresAcross = 10.0;
constexpr double kUsualErrorsAcross = 1e3;
constexpr const char* kScaleOfMillimetres =
    "their scale has to be 0.001 (in a URDF: <mesh scale=\"0.001 0.001 0.001\" .../>)";

}  // namespace

std::string size_fault(double across, double max_error) {
  if (across <= kMostErrorsAcross * max_error) return "";
  std::ostringstream text;
  text << "is " << across << " m across, too much for a max error of " << max_error
       << " m: are its meshes in millimetres? Then " << kScaleOfMillimetres;
  return text.str();
}

std::string size_doubt(double across, double max_error) {
  const bool is_large = across > kUsualMetresAcross && across > kUsualErrorsAcross * max_error;
  if (!is_large && across <= kMostMetresAcross) return "";
  std::ostringstream text;
  text << "it is " << across << " m across: if its meshes are in millimetres, "
       << kScaleOfMillimetres;
  if (is_large) text << "; so many times the max error takes long";
  return text.str();
}

std::string link_diameter_warning(double min_external_diameter) {
  std::ostringstream text;
  text << "it is so large for its max error that D is " << min_external_diameter
       << " m instead of 4 E: narrower gaps are filled";
  return text.str();
}

LinkSolid::LinkSolid(const TriangleMesh& mesh, const SimplifyOptions& lengths,
                     std::size_t max_cells)
    : solid_(simplified_solid(mesh, lengths, max_cells)) {
  certify_options_ = {.external = &solid_.external,
                      .resolution = proof_resolution(solid_.options.max_error,
                                                     solid_.external.box.diagonal().norm()),
                      .protrusion_tolerance = 0.0,
                      .volume = false,
                      .threads = lengths.threads};
  if (solid_.larger_diameter) {
    warnings_.push_back(link_diameter_warning(solid_.options.min_external_diameter));
  }
}

std::string openness(const MeshReport& report) {
  return "its mesh is open (" + std::to_string(report.boundary_edges) +
         " edges with one triangle, " + std::to_string(report.non_manifold_edges) +
         " with more than two)";
}

namespace {

// The bytes of all that says what a shape is: equal shapes have equal ones, and none is the
// beginning of another's.
class ShapeBytes {
 public:
  explicit ShapeBytes(const LinkShape& shape) {
    add(shape.geometry.index());
    if (const auto* const file = std::get_if<MeshFile>(&shape.geometry)) {
      const std::string& path = file->path.native();
      add(path.size());
      bytes_ += path;
      add(file->scale);
    } else {
      const auto& primitive = std::get<Primitive>(shape.geometry);
      add(primitive.index());
      std::visit([this](const auto& solid) { add_sizes(solid); }, primitive);
    }
    add(shape.link_from_shape.rotation().coeffs());
    add(shape.link_from_shape.translation());
  }

  const std::string& bytes() const { return bytes_; }

 private:
  void add_sizes(const Box& box) { add(box.size); }
  void add_sizes(const SolidSphere& sphere) { add(sphere.radius); }
  void add_sizes(const Cylinder& cylinder) { add_all(cylinder.radius, cylinder.length); }
  void add_sizes(const Capsule& capsule) { add_all(capsule.radius, capsule.length); }
  void add_sizes(const HalfSpace&) {}

  void add_all(double first, double second) {
    add(first);
    add(second);
  }

  template <typename Derived>
  void add(const Eigen::MatrixBase<Derived>& vector) {
    for (const double x : vector.eval()) add(x);
  }

  template <typename Number>
  requires std::is_arithmetic_v<Number>
  void add(Number number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    bytes_.append(bytes, sizeof number);
  }

  std::string bytes_;
};

}  // namespace

std::vector<std::size_t> first_equal_links(const RobotDescription& robot, LinkGeometry geometry) {
  std::vector<std::size_t> first(robot.links.size());
  std::unordered_map<std::string, std::size_t> known;
  for (std::size_t i = 0; i < first.size(); ++i) {
    std::string key;
    for (const LinkShape& shape : link_shapes(robot.links[i], geometry)) {
      key += ShapeBytes(shape).bytes();
    }
    first[i] = key.empty() ? i : known.try_emplace(std::move(key), i).first->second;
  }
  return first;
}

}  // namespace spherule::internal
