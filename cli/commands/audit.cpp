// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/files/model.h"
#include "cli/files/warnings.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/text/json.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "geometry/triangle_mesh.h"
#include "io/sphere_file.h"
#include "simplifier/leaks.h"
#include "simplifier/option_record.h"
#include "simplifier/repair.h"
#include "simplifier/simplify.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// What spheres are proved against as they were fitted: the simplified solid, which is made anew,
// where D is known, else the mesh and its inside; or one that was made already. Not copied: the
// options refer to it.
class SolidProof {
 public:
  SolidProof(const TriangleMesh& mesh, const SimplifyOptions& options, bool has_diameter)
      : SolidProof(options, has_diameter ? std::optional(place_external_spheres(
                                               mesh, external_options(options)))
                                         : std::nullopt) {}
  SolidProof(const SimplifyOptions& options, std::optional<ExternalSpheres> external)
      : external_(std::move(external)), zones_(options.zones) {
    options_.padding = options.padding;
    options_.threads = options.threads;
    options_.progress = options.progress;
    if (!external_) return;
    options_.external = &*external_;
    // A file that says how it was fitted was proved at this resolution.
    options_.resolution = proof_resolution(tightest_error(zones_, options.max_error),
                                           external_->box.diagonal().norm());
    options_.zones = zones_;
  }
  SolidProof(const SolidProof&) = delete;
  SolidProof& operator=(const SolidProof&) = delete;

  const CertifyOptions& options() const { return options_; }
  const std::optional<ExternalSpheres>& external() const { return external_; }

 private:
  std::optional<ExternalSpheres> external_;
  std::vector<Zone> zones_;
  CertifyOptions options_;
};

// What the command line of `audit` says.
struct AuditArguments {
  const CLI::App* command = nullptr;
  std::vector<std::string> models = {""};
  std::string spheres;
  std::vector<std::string> more;  // as written: further models, and then the spheres
  UnitArguments unit;
  std::optional<double> min_external;
  std::optional<double> max_error;
  LengthOptions lengths;
  std::string repaired;
  int threads = 0;
  bool json = false;
};

// Takes D from the command line, if it is there, in the place of that of the file.
bool take_min_external(const std::optional<double>& min_external, SimplifyOptions& options) {
  if (!min_external) return false;
  options.min_external_diameter = *min_external;
  if (options.external == ExternalPlacement::kNone) {
    options.external = ExternalPlacement::kReachable;
  }
  return true;
}

// Fills in the unit and the scale that the file of spheres was made with, as `stored` has them,
// where the command line has none. Throws Error where it has another unit.
void take_stored_unit(const std::string& spheres, const SphereFile& file,
                      const ModelReadOptions& stored, UnitArguments& unit) {
  if (!stored.units.empty() && !unit.units.empty() && stored.units != unit.units) {
    throw Error("--units",
                spheres + " is in " + unit_named(stored.units)->plural + ", as its options say");
  }
  if (unit.units.empty()) unit.units = stored.units;
  if (!unit.scale && file.options.contains("scale")) unit.scale = stored.scale;
}

bool holds(const Sphere& outer, const Sphere& inner) {
  if (outer.center == inner.center) return outer.radius >= inner.radius;
  return add_up(distance_upper(outer.center, inner.center), inner.radius) <= outer.radius;
}

struct BodyVerdict {
  std::string name;
  CertificateRecord certificate;
  std::string note;  // for a person
  std::optional<Eigen::Vector3d> deepest_leak = std::nullopt;
};

bool flag_of(const SphereFile& file, const char* name) {
  const auto found = file.options.find(name);
  if (found == file.options.end()) return false;
  const bool* const truth = std::get_if<bool>(&found->second);
  if (truth == nullptr) throw Error(name, "must be true or false");
  return *truth;
}

ModelBodies read(const AuditArguments& arguments, const SphereFile& file) {
  ModelReadOptions reading;
  UnitArguments unit = arguments.unit;
  bool split = false;
  blame_file(arguments.spheres, [&] {
    reading = stored_reading(file);
    split = flag_of(file, "bodies");
  });
  take_stored_unit(arguments.spheres, file, reading, unit);
  reading.units = unit.units;
  const std::vector<ModelUnit> units = model_units(arguments.models, unit);
  arguments.lengths.convert(length_context(arguments.models.front(), units.front()));
  return read_bodies(arguments.models, units, reading, split);
}

