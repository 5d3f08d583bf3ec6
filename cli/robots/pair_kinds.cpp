// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/pair_kinds.h"

#include "cli/robots/pair_report.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "robot/cover/link_mesh.h"
#include "robot/model/link_spheres.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"

#include <algorithm>
#include <iomanip>
#include <map>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>

namespace spherule {
namespace {

RobotModel model_of(const RobotDescription& robot, std::span<const LinkSpheres> spheres) {
  std::vector<LinkSpheres> known(spheres.begin(), spheres.end());
  std::erase_if(known, [&](const LinkSpheres& link) {
    return robot.model.find_link(link.link) < 0 || link.spheres.empty();
  });
  return with_spheres(robot.model, known);
}

std::shared_ptr<const LinkPairs> proofs_of(const RobotDescription& robot, LinkGeometry geometry,
                                           const PairSources& sources, int threads) {
  if (sources.pairs.empty() && !sources.proves) return nullptr;
  const std::vector<LinkBody> bodies = link_bodies(robot, {.geometry = geometry});
  if (!sources.pairs.empty()) {
    return std::make_shared<const LinkPairs>(load_link_pairs(sources.pairs, robot.model, bodies));
  }
  ProgressBar bar;
  LinkPairOptions options;
  options.threads = threads;
  options.progress = bar.callback();
  return std::make_shared<const LinkPairs>(prove_link_pairs(robot.model, bodies, options));
}

bool is_joined(const PairStatus& pair) {
  return pair.reason == AllowedReason::kRigid || pair.reason == AllowedReason::kAdjacent;
}

}  // namespace

PairKinds pair_kinds(const RobotDescription& robot, const RobotSpheres& spheres,
                     LinkGeometry geometry, const PairSources& sources, int threads) {
  PairKinds kinds{.model = model_of(robot, spheres.links),
                  .proofs = proofs_of(robot, geometry, sources, threads)};
  std::vector<DisabledPair> given;
  add_missing_pairs(spheres.self_collision_ignore, robot.model, given);
  if (!sources.srdf.empty()) {
    const SemanticDescription semantics = read_srdf(sources.srdf);
    add_missing_pairs(semantics.disabled_pairs, robot.model, given);
    if (kinds.proofs != nullptr) {
      kinds.judgement = judge_srdf(robot.model, semantics, *kinds.proofs);
    }
  }
  // What was ignored because of proofs is what they say of it, if there are any.
  if (kinds.proofs != nullptr) {
    std::erase_if(given,
                  [](const DisabledPair& pair) { return pair.reason == kProvedNeverReason; });
  }
  AllowedCollisions allowed(kinds.model);
  for (const DisabledPair& pair : given) allowed.allow(pair.link_a, pair.link_b);
  kinds.pairs = pair_statuses(kinds.model, allowed, kinds.proofs);
  return kinds;
}

std::string describe(const PairKinds& kinds) {
  std::map<std::string_view, std::size_t> counts;
  for (const PairStatus& pair : kinds.pairs) ++counts[kind_of(pair)];
  std::ostringstream out;
  out << "pairs of links: " << kinds.pairs.size();
  for (const auto& [kind, count] : counts) {
    out << (kind == counts.begin()->first ? "; " : ", ") << count << " " << kind;
  }
  out << "\n";
  std::vector<std::vector<std::string>> rows = {{"link", "link", "kind", "meshes", "proved free"}};
  for (const PairStatus& pair : kinds.pairs) {
    if (is_joined(pair)) continue;
    rows.push_back({link_name(kinds.model, pair.first), link_name(kinds.model, pair.second),
                    std::string(kind_of(pair)),
                    std::string(pair.verdict ? name_of(*pair.verdict) : "-"),
                    pair.verdict ? percent(pair.free_share, 1) : "-"});
  }
  return out.str() + (rows.size() > 1 ? aligned(rows) : "");
}

Json to_json(const PairKinds& kinds) {
  Json json{{"pairs", Json::array()}};
  for (const PairStatus& pair : kinds.pairs) {
    Json written{
        {"links", {link_name(kinds.model, pair.first), link_name(kinds.model, pair.second)}},
        {"kind", kind_of(pair)}};
    if (pair.verdict) {
      written["verdict"] = name_of(*pair.verdict);
      written["free_share"] = pair.free_share;
      const LinkPair& proof = *kinds.proofs->find(pair.first, pair.second);
      if (!proof.witness.empty()) written["witness"] = posture_json(kinds.model, proof.witness);
      written["smallest_gap"] = to_json(proof.smallest_gap);
    }
    json["pairs"].push_back(std::move(written));
  }
  if (!kinds.judgement.pairs.empty()) json["disabled_pairs"] = Json::array();
  for (const JudgedPair& judged : kinds.judgement.pairs) {
    json["disabled_pairs"].push_back(to_json(judged, kinds.model));
  }
  return json;
}

}  // namespace spherule
