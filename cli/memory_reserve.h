// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace spherule {

// Keeps some memory aside until the process runs out of it: then it is given back before
// std::bad_alloc is thrown, so that what destructors allocate while the exception travels is there
// (those of JSON documents do, and the process would end without a message). Some 64 MB of address
// space that is never touched, or 1/32 of the limit of address space if that is less. Where the
// exception meets a function that must not throw (those of CLI11 and of the
// standard library that allocate, destructors), the
// process ends at once with the message "out of memory" and the exit code of bad input. To be
// called once.
void keep_memory_reserve();

}  // namespace spherule
