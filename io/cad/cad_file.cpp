// SPDX-License-Identifier: BSD-3-Clause
#include "io/cad/cad_file.h"

#include "base/error.h"
#include "base/files.h"
#include "base/rounding.h"
#include "geometry/vertex_rounding.h"
#include "geometry/weld.h"
#include "io/cad/cad_shape.h"
#include "io/cad/surface_deviation.h"

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
// Of the coordinates: a motion that is further from a rigid one than this is none.
constexpr double kRigid = 1e-9;
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

CadPart part_of(CadShape& shape, const CadReadOptions& options, const std::string& subject) {
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
  validate(part.mesh, subject);
  return part;
}

// How far `motion`, in millimetres, is from the rigid motion `pose`, in units of the model, for the
// points of the mesh.
double motion_error(const Eigen::Matrix<double, 3, 4>& motion, const Pose& pose, double scale,
                    const TriangleMesh& mesh) {
  double largest = 0.0;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    const Eigen::Vector3d moved = motion.leftCols<3>() * v + motion.col(3) * scale;
    largest = std::max(largest, distance_upper(moved, pose * v));
  }
  // Rounding of both, and of the place that OpenCASCADE composes from those of the assemblies
  // around it: as what evaluating a surface may cost.
  const double size =
      internal::largest_coordinate(mesh) + motion.col(3).cwiseAbs().maxCoeff() * scale;
  return add_up(largest, mul_up(size, kEvaluation));
}

// The copy, and how far it is from its original moved rigidly.
std::pair<BodyCopy, double> copy_of(const CadShape::Placed& placed, double scale,
                                    const CadPart& original, const std::string& subject) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = placed.from_original.leftCols<3>();
  motion.translation() = placed.from_original.col(3) * scale;
  BodyCopy copy{.of = placed.copy_of, .pose = Pose::from_isometry(motion)};
  const double error = motion_error(placed.from_original, copy.pose, scale, original.mesh);
  // Far more than rounding is no rigid motion.
  if (!(error <= kRigid * internal::largest_coordinate(original.mesh) +
                     kRigid * motion.translation().norm())) {
    throw Error(subject, placed.name + " is no rigid copy of another body, which is not read");
  }
  return {copy, error};
}

}  // namespace

CadPart read_cad(const std::filesystem::path& path, const CadReadOptions& options) {
  check(options);
  CadShape shape(path, internal::read_regular_file(path));
  return part_of(shape, options, path.string());
}

std::vector<CadBody> read_cad_bodies(const std::filesystem::path& path,
                                     const CadReadOptions& options) {
  check(options);
  const std::string subject = path.string();
  std::vector<CadShape::Placed> placed = CadShape::bodies(path, internal::read_regular_file(path));
  std::vector<CadBody> bodies;
  std::vector<double> copy_errors(placed.size(), 0.0);
  for (CadShape::Placed& one : placed) {
    CadBody body{.name = one.name, .part = {}};
    if (one.shape) {
      body.part = part_of(*one.shape, options, subject + ": " + one.name);
    } else {
      const auto [copy, error] = copy_of(one, options.scale, bodies[one.copy_of].part, subject);
      body.copy = copy;
      copy_errors[one.copy_of] = std::max(copy_errors[one.copy_of], error);
    }
    bodies.push_back(std::move(body));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    double& own = bodies[i].part.mesh.vertex_error;
    if (copy_errors[i] > 0.0) own = add_up(own, copy_errors[i]);
  }
  return bodies;
}

}  // namespace spherule
