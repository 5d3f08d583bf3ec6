// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/link_pairs.h"

#include "base/bytes.h"
#include "base/crc64.h"
#include "base/error.h"
#include "base/files.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "robot/model/link_paths.h"
#include "robot/pairs/link_pieces.h"
#include "robot/pairs/pair_search.h"
#include "robot/pairs/proof_scope.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace spherule {
namespace {

using internal::append_number;

using Clock = std::chrono::steady_clock;

void check(const LinkPairOptions& options) {
  if (!(options.smallest_motion >= 0.0) || !std::isfinite(options.smallest_motion) ||
      !(options.seconds >= 0.0) || !std::isfinite(options.seconds) || options.threads < 0) {
    throw Error("link pairs", "an option is negative or not finite");
  }
}

// Searches leave variables that change nothing between the two links at zero.
void keep_others_within_limits(const RobotModel& robot,
                               std::span<const FreeBoxes::Variable> variables,
                               std::vector<double>& configuration) {
  for (std::size_t i = 0; i < configuration.size(); ++i) {
    const bool is_searched = std::ranges::any_of(variables, [&](const FreeBoxes::Variable& other) {
      return static_cast<std::size_t>(other.index) == i;
    });
    if (is_searched) continue;
    const Joint& joint = robot.joints()[static_cast<std::size_t>(robot.variable_joints()[i])];
    configuration[i] = std::clamp(configuration[i], joint.lower, joint.upper);
  }
}

LinkPair prove(const RobotModel& robot, int first, int second,
               std::span<const internal::LinkPieces> pieces, const LinkPairOptions& options,
               Clock::time_point end) {
  LinkPair result{.first = first, .second = second};
  const auto is_over = [&] {
    return options.stop.stop_requested() || (options.seconds > 0.0 && Clock::now() >= end);
  };
  if (is_over()) return result;
  const auto space =
      internal::make_pair_space(robot, first, second, pieces[static_cast<std::size_t>(first)],
                                pieces[static_cast<std::size_t>(second)]);
  if (!space || is_over()) return result;
  // Of its own for each pair, so that no thread and no other pair matters.
  const std::uint64_t seed = options.seed * 0x9E3779B97F4A7C15U +
                             static_cast<std::uint64_t>(first) * robot.links().size() +
                             static_cast<std::uint64_t>(second);
  std::optional<internal::PairWitness> witness;
  const auto search_witness = [&] {
    witness = internal::find_witness(*space, options.samples, seed);
    return witness->touches();
  };
  internal::PairSearchResult found =
      internal::search_free_boxes(*space, {.boxes = options.undecided_boxes,
                                           .boxes_once_touching = options.boxes,
                                           .finds_contact = search_witness,
                                           .smallest_motion = options.smallest_motion,
                                           .is_over = is_over});
  result.searched_boxes = found.boxes;
  result.boxes = FreeBoxes(space->variables, found.nodes);
  if (result.boxes.is_all_free()) {
    // A witness is within the rounding of the mesh test then.
    if (internal::take_all_positions(robot, space->variables)) result.verdict = PairVerdict::kNever;
    return result;
  }
  if (found.witness.empty() && !witness && !is_over()) search_witness();
  if (witness) {
    result.smallest_gap = witness->gap;
    if (witness->touches()) found.witness = std::move(witness->configuration);
  }
  if (!found.witness.empty()) {
    result.verdict = PairVerdict::kTouching;
    result.smallest_gap = 0.0;
    result.witness = std::move(found.witness);
    keep_others_within_limits(robot, space->variables, result.witness);
  }
  return result;
}

void append(std::string& bytes, const Eigen::Vector3d& v) {
  for (const double value : v) append_number(bytes, value);
}

}  // namespace

