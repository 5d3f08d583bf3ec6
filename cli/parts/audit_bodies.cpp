// SPDX-License-Identifier: BSD-3-Clause
#include "cli/parts/audit_bodies.h"

#include "base/error.h"
#include "base/rounding.h"
#include "cli/files/in_file.h"
#include "cli/files/model_bodies.h"
#include "cli/parts/audit_proof.h"
#include "cli/text/exit_code.h"
#include "cli/text/json.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"

#include <algorithm>
#include <iostream>
#include <optional>
#include <span>
#include <sstream>
#include <utility>

namespace spherule {
namespace {

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
  arguments.lengths.convert(length_context(arguments.models, units));
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

std::string text_of(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string text_of(const Eigen::Vector3d& point) {
  return "(" + text_of(point.x()) + ", " + text_of(point.y()) + ", " + text_of(point.z()) + ")";
}

void print(std::span<const BodyVerdict> verdicts, bool as_json) {
  Json list = Json::array();
  std::vector<std::vector<std::string>> rows = {
      {"body", "spheres", "covered", "none deeper than", "protrusion", ""}};
  std::vector<std::vector<std::string>> places;
  std::size_t covered = 0;
  for (const BodyVerdict& verdict : verdicts) {
    const CertificateRecord& record = verdict.certificate;
    const std::optional<double>& protrusion = record.protrusion_over_simplified_max;
    covered += record.covered ? 1 : 0;
    rows.push_back({verdict.name, std::to_string(record.sphere_count),
                    record.covered ? "yes (proved)" : "no", text_of(record.uncovered_depth_upper),
                    protrusion ? text_of(*protrusion) : "-", verdict.note});
    list.push_back(
        {{"name", verdict.name},
         {"covered", record.covered},
         {"uncovered_depth",
          {to_json(record.uncovered_depth_lower), to_json(record.uncovered_depth_upper)}},
         {"protrusion_over_simplified_max", protrusion ? to_json(*protrusion) : Json(nullptr)},
         {"sphere_count", record.sphere_count},
         {"note", verdict.note}});
    if (!verdict.deepest_leak) continue;
    list.back()["deepest_leak"] = to_json(*verdict.deepest_leak);
    places.push_back({"  " + verdict.name, text_of(*verdict.deepest_leak)});
  }
  if (as_json) {
    std::cout << to_text(Json{{"covered", covered == verdicts.size()}, {"bodies", list}});
    return;
  }
  std::cout << aligned(rows);
  if (!places.empty())
    std::cout << "deepest leaks at (x, y, z), in the frame and unit of the file:\n"
              << aligned(places);
  std::cout << covered << " of " << verdicts.size() << " bodies are covered (proved)\n";
}

}  // namespace

int audit_bodies(const AuditArguments& arguments, const SphereFile& file) {
  if (!arguments.repaired.empty()) {
    throw Error("--repair", arguments.spheres + " has several bodies; only one is repaired");
  }
  const ModelBodies model = read(arguments, file);
  check_names(arguments, file, model);
  const std::vector<BodyVerdict> verdicts = Auditor(arguments, file, model).run();
  print(verdicts, arguments.json);
  const bool covered = std::ranges::all_of(
      verdicts, [](const BodyVerdict& verdict) { return verdict.certificate.covered; });
  const bool measured = std::ranges::any_of(
      model.cad, [](const std::optional<CadPart>& part) { return part && !part->proved; });
  return covered && !measured ? kYes : kNo;
}

}  // namespace spherule
