// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/counts.h"

#include <cstdio>

namespace spherule {

void Counts::judge(const EdgeResult& result, const Met& sampled, bool in_contact) {
  const bool is_free = result.verdict == Verdict::kFree;
  const bool collides = result.verdict == Verdict::kCollision;
  ++edges;
  contact += in_contact ? 1 : 0;
  proved += is_free ? 1 : 0;
  collision += collides ? 1 : 0;
  unknown += is_free || collides ? 0 : 1;
  missed += is_free && in_contact ? 1 : 0;
  extra += !is_free && !in_contact ? 1 : 0;
  fcl_missed += in_contact && !sampled.meshes ? 1 : 0;
  own_missed += collides && !sampled.spheres ? 1 : 0;
  looks += result.configurations;
}

void Counts::add(const Counts& other) {
  edges += other.edges;
  contact += other.contact;
  proved += other.proved;
  collision += other.collision;
  unknown += other.unknown;
  missed += other.missed;
  extra += other.extra;
  fcl_missed += other.fcl_missed;
  own_missed += other.own_missed;
  looks += other.looks;
  proof.add(other.proof);
  own.add(other.own);
  obbrss.add(other.obbrss);
  obb.add(other.obb);
}

void Counts::print_verdicts(const char* name) const {
  std::printf("| %-7s | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu |\n", name,
              edges, contact, proved, collision, unknown, missed, extra, fcl_missed, own_missed);
}

void Counts::print_times(const char* name) const {
  std::printf(
      "| %-7s | %4.1f | %6.2f %6.2f | %6.1f %6.1f | %6.1f %6.1f | %6.1f %6.1f | %5.1f %5.1f | "
      "%5.1f %5.1f | %5.1f %5.1f |\n",
      name, static_cast<double>(looks) / static_cast<double>(edges), proof.mean_us(),
      proof.median_us(), own.mean_us(), own.median_us(), obbrss.mean_us(), obbrss.median_us(),
      obb.mean_us(), obb.median_us(), own.over(proof), own.median_over(proof), obbrss.over(proof),
      obbrss.median_over(proof), obb.over(proof), obb.median_over(proof));
}

}  // namespace spherule
