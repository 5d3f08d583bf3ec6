// SPDX-License-Identifier: BSD-3-Clause
// Loaded before the libraries of a program (LD_PRELOAD), it makes the allocation by operator new of
// the number in SPHERULE_SOAK_ALLOCATION fail as one does for which there is no memory: the new
// handler is called, or std::bad_alloc thrown. Allocations are counted on all threads from where
// the program sets a new handler, which the command does first; what libraries do before is not its
// own. SPHERULE_SOAK_MARK names a file that is made when it came to pass. What C libraries take by
// malloc() does not fail.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fcntl.h>
#include <new>
#include <unistd.h>

namespace {

std::atomic<std::uint64_t> allocations = 0;

std::uint64_t number_that_fails() {
  static const std::uint64_t number = [] {
    const char* const text = std::getenv("SPHERULE_SOAK_ALLOCATION");
    return text == nullptr ? 0 : std::strtoull(text, nullptr, 10);
  }();
  return number;
}

void fail_at_the_number() {
  const std::new_handler handler = std::get_new_handler();
  if (handler == nullptr || ++allocations != number_that_fails()) return;
  if (const char* const mark = std::getenv("SPHERULE_SOAK_MARK")) {
    ::close(::open(mark, O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
  }
  handler();
  throw std::bad_alloc();
}

void* allocate(std::size_t size, std::size_t alignment) {
  fail_at_the_number();
  for (;;) {
    void* memory = nullptr;
    if (alignment == 0) {
      memory = std::malloc(size == 0 ? 1 : size);
    } else if (::posix_memalign(&memory, alignment, size) != 0) {
      memory = nullptr;
    }
    if (memory != nullptr) return memory;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

void* allocate_or_null(std::size_t size, std::size_t alignment) noexcept {
  try {
    return allocate(size, alignment);
  } catch (...) {
    return nullptr;
  }
}

constexpr std::size_t bytes(std::align_val_t alignment) {
  const auto value = static_cast<std::size_t>(alignment);
  return value < sizeof(void*) ? sizeof(void*) : value;
}

}  // namespace

void* operator new(std::size_t size) {
  return allocate(size, 0);
}
void* operator new[](std::size_t size) {
  return allocate(size, 0);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, bytes(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocate(size, bytes(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return allocate_or_null(size, 0);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return allocate_or_null(size, 0);
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return allocate_or_null(size, bytes(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return allocate_or_null(size, bytes(alignment));
}
