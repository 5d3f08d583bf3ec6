// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/cli/command_test_support.h"

#include <string>

namespace spherule {

// A URDF: a tool that slides beside a block, from `lower` to 0.5, and turns. The two are 0.02 m
// apart where the slide stands at zero, so that they never touch if it does not go below -0.02.
inline std::string gantry(const std::string& lower) {
  return R"(<?xml version="1.0"?>
<robot name="gantry">
  <link name="block"><collision><geometry><box size="0.3 0.3 0.3"/></geometry></collision></link>
  <link name="carriage"/>
  <link name="tool"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><parent link="block"/><child link="carriage"/>
    <origin xyz="0.22 0 0"/><axis xyz="1 0 0"/>
    <limit lower=")" +
         lower + R"(" upper="0.5" effort="1" velocity="1"/></joint>
  <joint name="turn" type="revolute"><parent link="carriage"/><child link="tool"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
)";
}

}  // namespace spherule
