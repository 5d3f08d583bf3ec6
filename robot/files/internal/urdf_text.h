// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/files/internal/xml_file.h"

#include <cstddef>
#include <string>
#include <vector>

namespace spherule::internal {

// What a URDF file says of a robot's joints and shapes, checked and written anew in the plainest
// way, for urdfdom to read.
//
// urdfdom 3.0.1 drops all shapes of a link with an incomplete inertia and says so on the console
// only; takes the first of two origins or shapes, or the last of two joints above
// a link; never frees a ring of links; passes what it quotes from a file to a function
// of the printf family as the format; and reads beyond the text's end after a broken UTF-8
// sequence. So it is given nothing but what is used, with numbers that are known to be numbers.
struct UrdfText {
  std::string text;
  std::vector<std::string> joints;  // their names, in the order of the file
  std::size_t shapes = 0;
};

// Throws Error as read_urdf() says, for what can be seen in one place of the file.
UrdfText plain_urdf(const XmlElement& robot);

}  // namespace spherule::internal