std::string_view name_of(PairVerdict verdict) {
  constexpr std::array<std::string_view, 3> kNames = {"never", "touching", "unknown"};
  static_assert(kNames.size() == static_cast<std::size_t>(PairVerdict::kUnknown) + 1);
  return kNames[static_cast<std::size_t>(verdict)];
}

LinkPairs::LinkPairs(std::vector<LinkPair> pairs, std::size_t link_count, std::uint64_t mechanism,
                     std::uint64_t bodies, int tool_link)
    : pairs_(std::move(pairs)),
      link_count_(link_count),
      mechanism_(mechanism),
      bodies_(bodies),
      tool_link_(tool_link) {
  if (tool_link < -1 || tool_link >= static_cast<int>(link_count)) {
    throw Error("link pairs", "the link of a tool is not there");
  }
  std::pair<int, int> last{-1, -1};
  for (const LinkPair& pair : pairs_) {
    if (pair.first < 0 || pair.first >= pair.second ||
        static_cast<std::size_t>(pair.second) >= link_count ||
        !(last < std::pair(pair.first, pair.second))) {
      throw Error("link pairs", "the pairs are not in order");
    }
    if (tool_link >= 0 && pair.first != tool_link && pair.second != tool_link) {
      throw Error("link pairs", "a pair is not of the tool's link");
    }
    const bool is_touching = pair.verdict == PairVerdict::kTouching;
    if (is_touching == pair.witness.empty() || (is_touching && pair.boxes.is_all_free()) ||
        (pair.verdict == PairVerdict::kNever && !pair.boxes.is_all_free())) {
      throw Error("link pairs", "a verdict contradicts its proof");
    }
    last = {pair.first, pair.second};
  }
}

const LinkPair* LinkPairs::find(int first, int second) const noexcept {
  const std::pair<int, int> key(std::min(first, second), std::max(first, second));
  const auto found = std::lower_bound(
      pairs_.begin(), pairs_.end(), key,
      [](const LinkPair& pair, const auto& k) { return std::pair(pair.first, pair.second) < k; });
  if (found == pairs_.end() || std::pair(found->first, found->second) != key) return nullptr;
  return &*found;
}

namespace {

// Of all pairs, or those of a link that a tool stands for (-1: all).
LinkPairs prove_pairs_of(int only, const RobotModel& robot, std::span<const LinkBody> bodies,
                         const LinkPairOptions& options) {
  require_rounding_to_nearest();
  check(options);
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(std::min(options.seconds, 1e9)));
  const std::size_t count = robot.links().size();
  const std::size_t threads = internal::thread_count(options.threads);
  const auto bodies_of = internal::bodies_by_link(robot, bodies);
  std::vector<internal::LinkPieces> pieces(count);
  internal::share_work(count, threads, [&](std::size_t, std::size_t link) {
    if (!bodies_of[link].empty()) pieces[link] = internal::make_link_pieces(bodies_of[link]);
  });
  std::vector<LinkPair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      const int first = static_cast<int>(i);
      const int second = static_cast<int>(j);
      if (bodies_of[i].empty() || bodies_of[j].empty()) continue;
      if (only >= 0 && first != only && second != only) continue;
      if (internal::moving_joints(robot, first, second).empty()) continue;
      pairs.push_back({.first = first, .second = second});
    }
  }
  std::mutex progress_lock;
  std::size_t done = 0;
  internal::share_work(pairs.size(), threads, [&](std::size_t, std::size_t i) {
    pairs[i] = prove(robot, pairs[i].first, pairs[i].second, pieces, options, end);
    if (!options.progress) return;
    const std::scoped_lock lock(progress_lock);
    options.progress(static_cast<double>(++done) / static_cast<double>(pairs.size()),
                     "pairs of links");
  });
  return LinkPairs(std::move(pairs), count, mechanism_fingerprint(robot),
                   bodies_fingerprint(bodies), only);
}

}  // namespace

LinkPairs prove_link_pairs(const RobotModel& robot, std::span<const LinkBody> bodies,
                           const LinkPairOptions& options) {
  return prove_pairs_of(-1, robot, bodies, options);
}

