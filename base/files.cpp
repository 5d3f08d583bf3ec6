// SPDX-License-Identifier: BSD-3-Clause
#include "base/files.h"

#include "base/error.h"

#include <climits>

#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <mutex>
#include <optional>
#include <spawn.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <vector>

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

  // Reports the errors that some file systems keep back until the file is closed. It stays open,
  // and locked.
  bool close_another() const {
    const int another = ::fcntl(value_, F_DUPFD_CLOEXEC, 0);
    return another >= 0 && ::close(another) == 0;
  }

 private:
  int value_;
};

// The permissions that a newly created file gets. The mask can only be read by setting it, by one
// thread at a time: another would take the one that is set meanwhile for the usual one, and leave
// it. Files that others make in between get stricter permissions, not looser ones.
mode_t default_permissions() {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
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

// What a path names: the file that is to be replaced, or the place of a new one.
struct Target {
  fs::path path;
  bool exists = false;
};

Target target_of(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(path.string(), "exists and is not a regular file");
  }
  Target target{.path = {}, .exists = fs::exists(status)};
  target.path = target.exists ? fs::canonical(path, error) : followed(path);
  if (target.exists && error) throw Error(path.string(), "cannot be resolved: " + error.message());
  if (!target.path.has_filename()) throw Error(path.string(), "names no file");
  if (target.path.filename().string().size() > NAME_MAX) {
    throw Error(path.string(), "cannot be written: the name is too long");
  }
  return target;
}

// How the names of the temporary files begin that become `target`; six characters follow. Of a name
// of the greatest length the end is left out.
constexpr std::size_t kRandomCharacters = 6;
std::string temporary_prefix(const fs::path& target) {
  const std::string mark = ".spherule-";
  const std::size_t most = NAME_MAX - 1 - mark.size() - kRandomCharacters;
  return std::string(".").append(target.filename().string(), 0, most).append(mark);
}

// Removes what killed processes left: temporary files that nobody has locked.
void remove_leftovers(const fs::path& target) {
  const std::string prefix = temporary_prefix(target);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.size() != prefix.size() + kRandomCharacters || !name.starts_with(prefix)) continue;
    const Descriptor file(
        ::open(entry.path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (file.get() >= 0 && ::flock(file.get(), LOCK_EX | LOCK_NB) == 0) {
      ::unlink(entry.path().c_str());
    }
  }
}

// A new, locked file beside `target`, removed unless it is renamed.
class TemporaryFile {
 public:
  // Errors name `path`, which led to the target.
  TemporaryFile(const fs::path& target, const fs::path& path) {
    remove_leftovers(target);
    const std::string name = temporary_prefix(target) + std::string(kRandomCharacters, 'X');
    for (;;) {
      name_ = (target.parent_path() / name).string();
      file_.emplace(::mkstemp(name_.data()));
      if (file_->get() < 0) fail(path, "cannot be written");
      // Between the two calls another process may have taken it for left behind, and removed it. A
      // file system without locks has none of that.
      struct stat status = {};
      if (::flock(file_->get(), LOCK_EX) != 0 || ::fstat(file_->get(), &status) != 0 ||
          status.st_nlink > 0) {
        return;
      }
    }
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!renamed_) ::unlink(name_.c_str());
  }

  const Descriptor& file() const { return *file_; }

  bool rename_to(const fs::path& target) {
    renamed_ = std::rename(name_.c_str(), target.c_str()) == 0;
    return renamed_;
  }

 private:
  std::string name_;
  std::optional<Descriptor> file_;
  bool renamed_ = false;
};

}  // namespace

fs::path written_file(const fs::path& path) {
  return target_of(absolute_path(path)).path;
}

void check_writable(const fs::path& path) {
  const Target target = target_of(path);
  const TemporaryFile temporary(target.path, path);
}

