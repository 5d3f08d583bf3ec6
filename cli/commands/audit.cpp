// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "cli/commands/command.h"
#include "cli/files/in_file.h"
#include "cli/files/interruption.h"
#include "cli/files/model_file.h"
#include "cli/files/model_unit.h"
#include "cli/files/output.h"
#include "cli/files/result_warnings.h"
#include "cli/files/unit_warnings.h"
#include "cli/help/command_specification.h"
#include "cli/help/help.h"
#include "cli/options/threads_option.h"
#include "cli/parts/audit_bodies.h"
#include "cli/parts/audit_proof.h"
#include "cli/text/exit_code.h"
#include "cli/text/json.h"
#include "cli/text/message.h"
#include "cli/text/next_step.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "geometry/mesh_report.h"
#include "io/sphere_file.h"
#include "simplifier/leaks.h"
#include "simplifier/repair.h"
#include "simplifier/simplify.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

std::string name_of(const std::optional<ExternalSpheres>& external) {
  if (!external) return "the mesh and its inside";
  std::ostringstream solid;
  solid << "the simplified solid (D " << external->min_external_diameter << ")";
  return solid.str();
}

Json json_of(const Certificate& certificate, const std::optional<ExternalSpheres>& external) {
  Json json = to_json(certificate);
  json["against"] = external ? "simplified solid" : "mesh and its inside";
  if (external) {
    json["min_external_diameter"] = to_json(external->min_external_diameter);
    json["padding"] = to_json(external->padding);
    json["external_sphere_count"] = external->spheres.size();
  }
  return json;
}

struct Repaired {
  SphereFile file;
  Repair repair;
  Certificate certificate;
  std::vector<std::string> warnings = {};
};

Repaired repaired(const AuditArguments& arguments, const ModelFile& model,
                  const ModelReadOptions& reading, const SphereFile& file,
                  const SimplifyOptions& options, const CertifyOptions& certify_options) {
  Repaired result;
  // E as the spheres were fitted, if the file says so.
  const double max_error = file.options.contains("max-error") ? options.max_error : 0.0;
  result.repair = repair(model.mesh, *certify_options.external, file.spheres,
                         {.max_error = arguments.max_error.value_or(max_error),
                          .zones = options.zones,
                          .seed = options.seed,
                          .effort = std::min(options.effort, SimplifyOptions{}.effort),
                          .threads = options.threads,
                          .progress = options.progress});
  result.certificate = certify(model.mesh, result.repair.spheres, certify_options);
  result.file = {.spheres = result.repair.spheres,
                 .certificate = record(result.certificate),
                 .options = option_record(options, reading.scale),
                 .interrupted = file.interrupted};
  store_reading(reading, model, result.file);
  result.file.options["repair-max-error"] = result.repair.max_error;
  return result;
}

// Where to look: for showing, beside the deepest leak, which is proved.
Json json_of(std::span<const LeakPoint> leaks) {
  Json list = Json::array();
  for (const LeakPoint& leak : leaks) {
    list.push_back({{"point", to_json(leak.point)}, {"depth", to_json(leak.depth)}});
  }
  return list;
}

// --max-error is not among the options to repeat: it comes with --repair only.
std::vector<NextStep> steps_after_leak(const AuditArguments& arguments, double scale) {
  std::vector<std::string> mend = {"audit", arguments.models.front(), arguments.spheres};
  repeat("--scale", arguments.unit.scale, mend);
  repeat("--units", arguments.unit.units, mend);
  repeat("--min-external", arguments.min_external, mend);
  repeat("--repair", here(arguments.spheres, ".mended.json"), mend);
  std::vector<NextStep> steps = {{std::move(mend), "make them cover"}};
  // `view` has no scale: its page would mix units.
  if (scale == 1.0) {
    steps.push_back({{"view", arguments.models.front(), arguments.spheres, "--leaks", "-o",
                      here(arguments.spheres, ".html")},
                     "see where they leak"});
  }
  return steps;
}

