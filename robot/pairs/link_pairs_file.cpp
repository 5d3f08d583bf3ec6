// SPDX-License-Identifier: BSD-3-Clause
#include "base/crc64.h"
#include "base/error.h"
#include "base/files.h"
#include "robot/model/link_paths.h"
#include "robot/pairs/link_pairs.h"
#include "robot/pairs/pair_search.h"

#include <bit>
#include <concepts>
#include <cstdint>
#include <utility>

// The layout is in docs/link-pairs-file.md.
namespace spherule {
namespace {

// As in tree files: a byte above 127 and two kinds of line end show transfers that are not binary.
constexpr std::string_view kMagic = "\x89SLP\r\n\x1a\n";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kChecksumSize = 8;

template <std::unsigned_integral T>
void append(std::string& bytes, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes.push_back(static_cast<char>(value >> (8 * i) & 0xFFU));
  }
}
void append(std::string& bytes, double value) {
  append(bytes, std::bit_cast<std::uint64_t>(value));
}

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

  template <std::unsigned_integral T>
  T take() {
    const std::string_view bytes = take(sizeof(T));
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      value |= static_cast<T>(static_cast<T>(static_cast<unsigned char>(bytes[i])) << (8 * i));
    }
    return value;
  }
  double take_double() { return std::bit_cast<double>(take<std::uint64_t>()); }
  int take_index() { return static_cast<int>(std::bit_cast<std::int32_t>(take<std::uint32_t>())); }
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
  pair.first = reader.take_index();
  pair.second = reader.take_index();
  const auto verdict = reader.take<std::uint8_t>();
  if (verdict > static_cast<std::uint8_t>(PairVerdict::kUnknown)) {
    throw Error(name, "a verdict is unknown");
  }
  pair.verdict = static_cast<PairVerdict>(verdict);
  pair.smallest_gap = reader.take_double();
  pair.searched_boxes = reader.take<std::uint64_t>();
  const auto width = reader.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < width; ++i) pair.witness.push_back(reader.take_double());
  std::vector<FreeBoxes::Variable> variables;
  const auto count = reader.take<std::uint8_t>();
  for (std::uint8_t i = 0; i < count; ++i) {
    FreeBoxes::Variable variable;
    variable.index = reader.take_index();
    variable.wraps = reader.take<std::uint8_t>() != 0;
    variable.lower = reader.take_double();
    variable.upper = reader.take_double();
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
  append(bytes, kVersion);
  append(bytes, static_cast<std::uint32_t>(pairs.link_count()));
  append(bytes, pairs.mechanism());
  append(bytes, pairs.bodies());
  append(bytes, static_cast<std::uint32_t>(pairs.tool_link()));
  append(bytes, static_cast<std::uint32_t>(pairs.pairs().size()));
  for (const LinkPair& pair : pairs.pairs()) {
    append(bytes, static_cast<std::uint32_t>(pair.first));
    append(bytes, static_cast<std::uint32_t>(pair.second));
    append(bytes, static_cast<std::uint8_t>(pair.verdict));
    append(bytes, pair.smallest_gap);
    append(bytes, std::uint64_t{pair.searched_boxes});
    append(bytes, static_cast<std::uint32_t>(pair.witness.size()));
    for (const double value : pair.witness) append(bytes, value);
    append(bytes, static_cast<std::uint8_t>(pair.boxes.variables().size()));
    for (const FreeBoxes::Variable& variable : pair.boxes.variables()) {
      append(bytes, static_cast<std::uint32_t>(variable.index));
      append(bytes, static_cast<std::uint8_t>(variable.wraps ? 1 : 0));
      append(bytes, variable.lower);
      append(bytes, variable.upper);
    }
    append(bytes, static_cast<std::uint32_t>(pair.boxes.nodes().size()));
    bytes += pair.boxes.nodes();
  }
  append(bytes, crc64(bytes));
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
    const int tool_link = reader.take_index();
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
