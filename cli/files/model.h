// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/options/options.h"
#include "cli/text/json.h"
#include "geometry/triangle_mesh.h"
#include "io/cad/cad_file.h"
#include "io/sphere_file.h"
#include "simplifier/bodies.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace spherule {

// The units in which a model may be written out.
struct UnitArguments {
  std::optional<double> scale;
  std::string units;  // of the output; empty: not given
};

// Adds --scale and --units.
void add_unit_options(CLI::App& command, UnitArguments& arguments, const std::string& scale_help);

// What --units takes.
std::vector<std::string> unit_choices();

// From the numbers of a model to those of the output.
struct ModelUnit {
  double scale = 1.0;                 // output units per unit of the model
  std::optional<double> micrometres;  // of one output unit, where that is known
  std::string origin;                 // how it is known: "stated by the file"
};

// --units is the unit of the output. A model whose file states a unit is converted to it; of
// another it says what its numbers, times --scale, are in. Without it the output is in units of
// the file times --scale. Throws Error for a --scale that is not positive and finite, and one that
// does not lead from the unit that the file states to --units; and as stated_unit().
ModelUnit model_unit(const std::string& file, const UnitArguments& arguments);

// Of the unit of the output; empty where that is not known or has none.
std::string symbol_of(const ModelUnit& unit);

// What lengths on the command line are to be converted to.
LengthContext length_context(const std::string& file, const ModelUnit& unit);

// Tells in `origin` what unit a CAD file states, which is known once it has been read.
void note_cad_unit(const std::string& stated, ModelUnit& unit);

// "unit: millimetre (stated by the file)", a line for a person; nothing if it is not known.
std::string describe(const ModelUnit& unit);

// {"name", "metres", "origin"}, or null.
Json to_json(const ModelUnit& unit);

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

// The bodies of several files, or of an assembly.
struct ModelBodies {
  std::vector<Body> bodies;
  std::vector<std::optional<CadPart>> cad;  // of each; its mesh is moved out
  std::vector<double> scales;               // that each was read with
};

// The units of several files, which all are to come out in the same. Throws Error as model_unit()
// does, and naming two files that would not.
std::vector<ModelUnit> model_units(const std::vector<std::string>& files,
                                   const UnitArguments& arguments);

// Reads a body a file, named as the file without its ending; of CAD files every body of the
// assembly if they are to be `split`, where there are several files after the name of theirs. Warns
// on standard error of bodies whose deviation is not proved. Throws Error, also for a file that is
// named twice.
ModelBodies read_bodies(const std::vector<std::string>& files, const std::vector<ModelUnit>& units,
                        const ModelReadOptions& options, bool split);

// The mesh of a body in its place, also of a copy.
TriangleMesh mesh_of(const ModelBodies& model, std::size_t body);

}  // namespace spherule
