// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/counts.h"

#include <cstdio>

namespace spherule {

void Counts::judge(const EdgeResult& result, const EdgeResult& of_meshes, const Met& sampled,
                   bool in_contact) {
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
  const bool is_confirmed_free = of_meshes.verdict == Verdict::kFree;
  confirmed_proved += is_confirmed_free ? 1 : 0;
  confirmed_unknown += of_meshes.verdict == Verdict::kUnknown ? 1 : 0;
  confirmed_missed += is_confirmed_free && in_contact ? 1 : 0;
  confirmed_extra += !is_confirmed_free && !in_contact ? 1 : 0;
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
  confirmed_proved += other.confirmed_proved;
  confirmed_unknown += other.confirmed_unknown;
  confirmed_missed += other.confirmed_missed;
  confirmed_extra += other.confirmed_extra;
  proof.add(other.proof);
  confirmed.add(other.confirmed);
  own.add(other.own);
  obbrss.add(other.obbrss);
  obb.add(other.obb);
}

void Counts::print_verdicts(const char* name) const {
  std::printf(
      "| %-7s | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu "
      "| "
      "%5zu |\n",
      name, edges, contact, proved, collision, unknown, missed, extra, confirmed_proved,
      confirmed_unknown, confirmed_missed, confirmed_extra, fcl_missed, own_missed);
}

void Counts::print_times(const char* name) const {
  std::printf("| %-7s | %4.1f | %6.2f %6.2f |", name,
              static_cast<double>(looks) / static_cast<double>(edges), proof.mean_us(),
              proof.median_us());
  for (const Times* times : {&confirmed, &own, &obbrss, &obb}) {
    std::printf(" %5.1f %5.1f |", times->over(proof), times->median_over(proof));
  }
  std::printf("\n");
}

}  // namespace spherule
