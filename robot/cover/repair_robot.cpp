// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/repair_robot.h"

#include "mesh/geometry/mesh_box.h"
#include "robot/cover/internal/link_parts.h"
#include "robot/cover/internal/link_size.h"
#include "robot/cover/internal/link_solid.h"
#include "robot/cover/internal/link_subject.h"
#include "spheretree/error.h"

#include <algorithm>
#include <cstddef>
#include <string>

namespace spherule {
namespace {

// Before long work is done for nothing. An E that is chosen suits its link.
void check_sizes(std::span<const internal::LinkParts> parts, double max_error) {
  if (!(max_error > 0.0)) return;
  for (const internal::LinkParts& part : parts) {
    if (!part.mesh) continue;
    const double across = internal::box_of(*part.mesh).diagonal().norm();
    const std::string fault = internal::size_fault(across, max_error);
    if (!fault.empty()) throw Error(internal::subject_of(part.link), fault);
  }
}

LinkRepair repaired(const internal::LinkParts& part, const RobotRepairOptions& options) {
  const internal::LinkSolid solid(*part.mesh,
                                  {.max_error = options.max_error, .threads = options.threads});
  LinkRepair result{
      .link = part.link, .repair = {}, .certificate = {}, .warnings = solid.warnings()};
  result.repair = repair(*part.mesh, solid.external(), part.spheres,
                         {.max_error = options.max_error, .threads = options.threads});
  result.certificate = certify(*part.mesh, result.repair.spheres, solid.certify_options());
  return result;
}

}  // namespace

RobotRepair repair_robot(const RobotDescription& robot, std::span<const LinkSpheres> spheres,
                         const RobotRepairOptions& options) {
  RobotRepair result;
  result.spheres.assign(spheres.begin(), spheres.end());
  const std::vector<internal::LinkParts> parts =
      internal::parts_of(robot, spheres, options.geometry, nullptr);
  check_sizes(parts, options.max_error);
  std::vector<std::size_t> repair_of(parts.size());
  for (const internal::LinkParts& part : parts) {
    internal::report(options.progress, part.index, parts.size(), part.link);
    if (!part.mesh) continue;
    if (part.first_equal != part.index) {
      result.links.push_back(result.links[repair_of[part.first_equal]]);
      result.links.back().link = part.link;
    } else {
      result.links.push_back(internal::of_link(part.link, [&] { return repaired(part, options); }));
    }
    repair_of[part.index] = result.links.size() - 1;
    const std::vector<Sphere>& mended = result.links.back().repair.spheres;
    const auto there =
        std::find_if(result.spheres.begin(), result.spheres.end(),
                     [&](const LinkSpheres& link) { return link.link == part.link; });
    if (there != result.spheres.end()) {
      there->spheres = mended;
    } else {
      result.spheres.push_back({part.link, mended});
    }
  }
  return result;
}

}  // namespace spherule
