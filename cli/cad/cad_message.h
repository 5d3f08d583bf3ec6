// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/cad/cad_file.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {

// What the program that reads CAD files (cad_reader.cpp) sends to the command (cad_process.h), as
// CBOR: the bodies that were read, every number exactly, or the error that ended the reading.

std::string packed(std::span<const CadBody> bodies);
std::string packed_error(const std::string& subject, const std::string& reason);

// The bodies. Throws the Error that was sent; std::exception if the message is not whole.
std::vector<CadBody> unpacked(std::string_view message);

}  // namespace spherule