LinkPairs prove_attached_pairs(const RobotModel& robot, std::span<const LinkBody> bodies,
                               const LinkBody& tool, const LinkPairOptions& options) {
  std::vector<LinkBody> all;
  for (const LinkBody& body : bodies) {
    if (body.link != tool.link) all.push_back(body);
  }
  all.push_back(tool);
  return prove_pairs_of(tool.link, robot, all, options);
}

std::uint64_t mechanism_fingerprint(const RobotModel& robot) {
  std::string bytes;
  const auto add_name = [&](const std::string& name) {
    append_number(bytes, std::uint64_t{name.size()});
    bytes += name;
  };
  for (const Link& link : robot.links()) add_name(link.name);
  for (const Joint& joint : robot.joints()) {
    add_name(joint.name);
    for (const int value : {static_cast<int>(joint.type), joint.parent_link, joint.child_link}) {
      append_number(bytes, std::int64_t{value});
    }
    const Eigen::Quaterniond rotation = joint.parent_from_joint.rotation();
    for (const double value : rotation.coeffs()) append_number(bytes, value);
    append(bytes, joint.parent_from_joint.translation());
    append(bytes, joint.axis);
    append_number(bytes, std::int64_t{joint.variable});
    append_number(bytes, joint.multiplier);
    append_number(bytes, joint.offset);
    append_number(bytes, std::int64_t{joint.mimics});
  }
  return crc64(bytes);
}

std::uint64_t bodies_fingerprint(std::span<const LinkBody> bodies) {
  std::string bytes;
  for (const LinkBody& body : bodies) {
    append_number(bytes, std::int64_t{body.link});
    if (body.mesh != nullptr) {
      append_number(bytes, body.mesh->inflation());
      const MeshTree& mesh = body.mesh->mesh();
      const auto count = static_cast<std::int32_t>(mesh.tree().spheres().size());
      append_number(bytes, std::int64_t{count});
      for (std::int32_t i = 0; i < count; ++i) {
        for (const Eigen::Vector3d& corner : mesh.triangle(i)) append(bytes, corner);
      }
    } else if (body.spheres != nullptr) {
      append_number(bytes, std::int64_t{-1});
      for (const Sphere& sphere : body.spheres->spheres()) {
        append(bytes, sphere.center);
        append_number(bytes, sphere.radius);
      }
    }
  }
  return crc64(bytes);
}

// Files of proofs; the layout is in docs/link-pairs-file.md.
namespace {

// As in tree files: a byte above 127 and two kinds of line end show transfers that are not binary.
constexpr std::string_view kMagic = "\x89SLP\r\n\x1a\n";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kChecksumSize = 8;

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

  template <class Number>
  Number take() {
    return internal::number_at<Number>(take(sizeof(Number)).data());
  }
  std::string_view take(std::size_t count) {
    if (rest_.size() < count) throw Error(name_, "the file is cut short");
    const std::string_view result = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return result;
  }
  bool is_at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
  const std::string& name_;
};

LinkPair take_pair(Reader& reader, const std::string& name) {
  LinkPair pair;
  pair.first = reader.take<std::int32_t>();
  pair.second = reader.take<std::int32_t>();
  const auto verdict = reader.take<std::uint8_t>();
  if (verdict > static_cast<std::uint8_t>(PairVerdict::kUnknown)) {
    throw Error(name, "a verdict is unknown");
  }
  pair.verdict = static_cast<PairVerdict>(verdict);
  pair.smallest_gap = reader.take<double>();
  pair.searched_boxes = reader.take<std::uint64_t>();
  const auto width = reader.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < width; ++i) pair.witness.push_back(reader.take<double>());
  std::vector<FreeBoxes::Variable> variables;
  const auto count = reader.take<std::uint8_t>();
  for (std::uint8_t i = 0; i < count; ++i) {
    FreeBoxes::Variable variable;
    variable.index = reader.take<std::int32_t>();
    variable.wraps = reader.take<std::uint8_t>() != 0;
    variable.lower = reader.take<double>();
    variable.upper = reader.take<double>();
    variables.push_back(variable);
  }
  const auto nodes = reader.take<std::uint32_t>();
  pair.boxes = FreeBoxes(std::move(variables), reader.take(nodes));
  return pair;
}