// No file is lost (G8): until the new one is whole and on the disk, `path` is what it was.
void write_file_atomically(const fs::path& path, std::string_view bytes) {
  const Target target = target_of(path);
  TemporaryFile temporary(target.path, path);
  const Descriptor& file = temporary.file();
  struct stat old = {};
  const bool keep = target.exists && ::stat(target.path.c_str(), &old) == 0;
  if (::fchmod(file.get(), keep ? old.st_mode & 07777U : default_permissions()) != 0) {
    fail(path, "cannot be written");
  }
  for (std::string_view rest = bytes; !rest.empty();) {
    const ssize_t written = ::write(file.get(), rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path, "cannot be written");
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::fsync(file.get()) != 0 || !file.close_another()) fail(path, "cannot be written");
  // While it is still locked: for others it would be left behind.
  if (!temporary.rename_to(target.path)) fail(path, "cannot be written");
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

void require_regular_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(path.string(), "is not a regular file");
  }
}

fs::path absolute_path(const fs::path& path) {
  std::error_code error;
  fs::path absolute = fs::absolute(path, error);
  if (error) throw Error(path.string(), "no working directory: " + error.message());
  return absolute;
}

}  // namespace spherule

namespace spherule::internal {
namespace {

// A pipe whose ends other programs that are started meanwhile do not have, at once where the system
// can make it so.
bool make_pipe(std::array<int, 2>& ends) {
#ifdef __linux__
  return ::pipe2(ends.data(), O_CLOEXEC) == 0;
#else
  if (::pipe(ends.data()) != 0) return false;
  for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  return true;
#endif
}

// Both ends are closed with it.
class Pipe {
 public:
  explicit Pipe(const std::string& program) {
    if (!make_pipe(ends_)) {
      throw Error(program, std::string("cannot be run: ") + std::strerror(errno));
    }
  }
  ~Pipe() {
    ::close(ends_[0]);
    close_writing();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int writing() const { return ends_[1]; }
  void close_writing() {
    if (ends_[1] >= 0) ::close(ends_[1]);
    ends_[1] = -1;
  }

  std::string read_all() const {
    std::string bytes;
    std::vector<char> part(std::size_t{1} << 16U);
    for (;;) {
      const ssize_t count = ::read(ends_[0], part.data(), part.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return bytes;
      bytes.append(part.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

// A program that runs. It is ended with this object, unless that waited for its end.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    if (is_waited_for_) return;
    ::kill(id_, SIGKILL);
    int status = 0;
    wait_for_end(status);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // How it ended, as waitpid() says; false if that is not known.
  bool wait_for_end(int& status) {
    pid_t found = 0;
    do {
      found = ::waitpid(id_, &status, 0);
    } while (found < 0 && errno == EINTR);
    is_waited_for_ = true;
    return found == id_;
  }

 private:
  pid_t id_;
  bool is_waited_for_ = false;
};

}  // namespace

ProgramOutput run_program(const std::string& program, std::span<const std::string> arguments,
                          int descriptor) {
  // posix_spawn() takes them as C does, and writes to none of them.
  std::vector<char*> pointers{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) {
    pointers.push_back(const_cast<char*>(argument.c_str()));
  }
  pointers.push_back(nullptr);
  Pipe pipe(program);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  // In this order, as the pipe may be standard output where that was closed. Where it is the
  // descriptor already, posix_spawn() keeps it open.
  ::posix_spawn_file_actions_adddup2(&actions, pipe.writing(), descriptor);
  if (descriptor != STDOUT_FILENO) {
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  }
  pid_t id = 0;
  const int error =
      ::posix_spawnp(&id, program.c_str(), &actions, nullptr, pointers.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ProgramOutput result;
  if (error != 0) {
    result.not_started = std::strerror(error);
    return result;
  }
  Child child(id);
  pipe.close_writing();
  result.bytes = pipe.read_all();
  if (!child.wait_for_end(result.status)) throw Error(program, "it is not known how it ended");
  return result;
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::string read_regular_file(const std::filesystem::path& path) {
  const std::string subject = path.string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) throw Error(subject, "no such file");
  if (error) throw Error(subject, error.message());
  if (std::filesystem::is_directory(status)) throw Error(subject, "is a directory");
  require_regular_file(path);
  std::string bytes = read_file(path);
  if (bytes.empty()) throw Error(subject, "the file is empty");
  return bytes;
}

}  // namespace spherule::internal
