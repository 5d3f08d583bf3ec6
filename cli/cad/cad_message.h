// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/cad/cad_file.h"

#include <cstdint>
#include <span>
#include <vector>

namespace spherule {

// What the program that reads CAD files (cad_reader.cpp) sends to the command (cad_process.h), as
// CBOR: the bodies that were read, every number exactly, or the error that ended the reading.

std::vector<std::uint8_t> packed(std::span<const CadBody> bodies);
std::vector<std::uint8_t> packed_error(const std::string& subject, const std::string& reason);

// The bodies. Throws the Error that was sent; std::runtime_error if the message is not whole.
std::vector<CadBody> unpacked(std::span<const std::uint8_t> message);

}  // namespace spherule