const std::string& name_of_link(const RobotModel& robot, int link) {
  return robot.links()[static_cast<std::size_t>(link)].name;
}

// What was proved for a pair covers the ranges that would be searched for this robot.
void check_ranges(const LinkPair& pair, const RobotModel& robot, const std::string& name) {
  if (pair.boxes.variables().empty()) {
    if (pair.boxes.is_all_free()) throw Error(name, "a pair is proved without variables");
    return;  // nothing is proved
  }
  const std::vector<FreeBoxes::Variable> ranges =
      internal::ranges_of(robot, internal::moving_joints(robot, pair.first, pair.second));
  const std::vector<FreeBoxes::Variable>& proved = pair.boxes.variables();
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (i >= proved.size() || ranges.size() != proved.size() ||
        ranges[i].index != proved[i].index || ranges[i].wraps != proved[i].wraps) {
      throw Error(name, "the variables between links '" + name_of_link(robot, pair.first) +
                            "' and '" + name_of_link(robot, pair.second) +
                            "' are not those of the robot");
    }
    if (ranges[i].lower < proved[i].lower || ranges[i].upper > proved[i].upper) {
      const auto variable = static_cast<std::size_t>(ranges[i].index);
      const auto joint = static_cast<std::size_t>(robot.variable_joints()[variable]);
      throw Error(name, "the limits of joint '" + robot.joints()[joint].name +
                            "' are wider than those it was made with");
    }
  }
}

}  // namespace

std::string internal::encode_link_pairs(const LinkPairs& pairs) {
  std::string bytes(kMagic);
  append_number(bytes, kVersion);
  append_number(bytes, static_cast<std::uint32_t>(pairs.link_count()));
  append_number(bytes, pairs.mechanism());
  append_number(bytes, pairs.bodies());
  append_number(bytes, static_cast<std::uint32_t>(pairs.tool_link()));
  append_number(bytes, static_cast<std::uint32_t>(pairs.pairs().size()));
  for (const LinkPair& pair : pairs.pairs()) {
    append_number(bytes, static_cast<std::uint32_t>(pair.first));
    append_number(bytes, static_cast<std::uint32_t>(pair.second));
    append_number(bytes, static_cast<std::uint8_t>(pair.verdict));
    append_number(bytes, pair.smallest_gap);
    append_number(bytes, std::uint64_t{pair.searched_boxes});
    append_number(bytes, static_cast<std::uint32_t>(pair.witness.size()));
    for (const double value : pair.witness) append_number(bytes, value);
    append_number(bytes, static_cast<std::uint8_t>(pair.boxes.variables().size()));
    for (const FreeBoxes::Variable& variable : pair.boxes.variables()) {
      append_number(bytes, static_cast<std::uint32_t>(variable.index));
      append_number(bytes, static_cast<std::uint8_t>(variable.wraps ? 1 : 0));
      append_number(bytes, variable.lower);
      append_number(bytes, variable.upper);
    }
    append_number(bytes, static_cast<std::uint32_t>(pair.boxes.nodes().size()));
    bytes += pair.boxes.nodes();
  }
  append_number(bytes, crc64(bytes));
  return bytes;
}

