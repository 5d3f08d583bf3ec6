// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/json.h"
#include "cli/pages/view_page.h"
#include "cli/text/json.h"
#include "geometry/sphere.h"

#include <filesystem>
#include <string>
#include <vector>

namespace spherule {

// What an item of the leaks of a file is called.
std::string leaks_name(const std::filesystem::path& file);

// "covered (proved)", or between which bounds the deepest leak is; of a certificate as JSON.
std::string describe_cover(const Json& certificate);

// The leaks that a certificate as JSON tells of, the deepest first: its deepest, and those that
// `audit --json` lists. Throws Error, naming `file`, for values of a wrong type.
std::vector<LeakPoint> leaks_of(const Json& certificate, const std::string& file);

// A list of {"center", "radius"}. Throws as above, and for spheres that are not usable.
std::vector<Sphere> spheres_of(const Json& list, const std::string& file);

// The JSON in a file whose name ends with .json; null for other files. Throws Error, naming the
// file, for what internal::parse_json() refuses.
internal::JsonDocument<Json> json_in(const std::filesystem::path& file);

// What a file holds that is of no robot: a mesh, SPHERES.json, a tree, the report of a fit
// (external spheres, levels, the leak), or what `audit --json` printed. Throws Error, naming the
// file. With `units`, the symbol of a unit, meshes whose files state theirs and spheres whose
// options say it are shown in it.
std::vector<ViewItem> view_items(const std::string& file, const std::string& units = "");

// The leaks of every item of spheres, searched for on the surfaces of the meshes among the items,
// as items of their own, and hides nothing. Parts are compared with parts of the same link.
std::vector<ViewItem> sampled_leaks(const std::vector<ViewItem>& items);

// Gives the leaks that certificates tell of, in their order, to the sets of spheres among the items
// where there are as many of both, and adds the surfaces of these leaks, of meshes that are there.
void place_leaks(std::vector<ViewItem>& items);

}  // namespace spherule
