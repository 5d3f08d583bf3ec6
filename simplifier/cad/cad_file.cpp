// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cad/cad_file.h"

#include "simplifier/cad/internal/cad_shape.h"
#include "simplifier/cad/internal/surface_deviation.h"
#include "simplifier/internal/raw_mesh.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace spherule {
namespace {

using internal::CadShape;
using internal::TessellatedFace;

constexpr double kDefaultChordError = 1.0 / 2000.0;  // of the diagonal
constexpr int kTessellations = 4;
constexpr double kSampleMargin = 2.0;
// What evaluating a surface in doubles may cost, relative to the largest number that goes into it.
constexpr double kEvaluation = 0x1p-40;
// Deviations below this share of the aim are not told apart: a finer proof would cost more than the
// padding that it saves.
constexpr double kFloor = 0.5;

void check(const CadReadOptions& options) {
  internal::check_scale(options.scale);
  if (!(options.chord_error >= 0.0 && options.chord_error <= kMaxCoordinate)) {
    throw Error("chord error", "must be finite and not negative");
  }
  if (!(options.angle >= 0.01 && options.angle <= 0.5 * std::numbers::pi)) {
    throw Error("angle", "must be between 0.01 and a quarter turn");
  }
}

// The triangles of all faces and how far these are from them, in millimetres.
struct Tessellation {
  TriangleMesh mesh;
  double reached = 0.0;
  double bound = 0.0;
  double largest = 0.0;  // of the numbers that the faces are evaluated from
  std::vector<UnprovedFace> unproved;
};

// A proof counts more than a smaller number.
bool is_better(const Tessellation& a, const Tessellation& b) {
  if (a.unproved.empty() != b.unproved.empty()) return a.unproved.empty();
  return a.bound < b.bound;
}

void append(TriangleMesh& mesh, const internal::CadFace& face) {
  const auto first = static_cast<int>(mesh.vertices.size());
  const TessellatedFace& part = face.tessellation;
  mesh.vertices.insert(mesh.vertices.end(), part.nodes.begin(), part.nodes.end());
  for (auto [a, b, c] : part.triangles) {
    if (face.reversed) std::swap(b, c);
    mesh.triangles.emplace_back(first + a, first + b, first + c);
  }
}

Tessellation tessellate(CadShape& shape, double deflection, double angle, double floor) {
  Tessellation result;
  internal::SurfaceDeviation deviation(floor);
  double sampled = 0.0;
  shape.tessellate(deflection, angle, [&](const internal::CadFace& face) {
    append(result.mesh, face);
    result.largest = std::max(result.largest, face.largest);
    std::string reason = face.fault.empty() ? deviation.add(face.tessellation) : face.fault;
    if (reason.empty()) return;
    result.unproved.push_back({face.name, std::move(reason)});
    sampled = std::max(sampled, internal::sampled_deviation(face.tessellation));
  });
  result.reached = std::max(deviation.reached(), sampled);
  result.bound = std::max(deviation.bound(), kSampleMargin * sampled);
  return result;
}

}  // namespace

CadPart read_cad(const std::filesystem::path& path, const CadReadOptions& options) {
  check(options);
  CadShape shape(path, internal::read_regular_file(path));
  double aim = options.chord_error / options.scale;
  if (aim == 0.0) aim = kDefaultChordError * shape.diagonal();

  // The largest tolerance and what evaluation costs are there however fine the mesh is.
  const double spent = shape.tolerance();
  double deflection = aim;
  Tessellation best;
  for (int round = 0; round < kTessellations; ++round) {
    Tessellation next = tessellate(shape, deflection, options.angle, kFloor * aim);
    if (round == 0 || is_better(next, best)) best = std::move(next);
    if (best.bound + spent <= aim) break;
    deflection *= std::clamp(0.8 * (aim - spent) / best.bound, 0.2, 0.7);
  }

  const double evaluation =
      std::max(best.largest, internal::largest_coordinate(best.mesh)) * kEvaluation;
  CadPart part;
  part.chord_error = mul_up(add_up(best.bound, add_up(spent, evaluation)), options.scale);
  part.asked = aim * options.scale;
  part.reached = best.reached * options.scale;
  part.tolerance = shape.tolerance() * options.scale;
  part.proved = best.unproved.empty();
  part.unproved = std::move(best.unproved);
  part.faces = shape.face_count();
  part.free_edges = shape.free_edge_count();
  part.stated_unit = shape.stated_unit();
  part.mesh = std::move(best.mesh);
  internal::apply_scale(part.mesh, options.scale);
  part.mesh.vertex_error = add_up(part.mesh.vertex_error, part.chord_error);
  part.mesh = internal::weld(part.mesh);
  validate(part.mesh, path.string());
  return part;
}

}  // namespace spherule
