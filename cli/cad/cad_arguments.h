// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace spherule {

// The command line of the program that reads CAD files: which function to run ("part", "bodies"),
// the file, scale, chord error and angle, and how many seconds of processor time it may take at
// most. Its answer (cad_message.h) goes to the descriptor.
inline constexpr int kCadArguments = 7;  // with the name of the program
inline constexpr int kCadAnswer = 3;

}  // namespace spherule
