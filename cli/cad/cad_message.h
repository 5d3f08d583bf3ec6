// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/cad/cad_file.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {

// The command line of the program that reads CAD files (cad_reader.cpp): which function to run
// ("part", "bodies"), the file, scale, chord error and angle, and how many seconds of processor
// time it may take at most.
inline constexpr int kCadArguments = 7;  // with the name of the program

// The descriptor to which it sends its answer to the command (cad_process.h), as CBOR: the bodies
// that were read, every number exactly, or the error that ended the reading.
inline constexpr int kCadAnswer = 3;

std::string packed(std::span<const CadBody> bodies);
std::string packed_error(const std::string& subject, const std::string& reason);

// The bodies. Throws the Error that was sent; std::exception if the message is not whole.
std::vector<CadBody> unpacked(std::string_view message);

}  // namespace spherule
