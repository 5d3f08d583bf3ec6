// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "base/json.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/files/model.h"
#include "cli/files/warnings.h"
#include "cli/help/help.h"
#include "cli/robots/info_robot.h"
#include "cli/text/json.h"
#include "cli/text/print.h"
#include "geometry/enclosing_sphere.h"
#include "geometry/mesh_report.h"
#include "io/sphere_file.h"
#include "spheretree/check.h"
#include "spheretree/tree_file.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <variant>

namespace spherule {
namespace {

void print_sphere(const char* what, const Sphere& sphere) {
  std::cout << what << ": center (" << sphere.center.x() << ", " << sphere.center.y() << ", "
            << sphere.center.z() << "), radius " << sphere.radius << "\n";
}

void print_spheres(const SphereFile& file) {
  std::cout << "spheres: " << file.spheres.size() << "\n";
  if (!file.spheres.empty()) {
    const auto [smallest, largest] =
        std::minmax_element(file.spheres.begin(), file.spheres.end(),
                            [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
    std::cout << "radius: " << smallest->radius << " to " << largest->radius << "\n";
    print_sphere("enclosing sphere", enclosing_sphere(file.spheres));
  }
  if (file.interrupted) std::cout << kInterruptedSearch << "\n";
  if (!file.bodies.empty()) std::cout << "bodies: " << file.bodies.size() << "\n";
  for (const BodyRecord& body : file.bodies) {
    std::cout << "  " << one_line(body.name) << ": " << body.sphere_count << " spheres, "
              << (body.certificate && body.certificate->covered ? "covered" : "not covered");
    if (body.copy) std::cout << ", copy of " << one_line(file.bodies[body.copy->of].name);
    if (body.interrupted) std::cout << ", interrupted";
    std::cout << "\n";
  }
  for (const auto& [name, value] : file.options) {
    std::ostringstream text;
    text << "option " << name << ": ";
    std::visit([&](const auto& v) { text << v; }, value);
    std::cout << one_line(text.str()) << "\n";
  }
  if (!file.certificate) {
    std::cout << "certificate: none\n";
    return;
  }
  const CertificateRecord& certificate = *file.certificate;
  std::cout << "certificate (as stored, not proved again): "
            << (certificate.covered ? "covered" : "not covered") << ", uncovered depth "
            << certificate.uncovered_depth_lower << " to " << certificate.uncovered_depth_upper
            << "\n";
  const auto print_optional = [](const char* what, const std::optional<double>& value) {
    if (value) std::cout << "  " << what << ": " << *value << "\n";
  };
  print_optional("protrusion over the simplified solid, at most",
                 certificate.protrusion_over_simplified_max);
  print_optional("protrusion over the mesh, at most", certificate.protrusion_over_mesh_max);
  print_optional("volume ratio", certificate.volume_ratio);
  print_optional("volume that stage 1 filled, about", certificate.filled_volume);
  print_optional("ways into the part are filled up to D and this much, at most",
                 certificate.closing_slack);
}

void print_tree(const SphereTree& tree) {
  const TreeReport report = check(tree);
  std::cout << "tree: " << report.sphere_count << " spheres, " << report.node_count << " nodes, "
            << report.leaf_count << " leaves, depth " << report.depth << ", branching "
            << report.branching << "\n"
            << "invariants: " << (report.valid ? "all hold" : "broken") << "\n"
            << "mean inflation of a level: " << report.mean_inflation << "\n";
  print_sphere("root", tree.sphere(0));
}

void print_model(const std::string& file) {
  ModelUnit unit = model_unit(file, {});
  const ModelFile model = read_model(file);
  if (model.cad) {
    note_cad_unit(model.cad->stated_unit, unit);
    std::cout << describe(*model.cad);
  }
  std::cout << describe(unit) << describe(mesh_report(model.mesh)) << "\n";
}

bool is_interrupted_report(const std::string& file) {
  const auto refuse = [&](const std::string& reason) { throw Error(file, reason); };
  const Json report = internal::parse_json<Json>(read_file(file), refuse);
  return report.is_object() && report.value("interrupted", Json()) == true;
}

int info(const std::string& file) {
  const FileKind kind = recognize(file);
  switch (kind) {
    case FileKind::kSpheres:
      print_spheres(load_spheres(file));
      break;
    case FileKind::kTree:
      print_tree(load_tree(file));
      break;
#ifdef SPHERULE_HAS_ROBOT
    case FileKind::kUrdf:
      std::cout << describe_urdf(file);
      break;
    case FileKind::kSrdf:
      std::cout << describe_srdf(file);
      break;
    case FileKind::kRobotSpheres:
      std::cout << describe_robot_spheres(file);
      break;
#endif
    case FileKind::kMesh:
    case FileKind::kCad:
    case FileKind::kUnknown:  // the reader of meshes says what it takes
      print_model(file);
      break;
    case FileKind::kReport:
      std::cout << one_line(offer_for(kind, file)) << "\n";
      if (is_interrupted_report(file)) std::cout << kInterruptedSearch << "\n";
      break;
    default:
      std::cout << one_line(offer_for(kind, file)) << "\n";
  }
  return kYes;
}

}  // namespace

void add_info(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("info", "Say what is in a file of any kind that spherule reads or writes");
  auto file = std::make_shared<std::string>();
  command->add_option("file", *file, "The file; its content tells what it is")
      ->required()
      ->type_name(kFile);
  command->footer(to_text({.text = "",
                           .exit_codes = "0 done",
                           .examples = {"spherule info part.stl", "spherule info part.json",
                                        "spherule info robot.urdf"}}));
  command->callback([file, &exit_code] { exit_code = info(*file); });
}

}  // namespace spherule
