// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/tree_file.h"

#include "base/bytes.h"
#include "base/crc64.h"
#include "base/error.h"
#include "base/files.h"
#include "base/rounding.h"
#include "spheretree/tree_bytes.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// The format is described in docs/tree-file.md; a change of one needs a change of the other.
namespace spherule {
namespace {

// As in PNG: a byte above 127 and two kinds of line end show transfers that are not binary.
constexpr std::string_view kMagic = "\x89SPT\r\n\x1a\n";
constexpr std::uint32_t kByteOrderMark = 0x01020304;
constexpr std::uint32_t kSwappedByteOrderMark = 0x04030201;
constexpr std::uint32_t kVersion = 1;

constexpr std::size_t kHeaderSize = 32;  // magic, byte-order mark, version, two counts
constexpr std::size_t kNodeSize = 40;    // four doubles, two 32-bit integers
constexpr std::size_t kChecksumSize = 8;

template <class Number>
void append(std::string& bytes, const std::vector<Number>& numbers) {
  for (const Number number : numbers) internal::append_number(bytes, number);
}

// The caller has made sure that the bytes are there.
template <class Number>
Number take(std::string_view& bytes) {
  const auto number = internal::number_at<Number>(bytes.data());
  bytes.remove_prefix(sizeof(Number));
  return number;
}
template <class Number>
void take(std::string_view& bytes, std::size_t count, std::vector<Number>& numbers) {
  numbers.resize(count);
  for (Number& number : numbers) number = take<Number>(bytes);
}

// Puts the sphere of every leaf at the index it names. A sphere that no leaf names, or two leaves
// name, is left to check().
void restore_spheres(SphereTreeData& data, std::size_t sphere_count) {
  data.spheres.resize(sphere_count);
  for (std::size_t node = 0; node < data.radius.size(); ++node) {
    if (data.child_count[node] != 0) continue;
    const auto index = static_cast<std::size_t>(data.first_child[node]);
    if (data.first_child[node] < 0 || index >= sphere_count) continue;
    data.spheres[index] = {{data.x[node], data.y[node], data.z[node]}, data.radius[node]};
  }
}

SphereTreeData read_tree_data(std::string_view file, const std::string& name) {
  std::string_view rest = file;
  if (rest.substr(0, kMagic.size()) != kMagic) {
    throw Error(name, kMagic.starts_with(rest) ? "the file is cut short" : "is not a sphere tree");
  }
  if (rest.size() < kHeaderSize) throw Error(name, "the file is cut short");
  rest.remove_prefix(kMagic.size());
  const auto mark = take<std::uint32_t>(rest);
  if (mark == kSwappedByteOrderMark) throw Error(name, "is in big-endian byte order");
  if (mark != kByteOrderMark) throw Error(name, "the byte-order mark is damaged");
  const auto version = take<std::uint32_t>(rest);
  if (version > kVersion) {
    throw Error(name, "has format version " + std::to_string(version) +
                          "; this program reads versions up to " + std::to_string(kVersion));
  }
  if (version == 0) throw Error(name, "has format version 0, which does not exist");

  // The counts are compared with the size of the file before anything is allocated from them.
  const auto sphere_count = take<std::uint64_t>(rest);
  const auto node_count = take<std::uint64_t>(rest);
  if (rest.size() < kChecksumSize || node_count > (rest.size() - kChecksumSize) / kNodeSize) {
    throw Error(name, "the file is cut short: " + std::to_string(file.size()) + " bytes for " +
                          std::to_string(node_count) + " nodes");
  }
  if (rest.size() != node_count * kNodeSize + kChecksumSize) {
    throw Error(name, "the file is too long: " + std::to_string(file.size()) + " bytes for " +
                          std::to_string(node_count) + " nodes");
  }
  std::string_view checksum = file.substr(file.size() - kChecksumSize);
  if (take<std::uint64_t>(checksum) != crc64(file.substr(0, file.size() - kChecksumSize))) {
    throw Error(name, "the checksum is wrong: the file is damaged");
  }
  if (sphere_count > node_count) {
    throw Error(name, std::to_string(sphere_count) + " spheres cannot be the leaves of " +
                          std::to_string(node_count) + " nodes");
  }

  SphereTreeData data;
  for (auto* array : {&data.x, &data.y, &data.z, &data.radius}) take(rest, node_count, *array);
  for (auto* array : {&data.first_child, &data.child_count}) take(rest, node_count, *array);
  restore_spheres(data, sphere_count);
  return data;
}

}  // namespace

std::string internal::encode_tree(const SphereTree& tree) {
  const SphereTreeData& data = tree.data();
  std::string bytes;
  bytes.reserve(kHeaderSize + kNodeSize * data.radius.size() + kChecksumSize);
  bytes += kMagic;
  internal::append_number(bytes, kByteOrderMark);
  internal::append_number(bytes, kVersion);
  internal::append_number(bytes, std::uint64_t{data.spheres.size()});
  internal::append_number(bytes, std::uint64_t{data.radius.size()});
  for (const auto* array : {&data.x, &data.y, &data.z, &data.radius}) append(bytes, *array);
  for (const auto* array : {&data.first_child, &data.child_count}) append(bytes, *array);
  internal::append_number(bytes, crc64(bytes));
  return bytes;
}

SphereTree internal::decode_tree(std::string_view bytes, const std::string& name) {
  require_rounding_to_nearest();
  SphereTreeData data = read_tree_data(bytes, name);
  try {
    return SphereTree(std::move(data));
  } catch (const Error& error) {
    throw Error(name, error.reason());
  }
}

void save_tree(const SphereTree& tree, const std::filesystem::path& path) {
  write_file_atomically(path, internal::encode_tree(tree));
}

SphereTree load_tree(const std::filesystem::path& path) {
  return internal::decode_tree(read_file(path), path.string());
}

}  // namespace spherule