LinkPairs internal::decode_link_pairs(std::string_view bytes, const std::string& name) {
  if (bytes.substr(0, kMagic.size()) != kMagic) {
    throw Error(name, kMagic.starts_with(bytes)
                          ? "the file is cut short"
                          : "is not a file of pairs of links (NAME.pairs of spherule robot)");
  }
  if (bytes.size() < kMagic.size() + 4 + kChecksumSize) throw Error(name, "the file is cut short");
  const std::string_view content = bytes.substr(0, bytes.size() - kChecksumSize);
  Reader reader(content.substr(kMagic.size()), name);
  const auto version = reader.take<std::uint32_t>();
  if (version == 0 || version > kVersion) {
    throw Error(name, "has format version " + std::to_string(version) +
                          "; this program reads versions up to " + std::to_string(kVersion));
  }
  Reader checksum(bytes.substr(content.size()), name);
  if (checksum.take<std::uint64_t>() != crc64(content)) {
    throw Error(name, "the checksum is wrong: the file is damaged or cut short");
  }
  try {
    const auto links = reader.take<std::uint32_t>();
    const auto mechanism = reader.take<std::uint64_t>();
    const auto bodies = reader.take<std::uint64_t>();
    const int tool_link = reader.take<std::int32_t>();
    const auto count = reader.take<std::uint32_t>();
    std::vector<LinkPair> pairs;
    for (std::uint32_t i = 0; i < count; ++i) pairs.push_back(take_pair(reader, name));
    if (!reader.is_at_end()) throw Error(name, "the file is too long");
    return LinkPairs(std::move(pairs), links, mechanism, bodies, tool_link);
  } catch (const Error& error) {
    throw Error(name, error.reason());
  }
}

void save_link_pairs(const LinkPairs& pairs, const std::filesystem::path& path) {
  write_file_atomically(path, internal::encode_link_pairs(pairs));
}

LinkPairs load_link_pairs(const std::filesystem::path& path, const RobotModel& robot,
                          std::span<const LinkBody> bodies) {
  const std::string name = path.string();
  LinkPairs result = internal::decode_link_pairs(read_file(path), name);
  if (result.mechanism() != mechanism_fingerprint(robot) ||
      result.link_count() != robot.links().size()) {
    throw Error(name, "was made for another robot: its links and joints are not these");
  }
  if (result.bodies() != bodies_fingerprint(bodies)) {
    throw Error(name, "was made for other meshes or attached bodies of this robot");
  }
  for (const LinkPair& pair : result.pairs()) check_ranges(pair, robot, name);
  return result;
}

}  // namespace spherule

namespace spherule::internal {

void require_proofs_of(const LinkPairs& pairs, const RobotModel& robot, int tool_link) {
  if (pairs.mechanism() != mechanism_fingerprint(robot) ||
      pairs.link_count() != robot.links().size()) {
    throw Error("proofs of pairs", "they are of another robot: its links and joints are not these");
  }
  if (pairs.tool_link() != tool_link) {
    throw Error("proofs of pairs", tool_link < 0 ? "they are of a tool alone"
                                                 : "they are of no tool on the object's link");
  }
  for (const LinkPair& pair : pairs.pairs()) {
    for (const FreeBoxes::Variable& variable : pair.boxes.variables()) {
      if (variable.index < robot.variable_count()) continue;
      throw Error("proofs of pairs", "they read a variable that the robot does not have");
    }
  }
}

void require_never_holds(const LinkPairs& pairs, const RobotModel& robot) {
  require_proofs_of(pairs, robot);
  for (const LinkPair& pair : pairs.pairs()) {
    if (pair.verdict != PairVerdict::kNever) continue;
    for (const FreeBoxes::Variable& proved : pair.boxes.variables()) {
      const int index = robot.variable_joints()[static_cast<std::size_t>(proved.index)];
      const Joint& joint = robot.joints()[static_cast<std::size_t>(index)];
      if (proved.wraps || (proved.lower <= joint.lower && joint.upper <= proved.upper)) continue;
      throw Error("proofs of pairs", "the limits of a joint are wider than those they hold for");
    }
  }
}

}  // namespace spherule::internal
