// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/model_file.h"

#include "base/error.h"
#include "cli/cad/cad_process.h"
#include "cli/text/message.h"
#include "io/length_unit.h"
#include "io/mesh_io.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <utility>
#include <variant>

namespace spherule {
namespace {

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

}  // namespace

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
  std::ostringstream text;
  text << "CAD part: " << part.faces << " faces, chord error "
       << (part.proved ? "proved to be at most " : "measured, not proved: ") << part.chord_error
       << " (asked " << part.asked << ", found " << part.reached << "), added to the padding";
  if (part.free_edges > 0) text << "; " << part.free_edges << " edges of no face left out";
  text << "\n";
  return text.str();
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

}  // namespace spherule