void check_names(const AuditArguments& arguments, const SphereFile& file,
                 const ModelBodies& model) {
  for (std::size_t i = 0; i < std::max(file.bodies.size(), model.bodies.size()); ++i) {
    const std::string there = i < file.bodies.size() ? file.bodies[i].name : "no more";
    const std::string here = i < model.bodies.size() ? model.bodies[i].name : "no more";
    if (there == here) continue;
    throw Error(arguments.spheres, "is of other bodies: body " + std::to_string(i + 1) + " is " +
                                       there + ", of the models " + here +
                                       " (name all that they were fitted to, in that order)");
  }
}

class Auditor {
 public:
  Auditor(const AuditArguments& arguments, const SphereFile& file, const ModelBodies& model)
      : arguments_(arguments), file_(file), model_(model) {
    std::size_t first = 0;
    for (const BodyRecord& body : file.bodies) {
      spheres_.push_back(std::span(file.spheres).subspan(first, body.sphere_count));
      first += body.sphere_count;
    }
  }

  std::vector<BodyVerdict> run() {
    for (std::size_t i = 0; i < spheres_.size(); ++i) {
      bar_.callback()(static_cast<double>(i) / static_cast<double>(spheres_.size()),
                      "auditing bodies");
      verdicts_.push_back(model_.bodies[i].copy ? copied(i) : proved(i));
    }
    bar_.clear();
    return std::move(verdicts_);
  }

 private:
  BodyVerdict proved(std::size_t body) const {
    const BodyRecord& record = file_.bodies[body];
    const TriangleMesh& mesh = model_.bodies[body].mesh;
    const auto of_body = [&](auto action) {
      return blame_file(arguments_.spheres, [&] { return blame_file(record.name, action); });
    };
    SimplifyOptions options = of_body([&] { return options_from_record(record.options); });
    options.threads = arguments_.threads;
    const bool has_diameter = take_min_external(arguments_.min_external, options) ||
                              record.options.contains("min-external");
    const Certificate certificate = of_body([&] {
      const SolidProof proof(mesh, options, has_diameter);
      return certify(mesh, spheres_[body], proof.options());
    });
    BodyVerdict verdict{record.name, spherule::record(certificate), ""};
    if (certificate.uncovered_depth.lower > 0.0) verdict.deepest_leak = certificate.deepest_leak;
    return verdict;
  }

  BodyVerdict copied(std::size_t body) const {
    const BodyCopy& copy = *model_.bodies[body].copy;
    BodyVerdict verdict{file_.bodies[body].name, verdicts_[copy.of].certificate,
                        "copy of " + file_.bodies[copy.of].name};
    verdict.certificate = moved_certificate(verdict.certificate, spheres_[copy.of], copy.pose);
    const std::vector<Sphere> moved = moved_spheres(spheres_[copy.of], copy.pose);
    if (!std::ranges::equal(spheres_[body], moved, holds)) {
      verdict.certificate.covered = false;
      verdict.note += ", whose spheres these are not, moved";
    } else if (const std::optional<Eigen::Vector3d>& leak = verdicts_[copy.of].deepest_leak) {
      verdict.deepest_leak = copy.pose * *leak;
    }
    return verdict;
  }

  const AuditArguments& arguments_;
  const SphereFile& file_;
  const ModelBodies& model_;
  std::vector<std::span<const Sphere>> spheres_;
  std::vector<BodyVerdict> verdicts_;
  ProgressBar bar_;
};

Json bodies_json(std::span<const BodyVerdict> verdicts) {
  Json list = Json::array();
  bool covered = true;
  for (const BodyVerdict& verdict : verdicts) {
    const CertificateRecord& record = verdict.certificate;
    covered = covered && record.covered;
    list.push_back(
        {{"name", verdict.name},
         {"covered", record.covered},
         {"uncovered_depth",
          to_json(Bounds{record.uncovered_depth_lower, record.uncovered_depth_upper})},
         {"protrusion_over_simplified_max", to_json(record.protrusion_over_simplified_max)},
         {"sphere_count", record.sphere_count},
         {"note", verdict.note}});
    if (verdict.deepest_leak) {
      list.back()["deepest_leak"] = to_json(*verdict.deepest_leak);
    }
  }
  return {{"covered", covered}, {"bodies", list}};
}

std::string describe_bodies(const Json& bodies) {
  std::string text = table(bodies, {{"body", "{name}"},
                                    {"spheres", "{sphere_count}"},
                                    {"covered", "{covered:yes (proved)|no}"},
                                    {"none deeper than", "{uncovered_depth.1}"},
                                    {"protrusion", "{protrusion_over_simplified_max}"},
                                    {"", "{note}"}});
  Json leaking = Json::array();
  std::size_t covered = 0;
  for (const Json& body : bodies) {
    if (body.contains("deepest_leak")) leaking.push_back(body);
    covered += body["covered"] == true ? 1 : 0;
  }
  if (!leaking.empty()) {
    text += "deepest leaks at (x, y, z), in the frame and unit of the file:\n" +
            table(leaking, {{"", "  {name}"}, {"", "({deepest_leak})"}});
  }
  return text + concat(covered, " of ", bodies.size(), " bodies are covered (proved)\n");
}

