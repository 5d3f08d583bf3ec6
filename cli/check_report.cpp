// SPDX-License-Identifier: BSD-3-Clause
#include "cli/check_report.h"

#include "cli/json.h"
#include "cli/units.h"

#include <algorithm>
#include <iomanip>
#include <iterator>
#include <sstream>

namespace spherule {
namespace {

const char* kind_of(const CheckedBody& body) {
  switch (body.kind) {
    case CheckedBody::Kind::kLink:
      return "link";
    case CheckedBody::Kind::kAttached:
      return "attached";
    case CheckedBody::Kind::kObstacle:
      break;
  }
  return "obstacle";
}

const TouchingPair* deepest(const CheckReport& report) {
  const auto found = std::max_element(
      report.pairs.begin(), report.pairs.end(), [](const TouchingPair& a, const TouchingPair& b) {
        return a.worst.contact.overlap_depth < b.worst.contact.overlap_depth;
      });
  return found == report.pairs.end() ? nullptr : &*found;
}

const char* verdict_of(const CheckReport& report) {
  return report.colliding > 0 ? "collision" : report.is_free() ? "free" : "not proved";
}

Json to_json(const CheckedBody& body) {
  Json json{{"kind", kind_of(body)}, {"name", body.name}};
  if (body.sphere >= 0) {
    json["tree"] = body.tree;
    json["sphere"] = body.sphere;
  }
  return json;
}

Json to_json(const TrajectoryPoint& point, const char* fraction) {
  Json json{{"line", point.line}};
  if (point.to_line > 0) {
    json["to_line"] = point.to_line;
    json[fraction] = spherule::to_json(point.fraction);
  }
  return json;
}

Json to_json(const FoundContact& found) {
  Json json = to_json(found.at, "fraction");
  json["first"] = to_json(found.contact.first);
  json["second"] = to_json(found.contact.second);
  json["depth"] = spherule::to_json(found.contact.overlap_depth);
  json["padding"] = spherule::to_json(found.contact.padding);
  json["point"] = spherule::to_json(found.contact.world_point);
  return json;
}

std::string text_of(const TrajectoryPoint& point) {
  std::ostringstream text;
  text << point.line;
  if (point.to_line > 0) {
    text << "-" << point.to_line << " at " << std::fixed << std::setprecision(4) << point.fraction;
  }
  return text.str();
}

std::string text_of(const Eigen::Vector3d& point) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(4) << point.x() << " " << point.y() << " " << point.z();
  return text.str();
}

// Columns as wide as their widest cell, the last one ragged.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::ostringstream text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool last = i + 1 == row.size();
      text << std::left << std::setw(last ? 0 : static_cast<int>(widths[i] + 2)) << row[i];
    }
    text << "\n";
  }
  return text.str();
}

}  // namespace

void CheckReport::add(const FoundContact& found) {
  const auto known = std::find_if(pairs.begin(), pairs.end(), [&](const TouchingPair& pair) {
    return pair.first.contact.first.name == found.contact.first.name &&
           pair.first.contact.second.name == found.contact.second.name;
  });
  const std::size_t at_start = found.at.fraction == 0.0 ? 1 : 0;
  if (known == pairs.end()) {
    pairs.push_back({1, at_start, found, found});
    return;
  }
  ++known->count;
  known->at_start += at_start;
  if (found.contact.overlap_depth > known->worst.contact.overlap_depth) known->worst = found;
}

std::vector<TouchingPair> always_touching(const CheckReport& report) {
  const std::size_t all = report.motions.value_or(report.configurations);
  std::vector<TouchingPair> result;
  std::copy_if(report.pairs.begin(), report.pairs.end(), std::back_inserter(result),
               [&](const TouchingPair& pair) {
                 return all > 1 && pair.at_start == all &&
                        pair.first.contact.second.kind != CheckedBody::Kind::kObstacle;
               });
  return result;
}

std::string check_table(const CheckReport& report) {
  std::ostringstream text;
  text << verdict_of(report) << ": " << report.configurations << " configurations";
  if (report.motions) {
    text << ", " << *report.motions << " motions, " << report.colliding << " of them collide, "
         << report.not_proved.size() << " are not proved free\n";
  } else {
    text << ", " << report.colliding << " of them collide\n";
  }
  if (!report.pairs.empty()) {
    std::vector<std::vector<std::string>> rows = {
        {"body", "touches", "times", "first at line", "deepest at line", "depth/mm", "where/m"}};
    for (const TouchingPair& pair : report.pairs) {
      const CheckedContact& worst = pair.worst.contact;
      std::ostringstream depth;
      depth << std::fixed << std::setprecision(2) << worst.overlap_depth * kMillimetresPerMetre;
      rows.push_back({worst.first.name, worst.second.name, std::to_string(pair.count),
                      text_of(pair.first.at), text_of(pair.worst.at), depth.str(),
                      text_of(worst.world_point)});
    }
    text << aligned(rows);
  }
  constexpr std::size_t kMost = 20;
  for (std::size_t i = 0; i < std::min(kMost, report.not_proved.size()); ++i) {
    text << "not proved beyond line " << text_of(report.not_proved[i]) << "\n";
  }
  if (report.not_proved.size() > kMost) {
    text << "and " << report.not_proved.size() - kMost << " more\n";
  }
  return text.str();
}

std::string check_json(const CheckReport& report) {
  Json json{{"verdict", verdict_of(report)}, {"configurations", report.configurations}};
  if (report.motions) json["motions"] = *report.motions;
  json["colliding"] = report.colliding;
  const TouchingPair* worst = deepest(report);
  json["first_contact"] = worst ? to_json(report.pairs.front().first) : Json(nullptr);
  json["worst_contact"] = worst ? to_json(worst->worst) : Json(nullptr);
  json["pairs"] = Json::array();
  for (const TouchingPair& pair : report.pairs) {
    json["pairs"].push_back({{"first", pair.first.contact.first.name},
                             {"second", pair.first.contact.second.name},
                             {"count", pair.count},
                             {"first_contact", to_json(pair.first)},
                             {"worst_contact", to_json(pair.worst)}});
  }
  json["not_proved"] = Json::array();
  for (const TrajectoryPoint& point : report.not_proved) {
    json["not_proved"].push_back(to_json(point, "free_until"));
  }
  return to_text(json);
}

}  // namespace spherule
