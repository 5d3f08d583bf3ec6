// SPDX-License-Identifier: BSD-3-Clause
// Loaded before the libraries of a program (LD_PRELOAD), it lets the allocation by operator new of
// the number in SPHERULE_FAILING_ALLOCATION fail. Allocations are counted on all threads.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

void* operator new(std::size_t size) {
  static std::atomic<std::uint64_t> allocations = 0;
  static const std::uint64_t failing = [] {
    const char* const text = std::getenv("SPHERULE_FAILING_ALLOCATION");
    return text == nullptr ? 0 : std::strtoull(text, nullptr, 10);
  }();
  if (++allocations == failing) throw std::bad_alloc();
  if (void* const memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
