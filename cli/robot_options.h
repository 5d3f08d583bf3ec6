// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/robot/robot_spheres.h"
#include "collide/robot/urdf.h"

#include <map>
#include <string>
#include <vector>

namespace spherule {

// The packages of texts NAME=DIR. Throws Error for other texts and a name given twice.
UrdfOptions urdf_options(const std::vector<std::string>& packages);

// What --geometry takes, the default first, and what it names. Error for another name.
std::vector<std::string> geometry_names();
LinkGeometry geometry_named(const std::string& name);

// The options of links from texts NAME:max-error=E,min-external=D,padding=T,zones=FILE, of which
// any may be left out; E, D and T in metres, FILE as `fit --zones` reads it. Several texts for one
// link add up. Throws Error for a text that is not of this form, a value that is no number, one
// given twice, and as read_zones().
std::map<std::string, LinkCoverOptions> link_options(const std::vector<std::string>& texts);

}  // namespace spherule
