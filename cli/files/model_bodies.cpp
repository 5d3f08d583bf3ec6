// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/model_bodies.h"

#include "base/error.h"
#include "io/mesh_io.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

namespace spherule {
namespace {

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

LengthContext length_context(const std::vector<std::string>& files,
                             const std::vector<ModelUnit>& units) {
  return length_context(files.front(), units.front());
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
