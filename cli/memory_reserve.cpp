// SPDX-License-Identifier: BSD-3-Clause
#include "cli/memory_reserve.h"

#include "cli/text/exit_code.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <sys/resource.h>

namespace spherule {
namespace {

constexpr std::size_t kMostReserve = std::size_t{64} << 20U;
constexpr std::size_t kLeastReserve = std::size_t{1} << 16U;
constexpr std::size_t kShareOfLimit = 32;

std::atomic<void*> reserve = nullptr;
std::atomic<bool> memory_ended = false;

[[noreturn]] void give_back_and_throw() {
  memory_ended = true;
  std::free(reserve.exchange(nullptr));
  throw std::bad_alloc();
}

std::terminate_handler terminate_otherwise = nullptr;

bool ends_for_memory() {
  // Of a function whose compiler ends the process where it catches, nothing is caught.
  if (!std::current_exception()) return memory_ended;
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return true;
  } catch (...) {
    return false;
  }
}

// Where memory ends inside a function that must not throw, the exception cannot travel on.
[[noreturn]] void tell_and_end() {
  if (ends_for_memory()) {
    std::fputs("spherule: out of memory\n", stderr);
    std::_Exit(kBadInput);
  }
  terminate_otherwise();
  std::abort();
}

}  // namespace

void keep_memory_reserve() {
  std::size_t size = kMostReserve;
  struct rlimit limit = {};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    size = std::clamp(static_cast<std::size_t>(limit.rlim_cur) / kShareOfLimit, kLeastReserve,
                      kMostReserve);
  }
  void* memory = std::malloc(size);
  while (memory == nullptr && size > kLeastReserve) memory = std::malloc(size /= 2);
  reserve = memory;
  std::set_new_handler(give_back_and_throw);
  terminate_otherwise = std::set_terminate(tell_and_end);
}

}  // namespace spherule
