// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/pair_report.h"

#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "robot/cover/robot_spheres.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

const Joint& joint_of(const RobotModel& robot, std::size_t variable) {
  return robot.joints()[static_cast<std::size_t>(robot.variable_joints()[variable])];
}

std::size_t count_of(const LinkPairs& pairs, PairVerdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(pairs.pairs().begin(), pairs.pairs().end(),
                    [&](const LinkPair& pair) { return pair.verdict == verdict; }));
}

constexpr std::size_t kShownContacts = 5;

std::string describe(const PostureContact& contact) {
  const std::string touch =
      concat("in ", contact.posture, " ", contact.first, " and ", contact.second, " touch");
  if (contact.do_meshes_touch) return touch + ", by their meshes, too";
  return concat(
      touch, " by their spheres alone, ", decimal(contact.overlap_depth * kMillimetresPerMetre, 1),
      " mm deep: ", contact.is_proved_free ? "free for who takes the proofs (NAME.pairs), " : "",
      "a smaller E for either, or --false-alarms, would mend it");
}

std::vector<std::string> first_of(const std::vector<PostureContact>& contacts,
                                  const std::string& kind) {
  const std::size_t shown = std::min(contacts.size(), kShownContacts);
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < shown; ++i) lines.push_back(describe(contacts[i]));
  if (contacts.size() > shown) {
    lines.push_back("so do " + std::to_string(contacts.size() - shown) + " more pairs, " + kind +
                    ": posture_contacts in NAME.report.json has them all");
  }
  return lines;
}

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

}  // namespace

const std::string& link_name(const RobotModel& robot, int link) {
  return robot.links()[static_cast<std::size_t>(link)].name;
}

Json pair_summary(const LinkPairs& pairs, const RobotModel& robot, double seconds) {
  Json json = Json::object();
  for (const PairVerdict verdict :
       {PairVerdict::kNever, PairVerdict::kTouching, PairVerdict::kUnknown}) {
    json[std::string(name_of(verdict))] = count_of(pairs, verdict);
  }
  json["seconds"] = seconds;
  json["pairs"] = Json::array();
  for (const LinkPair& pair : pairs.pairs()) {
    Json written = Json::object();
    written["links"] = {link_name(robot, pair.first), link_name(robot, pair.second)};
    written["verdict"] = name_of(pair.verdict);
    if (!pair.witness.empty()) written["witness"] = posture_json(robot, pair.witness);
    written["smallest_gap"] = to_json(pair.smallest_gap);
    written["free_share"] = pair.boxes.free_share();
    written["boxes"] = pair.boxes.node_count() / 2 + 1;
    json["pairs"].push_back(std::move(written));
  }
  return json;
}

Json to_json(const std::vector<PostureContact>& contacts) {
  Json json = Json::array();
  for (const PostureContact& contact : contacts) {
    json.push_back({{"posture", contact.posture},
                    {"links", {contact.first, contact.second}},
                    {"overlap_depth", contact.overlap_depth},
                    {"meshes_touch", contact.do_meshes_touch},
                    {"proved_free", contact.is_proved_free}});
  }
  return json;
}

Json to_json(const JudgedPair& judged, const RobotModel& robot) {
  Json json = Json::object();
  json["links"] = {judged.pair.link_a, judged.pair.link_b};
  json["reason"] = judged.pair.reason;
  json["verdict"] = name_of(judged.verdict);
  json["wrong"] = judged.is_wrong;
  if (!judged.witness.empty()) json["witness"] = posture_json(robot, judged.witness);
  json["smallest_gap"] = to_json(judged.smallest_gap);
  return json;
}

std::string describe(const DisabledPair& pair) {
  const std::string reason = pair.reason.empty() ? "no reason" : "\"" + pair.reason + "\"";
  return one_line(pair.link_a + " and " + pair.link_b + " (" + reason + ")");
}

std::vector<std::string> wrong_pairs(const SrdfJudgement& judgement, const RobotModel& robot) {
  std::vector<std::string> warnings;
  for (const JudgedPair& judged : judgement.pairs) {
    if (!judged.is_wrong) continue;
    warnings.push_back("the SRDF disables " + describe(judged.pair) + ", which touch at " +
                       describe_posture(robot, judged.witness));
  }
  return warnings;
}

std::string describe_link_pairs(const Json& summary) {
  if (summary["pairs"].empty()) return {};
  return filled(
      "pairs of links: {never} proved never to touch within the limits, {touching} can touch, "
      "{unknown} unknown; {seconds:f1} s\n",
      summary);
}

Json posture_json(const RobotModel& robot, const std::vector<double>& configuration) {
  Json json = Json::object();
  for (std::size_t i = 0; i < configuration.size(); ++i) {
    json[joint_of(robot, i).name] = configuration[i];
  }
  return json;
}

std::string describe_posture(const RobotModel& robot, const std::vector<double>& configuration) {
  std::string text;
  for (std::size_t i = 0; i < configuration.size(); ++i) {
    const Joint& joint = joint_of(robot, i);
    const double position = configuration[i];
    text += (i == 0 ? "" : ", ") + one_line(joint.name) + " " +
            (joint.turns() ? decimal(position * 180.0 / std::numbers::pi, 1) + " deg"
                           : decimal(position, 4) + " m");
  }
  return text;
}

std::vector<std::string> contact_warnings(const std::vector<PostureContact>& contacts) {
  std::vector<PostureContact> of_meshes;
  std::vector<PostureContact> of_spheres;
  for (const PostureContact& contact : contacts) {
    (contact.do_meshes_touch ? of_meshes : of_spheres).push_back(contact);
  }
  if (of_spheres.size() > kShownContacts) {
    std::ranges::stable_sort(of_spheres, std::greater(), &PostureContact::overlap_depth);
  }
  std::vector<std::string> warnings = first_of(of_meshes, "by their meshes, too");
  const std::vector<std::string> others = first_of(of_spheres, "by their spheres alone");
  warnings.insert(warnings.end(), others.begin(), others.end());
  return warnings;
}

PairKinds pair_kinds(const RobotDescription& robot, const RobotSpheres& spheres,
                     LinkGeometry geometry, const PairSources& sources, int threads) {
  PairKinds kinds{.model = model_of(robot, spheres.links),
                  .proofs = proofs_of(robot, geometry, sources, threads)};
  std::vector<DisabledPair> given;
  add_missing_pairs(spheres.self_collision_ignore, robot.model, given);
  SemanticDescription semantics;
  if (!sources.srdf.empty()) {
    semantics = read_srdf(sources.srdf);
    for (const std::string& warning : semantics.warnings) warn(warning);
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
  allowed.allow(given);
  allowed.apply(semantics);
  kinds.pairs = pair_statuses(kinds.model, allowed, kinds.proofs);
  return kinds;
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

std::string describe_kinds(const Json& kinds) {
  std::map<std::string, std::size_t> counts;
  Json rows = Json::array();
  for (const Json& pair : kinds["pairs"]) {
    ++counts[pair["kind"]];
    if (pair["kind"] != "rigid" && pair["kind"] != "adjacent") rows.push_back(pair);
  }
  std::string text = concat("pairs of links: ", kinds["pairs"].size());
  for (const auto& [kind, count] : counts) {
    text += concat(kind == counts.begin()->first ? "; " : ", ", count, " ", kind);
  }
  if (rows.empty()) return text + "\n";
  return text + "\n" +
         table(rows, {{"link", "{links.0}"},
                      {"link", "{links.1}"},
                      {"kind", "{kind}"},
                      {"meshes", "{verdict}"},
                      {"proved free", "{free_share:%1}"}});
}

}  // namespace spherule
