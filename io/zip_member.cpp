// SPDX-License-Identifier: BSD-3-Clause
#include "io/zip_member.h"

#include "base/error.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <optional>
#include <zlib.h>

namespace spherule::internal {
namespace {

// Layout and values of the ZIP application note (APPNOTE 6.3).
constexpr std::string_view kLocalMark("PK\3\4"), kEntryMark("PK\1\2"), kEndMark("PK\5\6"),
    kEnd64Mark("PK\6\6"), kLocator64Mark("PK\6\7");
constexpr std::size_t kLocalSize = 30, kEntrySize = 46, kEndSize = 22, kEnd64Size = 56,
                      kLocator64Size = 20, kMaxCommentSize = 0xFFFF;
constexpr std::uint64_t kIn64 = 0xFFFFFFFF;  // in a field of 32 bits: see the ZIP64 record
constexpr std::uint64_t kStored = 0, kDeflated = 8;
// Deflate cannot do better than 258 bytes for two bits.
constexpr std::uint64_t kMaxRatio = 1032;

struct Entry {
  std::uint64_t flags = 0, method = 0, checksum = 0, packed = 0, size = 0, offset = 0;
};

bool same_name(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  });
}

class Archive {
 public:
  Archive(std::string_view bytes, const std::string& subject) : bytes_(bytes), subject_(subject) {}

  Entry find(std::string_view name) const {
    std::optional<Entry> found;
    const auto [begin, count] = directory();
    std::uint64_t at = begin;
    for (std::uint64_t i = 0; i < count; ++i) {
      if (part(at, kEntrySize).substr(0, 4) != kEntryMark) fail("its directory is damaged");
      const std::uint64_t name_size = field(at + 28, 2), extra_size = field(at + 30, 2);
      const std::uint64_t extra_at = at + kEntrySize + name_size;
      if (same_name(part(at + kEntrySize, name_size), name)) {
        if (found) fail("it holds " + std::string(name) + " twice");
        found = entry(at, extra_at, extra_at + extra_size);
      }
      at = extra_at + extra_size + field(at + 32, 2);
    }
    if (!found) fail("it holds no " + std::string(name));
    return *found;
  }

  std::string content(const Entry& entry) const {
    if (entry.flags & 1) fail("it is encrypted");
    if (part(entry.offset, kLocalSize).substr(0, 4) != kLocalMark) fail("it is damaged");
    const std::uint64_t skipped = field(entry.offset + 26, 2) + field(entry.offset + 28, 2);
    const std::string_view packed = part(entry.offset + kLocalSize + skipped, entry.packed);
    if (entry.size > kMaxMemberSize || entry.packed > kMaxMemberSize) {
      fail("a part of it is larger than 2^29 bytes");
    }
    std::string result;
    if (entry.method == kStored) {
      result = packed;
    } else if (entry.method == kDeflated) {
      result = inflated(packed, entry.size);
    } else {
      fail("it is packed by method " + std::to_string(entry.method) + ", not by deflate");
    }
    if (result.size() != entry.size || crc_of(result) != entry.checksum) {
      fail("it is damaged: a checksum or a size is wrong");
    }
    return result;
  }

 private:
  struct Directory {
    std::uint64_t begin, count;
  };

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(subject_, "not a readable ZIP archive: " + reason);
  }

  std::string_view part(std::uint64_t at, std::uint64_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) fail("it is cut short or damaged");
    return bytes_.substr(static_cast<std::size_t>(at), static_cast<std::size_t>(size));
  }

  // A little-endian number.
  std::uint64_t field(std::uint64_t at, std::size_t size) const {
    std::uint64_t value = 0;
    const std::string_view image = part(at, size);
    for (std::size_t i = size; i-- > 0;) {
      value = value << 8 | static_cast<unsigned char>(image[i]);
    }
    return value;
  }

  // By the end record, which only a comment may follow.
  Directory directory() const {
    const std::size_t tail = bytes_.size() - std::min(bytes_.size(), kEndSize + kMaxCommentSize);
    for (std::size_t at = bytes_.rfind(kEndMark); at != std::string_view::npos && at >= tail;
         at = at == 0 ? std::string_view::npos : bytes_.rfind(kEndMark, at - 1)) {
      if (bytes_.size() - at < kEndSize || at + kEndSize + field(at + 20, 2) != bytes_.size()) {
        continue;
      }
      if (at >= kLocator64Size && bytes_.substr(at - kLocator64Size, 4) == kLocator64Mark) {
        const std::uint64_t end = field(at - kLocator64Size + 8, 8);
        if (part(end, kEnd64Size).substr(0, 4) != kEnd64Mark) fail("its directory is damaged");
        return {field(end + 48, 8), field(end + 32, 8)};
      }
      return {field(at + 16, 4), field(at + 10, 2)};
    }
    fail("it has no end record");
  }

  Entry entry(std::uint64_t at, std::uint64_t extra, std::uint64_t extra_end) const {
    Entry result{field(at + 8, 2),  field(at + 10, 2), field(at + 16, 4),
                 field(at + 20, 4), field(at + 24, 4), field(at + 42, 4)};
    // The ZIP64 record among the extra fields holds those numbers, in this order, that did not fit.
    constexpr std::uint64_t kZip64 = 1;
    while (extra + 4 <= extra_end && field(extra, 2) != kZip64) extra += 4 + field(extra + 2, 2);
    extra += 4;
    for (std::uint64_t* number : {&result.size, &result.packed, &result.offset}) {
      if (*number != kIn64) continue;
      if (extra + 8 > extra_end) fail("its directory is damaged");
      *number = field(extra, 8);
      extra += 8;
    }
    return result;
  }

  std::string inflated(std::string_view packed, std::uint64_t size) const {
    if (size / kMaxRatio > packed.size()) fail("it is damaged: a size is wrong");
    // One byte more than declared, so that a longer content shows.
    std::string result(static_cast<std::size_t>(size) + 1, '\0');
    z_stream stream{};
    constexpr int kRawDeflate = -15;
    if (inflateInit2(&stream, kRawDeflate) != Z_OK) fail("there is not enough memory");
    // zlib takes its input as not constant, and does not change it.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = static_cast<uInt>(result.size());
    stream.avail_in = static_cast<uInt>(packed.size());
    const int outcome = inflate(&stream, Z_FINISH);
    result.resize(stream.total_out);
    inflateEnd(&stream);
    if (outcome != Z_STREAM_END) fail("it is damaged: a part cannot be unpacked");
    return result;
  }

  static std::uint64_t crc_of(const std::string& bytes) {
    return ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  }

  std::string_view bytes_;
  const std::string& subject_;
};

}  // namespace

std::string read_zip_member(std::string_view archive, std::string_view name,
                            const std::string& subject) {
  const Archive opened(archive, subject);
  return opened.content(opened.find(name));
}

}  // namespace spherule::internal