void print(const AuditArguments& arguments, const TriangleMesh& mesh, const SphereFile& file,
           double scale, const Certificate& certificate,
           const std::optional<ExternalSpheres>& external, const std::optional<Repaired>& mended) {
  if (arguments.json) {
    Json json = json_of(certificate, external);
    if (!certificate.covered) json["leaks"] = json_of(leak_points(mesh, file.spheres));
    if (mended) {
      json["repair"] = {{"file", arguments.repaired},
                        {"max_error", to_json(mended->repair.max_error)},
                        {"protrusion_before", to_json(mended->repair.protrusion_before)},
                        {"protrusion_after", to_json(mended->repair.protrusion_after)},
                        {"grown", mended->repair.inflated},
                        {"largest_inflation", to_json(mended->repair.largest_inflation)},
                        {"total_inflation", to_json(mended->repair.total_inflation)},
                        {"added", mended->repair.added},
                        {"certificate", json_of(mended->certificate, external)},
                        {"warnings", mended->warnings}};
    }
    std::cout << to_text(json);
    return;
  }
  std::cout << describe(certificate, name_of(external));
  if (!mended) {
    if (!certificate.covered) std::cout << describe(steps_after_leak(arguments, scale));
    return;
  }
  std::cout << "repair: " << mended->repair.inflated << " spheres inflated, by at most "
            << mended->repair.largest_inflation << ", and " << mended->repair.added
            << " added; these protrude by at most " << mended->repair.max_error << ", all by "
            << mended->repair.protrusion_after << " (before: " << mended->repair.protrusion_before
            << ")\n"
            << describe(mended->certificate, name_of(external));
}

struct Reading {
  ModelReadOptions options;
  ModelUnit unit;
};

// Reads as the file says, or as the command line does; lengths of the command line become those of
// the output.
Reading reading_of(const AuditArguments& arguments, const SphereFile& file) {
  const ModelReadOptions stored =
      blame_file(arguments.spheres, [&] { return stored_reading(file); });
  UnitArguments unit = arguments.unit;
  take_stored_unit(arguments.spheres, file, stored, unit);
  ModelUnit found = [&] {
    try {
      return model_unit(arguments.models.front(), unit);
    } catch (const Error& error) {
      if (error.subject() != "--scale" || arguments.unit.scale) throw;
      std::ostringstream text;
      text << "was fitted with the scale " << stored.scale << ", which does not make "
           << unit_named(unit.units)->plural << " of " << arguments.models.front();
      throw Error(arguments.spheres, text.str());
    }
  }();
  arguments.lengths.convert(length_context(arguments.models.front(), found));
  // Lengths are in output units, so that they suit no other scale.
  ModelReadOptions reading = arguments.unit.scale ? ModelReadOptions{} : stored;
  reading.scale = found.scale;
  reading.units = unit.units;
  return {std::move(reading), std::move(found)};
}

// Before the long work. A max error comes with --repair only; without one nothing is said.
void warn_of_lengths(const AuditArguments& arguments, const TriangleMesh& mesh,
                     const ModelUnit& unit) {
  if (!arguments.max_error) return;
  const SimplifyOptions lengths{.max_error = *arguments.max_error,
                                .min_external_diameter = arguments.min_external.value_or(0.0)};
  const MeshReport report = mesh_report(mesh, {.self_intersections = false});
  warn_each(arguments.models.front(), length_warnings(report, lengths, unit));
}

// With more than two files the last is the spheres.
void name_spheres_last(AuditArguments& arguments) {
  for (const std::string& file : arguments.more) {
    arguments.models.push_back(std::exchange(arguments.spheres, file));
  }
}