// `audit` of a file of several bodies, each by itself: of one that is no copy the proof of its
// spheres, of a copy that its spheres are those of the other, moved. Returns the exit code: kNo if
// any is not proved. Throws Error, also where the models have other bodies.
int audit_bodies(const AuditArguments& arguments, const SphereFile& file) {
  if (!arguments.repaired.empty()) {
    throw Error("--repair", arguments.spheres + " has several bodies; only one is repaired");
  }
  const ModelBodies model = read(arguments, file);
  check_names(arguments, file, model);
  const std::vector<BodyVerdict> verdicts = Auditor(arguments, file, model).run();
  const Json json = bodies_json(verdicts);
  std::cout << (arguments.json ? to_text(json) : describe_bodies(json["bodies"]));
  const bool measured = std::ranges::any_of(
      model.cad, [](const std::optional<CadPart>& part) { return part && !part->proved; });
  return json["covered"] == true && !measured ? kYes : kNo;
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
  repeat(*arguments.command, {"--scale", "--units", "--min-external"}, mend);
  mend.insert(mend.end(), {"--repair", here(arguments.spheres, ".mended.json")});
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
  Json json = json_of(certificate, external);
  const std::string solid = external
                                ? filled("the simplified solid (D {min_external_diameter})", json)
                                : "the mesh and its inside";
  if (arguments.json && !certificate.covered) {
    json["leaks"] = json_of(leak_points(mesh, file.spheres));
  }
  if (mended) {
    json["repair"] = {{"file", arguments.repaired}};
    json["repair"].update(to_json(mended->repair));
    json["repair"]["total_inflation"] = to_json(mended->repair.total_inflation);
    json["repair"]["certificate"] = json_of(mended->certificate, external);
    json["repair"]["warnings"] = mended->warnings;
  }
  if (arguments.json) {
    std::cout << to_text(json);
    return;
  }
  std::cout << describe_certificate(json, solid);
  if (mended) {
    std::cout << "repair: " << describe_repair(json["repair"]) << "\n"
              << describe_certificate(json["repair"]["certificate"], solid);
  } else if (!certificate.covered) {
    std::cout << describe(steps_after_leak(arguments, scale));
  }
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
      throw Error(arguments.spheres,
                  concat("was fitted with the scale ", stored.scale, ", which does not make ",
                         unit_named(unit.units)->plural, " of ", arguments.models.front()));
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
  arguments->command = command;
  add_file_argument(*command, "mesh", arguments->models.front(), "The mesh, or STEP or IGES");
  add_file_argument(*command, "spheres", arguments->spheres, "Spheres (JSON), of any origin");
  add_file(*command, "more", arguments->more,
           "Where the spheres are of several meshes: name all of these, then the spheres");
  add_unit_options(*command, arguments->unit,
                   "Output units per mesh unit (default: as the spheres were fitted)");
  arguments->lengths.add_positive(
      *command, "--min-external", arguments->min_external,
      "D, against which simplified solid (default: as the spheres were fitted)");
  add_threads_option(*command, arguments->threads);
  command->add_flag("--json", arguments->json, "Print the certificate as JSON");
  CLI::Option* repair =
      add_file(*command, "--repair", arguments->repaired,
               "Where the spheres go (JSON), inflated and with others added so that they cover; "
               "exit 0 then says that these do. Without D anywhere it is chosen as fit does, E "
               "being --max-error or 1 % of the box diagonal");
  arguments->lengths
      .add_positive(*command, "--max-error", arguments->max_error,
                    "How far a repaired sphere may protrude (default: as the spheres were fitted, "
                    "or as far as half of them do, and at least 1 % of the box diagonal)")
      ->needs(repair);
  command->footer(to_text(
      {.text = "Any spheres will do: {\"format\": \"spherule-spheres\", \"version\": 1, "
               "\"options\": {}, \"spheres\": [{\"center\": [x, y, z], \"radius\": r}]}.",
       .exit_codes = "0 proved to cover (with --repair: the repaired ones); 1 leaks, or not proved",
       .examples = {
           "spherule audit part.stl part.json",
           "spherule audit part.stl others.json --repair mended.json --units mm --max-error 2mm",
           "spherule audit part.stl part.json --json"}}));
  command->callback([arguments, &exit_code] {
    name_spheres_last(*arguments);
    exit_code = audit(*arguments);
  });
}

}  // namespace spherule
