// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The checksum of the library's binary files.

#include <cstdint>
#include <string_view>

namespace spherule {

// CRC-64/XZ (polynomial 0x42F0E1EBA9EA3693 of ECMA-182, reflected, initial value and final
// exclusive-or all ones; check value of "123456789": 0x995DC9BBDF1939FA). Chosen over a hash such
// as FNV-1a because it is certain to notice every burst of damage up to 64 bits long.
std::uint64_t crc64(std::string_view bytes);

}  // namespace spherule