int audit(const AuditArguments& arguments) {
  const bool mend = !arguments.repaired.empty();
  check_outputs({arguments.repaired}, {arguments.models.front(), arguments.spheres});
  const SphereFile file = load_spheres(arguments.spheres);
  if (!file.bodies.empty()) return audit_bodies(arguments, file);
  if (arguments.models.size() > 1) {
    throw Error(arguments.spheres, "is of one body, but several models are named");
  }
  SimplifyOptions options =
      blame_file(arguments.spheres, [&] { return options_from_record(file.options); });
  const auto [reading, unit] = reading_of(arguments, file);
  ProgressBar bar;
  bar.announce("reading");
  const ModelFile model = read_model(arguments.models.front(), reading);
  const TriangleMesh& mesh = model.mesh;
  bar.clear();
  warn_of_lengths(arguments, mesh, unit);

  options.threads = arguments.threads;
  options.progress = bar.callback();
  const bool has_diameter = take_min_external(arguments.min_external, options);
  std::optional<SolidProof> proof;
  bool has_larger_diameter = false;
  const auto place = [&] {
    if (!mend) {
      proof.emplace(mesh, options, has_diameter || file.options.contains("min-external"));
      return;
    }
    // What is added or inflated needs a solid to keep to.
    if (options.max_error == 0.0) options.max_error = arguments.max_error.value_or(0.0);
    options.levels.clear();
    SimplifiedSolid solid = simplified_solid(mesh, options);
    options = std::move(solid.options);
    proof.emplace(options, std::move(solid.external));
    has_larger_diameter = solid.larger_diameter;
  };
  if (has_diameter) {
    blame_named_file(arguments.models.front(), "grid step", place);
  } else {
    const auto is_of_file = [&](const Error& error) {
      return !arguments.max_error || error.subject() != "max error";
    };
    blame_file_if(is_of_file, arguments.spheres, place);
  }
  const std::optional<ExternalSpheres>& external = proof->external();
  const Certificate certificate = blame_named_file(
      arguments.spheres, "sphere ", [&] { return certify(mesh, file.spheres, proof->options()); });
  std::optional<Repaired> mended;
  if (mend) {
    mended = repaired(arguments, model, reading, file, options, proof->options());
    if (has_larger_diameter) {
      mended->warnings.push_back(larger_diameter_warning(options.min_external_diameter));
    }
    write_uninterrupted([&] { save_spheres(mended->file, arguments.repaired); });
  }
  bar.clear();
  print(arguments, mesh, file, reading.scale, certificate, external, mended);
  if (mended) warn_each(arguments.models.front(), mended->warnings);
  const bool covered = (mended ? mended->certificate : certificate).covered;
  return covered && !(model.cad && !model.cad->proved) ? kYes : kNo;
}

}  // namespace

void add_audit(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("audit", "Prove whether spheres cover a mesh; exit 0 covered, 1 leaks");
  auto arguments = std::make_shared<AuditArguments>();
  command->add_option("mesh", arguments->models.front(), "The mesh, or STEP or IGES")
      ->required()
      ->type_name(kFile);
  command->add_option("spheres", arguments->spheres, "Spheres (JSON), of any origin")
      ->required()
      ->type_name(kFile);
  command
      ->add_option("more", arguments->more,
                   "Where the spheres are of several meshes: name all of these, then the spheres")
      ->type_name(kFile);
  add_unit_options(*command, arguments->unit,
                   "Output units per mesh unit (default: as the spheres were fitted)");
  arguments->lengths.add_positive(
      *command, "--min-external", arguments->min_external,
      "D, against which simplified solid (default: as the spheres were fitted)");
  add_threads_option(*command, arguments->threads);
  command->add_flag("--json", arguments->json, "Print the certificate as JSON");
  CLI::Option* repair =
      command
          ->add_option("--repair", arguments->repaired,
                       "Where the spheres go (JSON), inflated and with others added so that they "
                       "cover; exit 0 then says that these do. Without D anywhere it is chosen as "
                       "fit does, E being --max-error or 1 % of the box diagonal")
          ->type_name(kFile);
  arguments->lengths
      .add_positive(*command, "--max-error", arguments->max_error,
                    "How far a repaired sphere may protrude (default: as the spheres were fitted, "
                    "or as far as half of them do, and at least 1 % of the box diagonal)")
      ->needs(repair);
  command->footer(to_text(
      {.text = "Any spheres will do: {\"format\": \"spherule-spheres\", \"version\": 1, "
               "\"options\": {}, \"spheres\": [{\"center\": [x, y, z], \"radius\": r}]}.",
       .exit_codes = "0 proved to cover (with --repair: the repaired ones); 1 leaks, or not proved",
       .examples = {"spherule audit part.stl part.json",
                    "spherule audit part.stl others.json --repair mended.json --units mm "
                    "--max-error 2mm",
                    "spherule audit part.stl part.json --json"}}));
  command->callback([arguments, &exit_code] {
    name_spheres_last(*arguments);
    exit_code = audit(*arguments);
  });
}

}  // namespace spherule
