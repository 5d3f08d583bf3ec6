// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/text/json.h"
#include "geometry/triangle_mesh.h"
#include "io/cad/cad_file.h"
#include "io/sphere_file.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace spherule {

// A mesh from a mesh file or from the faces of a CAD file, with what is known of the latter (its
// own mesh is moved out).
struct ModelFile {
  TriangleMesh mesh;
  std::optional<CadPart> cad;
};

struct ModelReadOptions {
  double scale = 1.0;
  std::string units = {};    // symbol of the unit of the output, where the user named it
  double chord_error = 0.0;  // CAD files only; 0: the default
  double weld = 0.0;         // mesh files only: as MeshReadOptions has it
};

// Reads either kind. Warns on standard error of faces whose deviation is not proved. Throws Error,
// also for a CAD file in a build that reads none, or one that is to be welded.
ModelFile read_model(const std::filesystem::path& path, const ModelReadOptions& options = {});

// The bodies of a CAD file. As above.
std::vector<CadBody> read_model_bodies(const std::filesystem::path& path,
                                       const ModelReadOptions& options);

// Stores in a file of spheres what it takes to read their model in the same way again.
void store_reading(const ModelReadOptions& options, const ModelFile& model, SphereFile& file);

// How the model of a file of spheres was read, as its options say; as by default where they do not.
// Throws Error, naming the option, for one that is no number, a scale that is not above zero, a
// length below zero and a unit that is not known.
ModelReadOptions stored_reading(const SphereFile& file);

// What a CAD file came to, in a line for a person.
std::string describe(const CadPart& part);

Json to_json(const CadPart& part);

}  // namespace spherule
