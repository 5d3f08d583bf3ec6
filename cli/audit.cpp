// SPDX-License-Identifier: BSD-3-Clause
#include "cli/command.h"
#include "cli/json.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "simplifier/mesh_io.h"
#include "simplifier/simplify.h"
#include "spheretree/error.h"
#include "spheretree/sphere_file.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

namespace spherule {
namespace {

struct AuditArguments {
  std::string mesh;
  std::string spheres;
  std::optional<double> scale;
  std::optional<double> min_external;
  bool json = false;
};

// Runs what depends on the options in the file, and blames the file for what is wrong with them.
template <typename Use>
auto blaming_file(const AuditArguments& arguments, Use use) {
  try {
    return use();
  } catch (const Error& error) {
    throw Error(arguments.spheres, error.what());
  }
}

// The scale the file was fitted at.
double stored_scale(const SphereFile& file) {
  const auto found = file.options.find("scale");
  if (found == file.options.end()) return 1.0;
  double scale = 0.0;
  if (const double* real = std::get_if<double>(&found->second)) scale = *real;
  if (const auto* whole = std::get_if<std::int64_t>(&found->second)) {
    scale = static_cast<double>(*whole);
  }
  if (!(scale > 0.0) || !std::isfinite(scale)) {
    throw Error("scale", "must be a positive finite number");
  }
  return scale;
}

void print(const AuditArguments& arguments, const Certificate& certificate,
           const std::optional<ExternalSpheres>& external) {
  if (!arguments.json) {
    std::ostringstream solid;
    if (external) {
      solid << "the simplified solid (D " << external->min_external_diameter << ")";
    } else {
      solid << "the mesh and its inside";
    }
    std::cout << describe(certificate, solid.str());
    return;
  }
  Json json = to_json(certificate);
  json["against"] = external ? "simplified solid" : "mesh and its inside";
  if (external) {
    json["min_external_diameter"] = to_json(external->min_external_diameter);
    json["padding"] = to_json(external->padding);
    json["external_sphere_count"] = external->balls.size();
  }
  std::cout << to_text(json);
}

int audit(const AuditArguments& arguments) {
  const SphereFile file = load_spheres(arguments.spheres);
  SimplifyOptions options =
      blaming_file(arguments, [&] { return options_from_record(file.options); });
  const double scale = arguments.scale
                           ? *arguments.scale
                           : blaming_file(arguments, [&] { return stored_scale(file); });
  const TriangleMesh mesh = read_mesh(arguments.mesh, {.scale = scale});

  ProgressBar bar;
  options.progress = bar.callback();
  CertifyOptions certify_options;
  certify_options.padding = options.padding;
  certify_options.progress = options.progress;
  if (arguments.min_external) {
    if (!(*arguments.min_external > 0.0) || !std::isfinite(*arguments.min_external)) {
      throw Error("--min-external", "must be positive and finite");
    }
    options.min_external_diameter = *arguments.min_external;
    if (options.external == ExternalPlacement::kNone) {
      options.external = ExternalPlacement::kReachable;
    }
  }
  std::optional<ExternalSpheres> external;
  if (arguments.min_external || file.options.contains("min-external")) {
    const auto place = [&] { return place_external_spheres(mesh, external_options(options)); };
    external = arguments.min_external ? place() : blaming_file(arguments, place);
    certify_options.external = &*external;
    // A file that says how it was fitted was proved at this resolution.
    certify_options.resolution = proof_resolution(tightest_error(options.zones, options.max_error),
                                                  external->box.diagonal().norm());
    certify_options.zones = options.zones;
  }
  const Certificate certificate = certify(mesh, file.spheres, certify_options);
  print(arguments, certificate, external);
  return certificate.covered ? kYes : kNo;
}

}  // namespace

void add_audit(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("audit", "Prove whether spheres cover a mesh; exit 0 covered, 1 leaks");
  auto arguments = std::make_shared<AuditArguments>();
  command->add_option("mesh", arguments->mesh, "The mesh")->required();
  command->add_option("spheres", arguments->spheres, "Spheres (JSON), of any origin")->required();
  command->add_option("--scale", arguments->scale,
                      "Output units per mesh unit (default: as the spheres were fitted)");
  command->add_option("--min-external", arguments->min_external,
                      "D, against which simplified solid (default: as the spheres were fitted)");
  command->add_flag("--json", arguments->json, "Print the certificate as JSON");
  command->callback([arguments, &exit_code] { exit_code = audit(*arguments); });
}

}  // namespace spherule
