// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/pair_report.h"

#include "cli/text/message.h"
#include "cli/text/units.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iomanip>
#include <numbers>
#include <sstream>
#include <string>
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
  std::ostringstream out;
  out << "in " << contact.posture << " " << contact.first << " and " << contact.second << " touch";
  if (contact.do_meshes_touch) {
    out << ", by their meshes, too";
    return out.str();
  }
  out << " by their spheres alone, " << std::fixed << std::setprecision(1)
      << contact.overlap_depth * kMillimetresPerMetre << " mm deep: "
      << (contact.is_proved_free ? "free for who takes the proofs (NAME.pairs), " : "")
      << "a smaller E for either, or --false-alarms, would mend it";
  return out.str();
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

std::string describe_link_pairs(const LinkPairs& pairs, double seconds) {
  if (pairs.pairs().empty()) return {};
  std::ostringstream out;
  out << "pairs of links: " << count_of(pairs, PairVerdict::kNever)
      << " proved never to touch within the limits, " << count_of(pairs, PairVerdict::kTouching)
      << " can touch, " << count_of(pairs, PairVerdict::kUnknown) << " unknown; " << std::fixed
      << std::setprecision(1) << seconds << " s\n";
  return out.str();
}

Json posture_json(const RobotModel& robot, const std::vector<double>& configuration) {
  Json json = Json::object();
  for (std::size_t i = 0; i < configuration.size(); ++i) {
    json[joint_of(robot, i).name] = configuration[i];
  }
  return json;
}

std::string describe_posture(const RobotModel& robot, const std::vector<double>& configuration) {
  std::ostringstream out;
  for (std::size_t i = 0; i < configuration.size(); ++i) {
    const Joint& joint = joint_of(robot, i);
    out << (i == 0 ? "" : ", ") << one_line(joint.name) << " " << std::fixed;
    if (joint.turns()) {
      out << std::setprecision(1) << configuration[i] * 180.0 / std::numbers::pi << " deg";
    } else {
      out << std::setprecision(4) << configuration[i] << " m";
    }
  }
  return out.str();
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

}  // namespace spherule
