// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/model.h"

#include "base/error.h"
#include "cli/cad/cad_process.h"
#include "cli/text/print.h"
#include "io/mesh_io.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <set>
#include <utility>
#include <variant>

namespace spherule {
namespace {

constexpr double kMicrometresPerMetre = 1e6;

// How the unit of the output is known: `own` is what the file states, `read` what it is read in.
std::string origin_of(const std::string& own, const std::string& read, const char* stated_by,
                      double scale) {
  std::string text = own == read ? std::string("stated by the ") + stated_by
                                 : "the file states " + own + ", read in " + read;
  if (scale == 1.0) return text;
  return (own == read ? own + " " : "") + text + ", times " + number(scale);
}

#ifdef SPHERULE_HAS_CAD
void warn_of_unproved(const std::string& subject, const CadPart& part) {
  if (part.proved) return;
  warn(subject + ": the chord error is measured, not proved, on " +
       std::to_string(part.unproved.size()) + " of " + std::to_string(part.faces) +
       " faces: " + part.unproved.front().name + ": " + part.unproved.front().reason);
}
#endif

[[maybe_unused, noreturn]] void refuse_cad(const std::filesystem::path& path) {
  throw Error(path.string(),
              "is a CAD file, which this build cannot read: install libocct-data-exchange-dev and "
              "build with -DSPHERULE_CAD=ON");
}

CadReadOptions cad_options(const std::filesystem::path& path, const ModelReadOptions& options) {
  if (options.weld > 0.0) throw Error(path.string(), "is a CAD file; only meshes are welded");
  return {.scale = options.scale, .chord_error = options.chord_error};
}

// Whole numbers are numbers, too: a program that writes 1 for 1.0 means the same.
double stored_number(const SphereFile& file, const char* option, double by_default) {
  const auto found = file.options.find(option);
  if (found == file.options.end()) return by_default;
  double number = std::numeric_limits<double>::quiet_NaN();
  if (const auto* whole = std::get_if<std::int64_t>(&found->second)) {
    number = static_cast<double>(*whole);
  } else if (const double* real = std::get_if<double>(&found->second)) {
    number = *real;
  }
  if (!std::isfinite(number)) throw Error(option, "must be a finite number");
  return number;
}

// Names of files without their endings, or as they are given where two would be the same.
std::vector<std::string> names_of(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  bool are_different = true;
  for (const std::string& file : files) {
    names.push_back(std::filesystem::path(file).stem().string());
    are_different = taken.insert(names.back()).second && are_different;
  }
  if (are_different) return names;
  const std::set<std::string> given(files.begin(), files.end());
  if (given.size() == files.size()) return files;
  for (auto it = files.begin(); it != files.end(); ++it) {
    if (std::find(files.begin(), it, *it) != it) throw Error(*it, "is named twice");
  }
  return files;
}

void add_bodies_of(const std::string& file, const std::string& prefix,
                   const ModelReadOptions& options, ModelBodies& result) {
  const std::size_t first = result.bodies.size();
  for (CadBody& body : read_model_bodies(file, options)) {
    Body one{.name = prefix + body.name, .mesh = std::move(body.part.mesh), .copy = body.copy};
    if (one.copy) one.copy->of += first;
    result.bodies.push_back(std::move(one));
    result.cad.emplace_back(body.copy ? std::nullopt : std::optional(std::move(body.part)));
    result.scales.push_back(options.scale);
  }
}

}  // namespace

std::vector<std::string> unit_choices() {
  return {"mm", "cm", "m", "inch"};
}

void add_unit_options(CLI::App& command, UnitArguments& arguments, const std::string& scale_help) {
  command.add_option("--scale", arguments.scale, scale_help);
  command
      .add_option("--units", arguments.units,
                  "The unit of the output and of lengths without one. A file that states its unit "
                  "(3MF, glTF, DAE, STEP, IGES) is converted to it; of another it says what its "
                  "numbers, times --scale, are in")
      ->check(CLI::IsMember(unit_choices()));
}

ModelUnit model_unit(const std::string& file, const UnitArguments& arguments) {
  ModelUnit result;
  if (arguments.scale) {
    result.scale = *arguments.scale;
    if (!(result.scale > 0.0) || !std::isfinite(result.scale)) {
      throw Error("scale", "must be a positive finite number, not " + number(result.scale));
    }
  }
  const LengthUnit* const wanted = arguments.units.empty() ? nullptr : unit_named(arguments.units);
  const std::optional<StatedUnit> stated = stated_unit(file);
  if (!stated) {
    if (wanted == nullptr) return result;
    result.micrometres = wanted->micrometres;
    result.origin = "as --units says";
    if (result.scale != 1.0) result.origin += ", the mesh times " + number(result.scale);
    return result;
  }
  if (wanted == nullptr) {
    result.micrometres = stated->micrometres / result.scale;
  } else {
    result.micrometres = wanted->micrometres;
    const double scale = stated->micrometres / wanted->micrometres;
    constexpr double kRounding = 1e-9;
    if (!arguments.scale) {
      result.scale = scale;
    } else if (!(std::abs(result.scale - scale) <= kRounding * scale)) {
      throw Error("--scale", number(result.scale) + " contradicts --units " + arguments.units +
                                 ": " + file + " is read in units of " +
                                 name_of_size(stated->micrometres) + ", which makes it " +
                                 number(scale) + "; leave out one of the two");
    }
  }
  result.origin =
      origin_of(name_of_size(stated->own_micrometres), name_of_size(stated->micrometres),
                stated->by_format ? "format" : "file", result.scale);
  return result;
}

std::string symbol_of(const ModelUnit& unit) {
  const LengthUnit* const known = unit.micrometres ? unit_of_size(*unit.micrometres) : nullptr;
  return known == nullptr ? "" : known->symbol;
}

LengthContext length_context(const std::string& file, const ModelUnit& unit) {
  return {file, unit.micrometres};
}

void note_cad_unit(const std::string& stated, ModelUnit& unit) {
  if (stated.empty()) return;
  const LengthUnit* const own = unit_named(stated);
  unit.origin =
      origin_of(own == nullptr ? stated : own->name, unit_named("mm")->name, "file", unit.scale);
}

std::string describe(const ModelUnit& unit) {
  if (!unit.micrometres) return {};
  return "unit: " + name_of_size(*unit.micrometres) + " (" + one_line(unit.origin) + ")\n";
}

Json to_json(const ModelUnit& unit) {
  if (!unit.micrometres) return nullptr;
  return {{"name", name_of_size(*unit.micrometres)},
          {"metres", *unit.micrometres / kMicrometresPerMetre},
          {"origin", unit.origin}};
}

ModelFile read_model(const std::filesystem::path& path, const ModelReadOptions& options) {
  ModelFile model;
  if (!is_cad_file(path)) {
    model.mesh = read_mesh(path, {.scale = options.scale, .weld = options.weld});
    return model;
  }
  [[maybe_unused]] const CadReadOptions cad = cad_options(path, options);
#ifdef SPHERULE_HAS_CAD
  model.cad = read_cad_apart(path, cad);
  warn_of_unproved(path.string(), *model.cad);
  model.mesh = std::move(model.cad->mesh);
  return model;
#else
  refuse_cad(path);
#endif
}

std::vector<CadBody> read_model_bodies(const std::filesystem::path& path,
                                       const ModelReadOptions& options) {
  [[maybe_unused]] const CadReadOptions cad = cad_options(path, options);
#ifdef SPHERULE_HAS_CAD
  std::vector<CadBody> bodies = read_cad_bodies_apart(path, cad);
  for (const CadBody& body : bodies) {
    if (!body.copy) warn_of_unproved(path.string() + ": " + body.name, body.part);
  }
  return bodies;
#else
  refuse_cad(path);
#endif
}

void store_reading(const ModelReadOptions& options, const ModelFile& model, SphereFile& file) {
  if (model.cad) file.options["chord-error"] = model.cad->asked;
  if (options.weld > 0.0) file.options["weld"] = options.weld;
  if (!options.units.empty()) file.options["units"] = options.units;
}

ModelReadOptions stored_reading(const SphereFile& file) {
  ModelReadOptions options;
  options.scale = stored_number(file, "scale", options.scale);
  options.chord_error = stored_number(file, "chord-error", options.chord_error);
  options.weld = stored_number(file, "weld", options.weld);
  if (const auto found = file.options.find("units"); found != file.options.end()) {
    const auto* text = std::get_if<std::string>(&found->second);
    if (text == nullptr || unit_named(*text) == nullptr)
      throw Error("units", "is no unit of length");
    options.units = *text;
  }
  if (!(options.scale > 0.0)) throw Error("scale", "must be positive");
  if (options.chord_error < 0.0) throw Error("chord-error", "must not be negative");
  if (options.weld < 0.0) throw Error("weld", "must not be negative");
  return options;
}

std::string describe(const CadPart& part) {
  return concat(
      "CAD part: ", part.faces, " faces, chord error ",
      part.proved ? "proved to be at most " : "measured, not proved: ", part.chord_error,
      " (asked ", part.asked, ", found ", part.reached, "), added to the padding",
      part.free_edges > 0 ? concat("; ", part.free_edges, " edges of no face left out") : "", "\n");
}

Json to_json(const CadPart& part) {
  Json unproved = Json::array();
  for (const UnprovedFace& face : part.unproved) {
    unproved.push_back({{"face", face.name}, {"reason", face.reason}});
  }
  return {{"faces", part.faces},
          {"free_edges", part.free_edges},
          {"chord_error", part.chord_error},
          {"chord_error_asked", part.asked},
          {"chord_error_found", part.reached},
          {"tolerance", part.tolerance},
          {"stated_unit", part.stated_unit},
          {"proved", part.proved},
          {"unproved_faces", unproved}};
}

std::vector<ModelUnit> model_units(const std::vector<std::string>& files,
                                   const UnitArguments& arguments) {
  std::vector<ModelUnit> units;
  for (const std::string& file : files) {
    units.push_back(model_unit(file, arguments));
    const std::optional<double>& first = units.front().micrometres;
    const std::optional<double>& next = units.back().micrometres;
    if (first == next) continue;
    const auto state = [](const std::optional<double>& unit) {
      return unit ? "is read in " + name_of_size(*unit) : std::string("states no unit");
    };
    throw Error(file, state(next) + ", but " + files.front() + " " + state(first) +
                          ": say in which unit all are to come out, --units mm for instance");
  }
  return units;
}

ModelBodies read_bodies(const std::vector<std::string>& files, const std::vector<ModelUnit>& units,
                        const ModelReadOptions& options, bool split) {
  const std::vector<std::string> names = names_of(files);
  ModelBodies result;
  for (std::size_t i = 0; i < files.size(); ++i) {
    ModelReadOptions own = options;
    own.scale = units[i].scale;
    if (is_cad_file(files[i]) && files.size() > 1) own.weld = 0.0;  // it is for the others
    if (split && is_cad_file(files[i])) {
      add_bodies_of(files[i], files.size() > 1 ? names[i] + "/" : "", own, result);
      continue;
    }
    ModelFile model = read_model(files[i], own);
    result.bodies.push_back({.name = names[i], .mesh = std::move(model.mesh)});
    result.cad.push_back(std::move(model.cad));
    result.scales.push_back(own.scale);
  }
  return result;
}

TriangleMesh mesh_of(const ModelBodies& model, std::size_t body) {
  const std::optional<BodyCopy>& copy = model.bodies[body].copy;
  if (!copy) return model.bodies[body].mesh;
  TriangleMesh mesh = model.bodies[copy->of].mesh;
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = copy->pose * vertex;
  return mesh;
}

}  // namespace spherule
