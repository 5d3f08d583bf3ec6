// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/counts.h"

#include <algorithm>
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
  own_missed += collides && !sampled.spheres ? 1 : 0;
  evaluations += result.configurations;
  for (std::size_t i = 0; i < peers.size(); ++i) {
    const bool met = sampled.peers[i] != 0;
    peers[i].missed += in_contact && !met ? 1 : 0;
    peers[i].extra += !in_contact && met ? 1 : 0;
  }
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
  own_missed += other.own_missed;
  evaluations += other.evaluations;
  confirmed_proved += other.confirmed_proved;
  confirmed_unknown += other.confirmed_unknown;
  confirmed_missed += other.confirmed_missed;
  confirmed_extra += other.confirmed_extra;
  proof.add(other.proof);
  confirmed.add(other.confirmed);
  own.add(other.own);
  for (const PeerCounts& peer : other.peers) {
    const auto same = [&](const PeerCounts& mine) { return mine.name == peer.name; };
    auto mine = std::find_if(peers.begin(), peers.end(), same);
    if (mine == peers.end()) mine = peers.insert(mine, PeerCounts{.name = peer.name});
    mine->missed += peer.missed;
    mine->extra += peer.extra;
    mine->times.add(peer.times);
  }
}

void Counts::print_verdicts_head() const {
  std::printf(
      "| scene | edges | in contact | proved free | collision | unknown | missed | extra | "
      "confirmed: proved | unknown | missed | extra | own missed |");
  for (const PeerCounts& peer : peers) std::printf(" %s missed / extra |", peer.name.c_str());
  std::printf("\n|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (std::size_t i = 0; i < peers.size(); ++i) std::printf("---|");
  std::printf("\n");
}

void Counts::print_verdicts(const char* name) const {
  std::printf("| %-7s |", name);
  for (const std::size_t count :
       {edges, contact, proved, collision, unknown, missed, extra, confirmed_proved,
        confirmed_unknown, confirmed_missed, confirmed_extra, own_missed}) {
    std::printf(" %5zu |", count);
  }
  for (const PeerCounts& peer : peers) std::printf(" %zu / %zu |", peer.missed, peer.extra);
  std::printf("\n");
}

void Counts::print_times_head() const {
  std::printf(
      "\nproof: us an edge, mean and median; times as long as that, in all and median\n"
      "| scene   | evaluations | proof | confirmed | own sampled |");
  for (const PeerCounts& peer : peers) std::printf(" %s |", peer.name.c_str());
  std::printf("\n|---|---|---|---|---|");
  for (std::size_t i = 0; i < peers.size(); ++i) std::printf("---|");
  std::printf("\n");
}

void Counts::print_times(const char* name) const {
  std::printf("| %-7s | %4.1f | %6.2f %6.2f |", name,
              static_cast<double>(evaluations) / static_cast<double>(edges), proof.mean_us(),
              proof.median_us());
  const auto print = [&](const Times& times) {
    std::printf(" %5.1f %5.1f |", times.over(proof), times.median_over(proof));
  };
  print(confirmed);
  print(own);
  for (const PeerCounts& peer : peers) print(peer.times);
  std::printf("\n");
}

}  // namespace spherule
