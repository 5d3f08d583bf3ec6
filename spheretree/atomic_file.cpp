// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/atomic_file.h"

#include "spheretree/error.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace spherule {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
  throw Error(path.string(), what + ": " + std::generic_category().message(errno));
}

class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }

  int get() const { return value_; }

  // Reports the errors that some file systems keep back until the file is closed.
  bool close() {
    const int value = value_;
    value_ = -1;
    return ::close(value) == 0;
  }

 private:
  int value_;
};

// Removes the file unless it was renamed.
struct Temporary {
  std::string name;

  ~Temporary() {
    if (!name.empty()) ::unlink(name.c_str());
  }
};

// The permissions that a newly created file gets. The mask can only be read by setting it; files
// made by other threads in between would get stricter permissions, not looser ones.
mode_t default_permissions() {
  const mode_t mask = ::umask(077);
  ::umask(mask);
  return 0666 & ~mask;
}

// Where a path that names no file yet leads, its last part followed as far as it is a symbolic
// link.
fs::path followed(const fs::path& path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  fs::path target = path;
  std::error_code error;
  for (int links = 0; fs::is_symlink(fs::symlink_status(target, error)); ++links) {
    if (links == kMostLinks) throw Error(path.string(), "cannot be resolved: too many links");
    target = target.parent_path() / fs::read_symlink(target, error);
    if (error) throw Error(path.string(), "cannot be resolved: " + error.message());
  }
  return target;
}

}  // namespace

void write_file_atomically(const fs::path& path, std::string_view bytes) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(path.string(), "exists and is not a regular file");
  }
  const bool replaces = fs::exists(status);
  const fs::path target = replaces ? fs::canonical(path, error) : followed(path);
  if (replaces && error) throw Error(path.string(), "cannot be resolved: " + error.message());
  if (!target.has_filename()) throw Error(path.string(), "names no file");

  const std::string pattern = std::string(".").append(target.filename().string()).append(".XXXXXX");
  std::string name = (target.parent_path() / pattern).string();
  Descriptor file(::mkstemp(name.data()));
  if (file.get() < 0) fail(path, "cannot be written");
  Temporary temporary{name};

  struct stat old = {};
  const bool keep = replaces && ::stat(target.c_str(), &old) == 0;
  if (::fchmod(file.get(), keep ? old.st_mode & 07777U : default_permissions()) != 0) {
    fail(path, "cannot be written");
  }
  for (std::string_view rest = bytes; !rest.empty();) {
    const ssize_t written = ::write(file.get(), rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path, "cannot be written");
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::fsync(file.get()) != 0 || !file.close()) fail(path, "cannot be written");
  if (std::rename(name.c_str(), target.c_str()) != 0) fail(path, "cannot be written");
  temporary.name.clear();
}

std::string read_file(const fs::path& path) {
  // Without O_NONBLOCK: a named pipe is waited for.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) fail(path, "cannot be read");
  struct stat status = {};
  if (::fstat(file.get(), &status) != 0) fail(path, "cannot be read");
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode)) {
    throw Error(path.string(), "is not a regular file");
  }
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(status.st_size));
  std::array<char, 65536> buffer;
  for (;;) {
    const ssize_t count = ::read(file.get(), buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, "cannot be read");
    if (count == 0) return bytes;
    bytes.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace spherule
