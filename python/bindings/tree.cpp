// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "io/sphere_file.h"
#include "python/bindings/certificates.h"
#include "python/bindings/support.h"
#include "spheretree/sphere_tree.h"
#include "spheretree/tree_bytes.h"
#include "spheretree/tree_file.h"

#include <pybind11/stl.h>

namespace spherule::python {
namespace {

using TreePointer = std::shared_ptr<SphereTree>;

py::array spheres_of(const py::object& centers_in, const py::object& radii_in) {
  const std::vector<Eigen::Vector3d> centers = points(centers_in, "centers");
  const Numbers radii = row(radii_in, centers.size(), "radii");
  std::vector<Sphere> all;
  all.reserve(centers.size());
  for (const Eigen::Vector3d& center : centers) all.push_back({center, radii.data[all.size()]});
  return array_of(std::move(all));
}

TreePointer built(const py::object& spheres_in, int branching) {
  return run_long(py::none(),
                  [all = spheres(spheres_in, "spheres").copy(), branching](const LongRun&) {
                    return std::make_shared<SphereTree>(build_tree(all, {.branching = branching}));
                  });
}

TreePointer refitted(const SphereTree& tree, const py::object& moved) {
  const Spheres all = spheres(moved, "moved");
  const WithoutLock unlocked;
  return std::make_shared<SphereTree>(refit(tree, all.span()));
}

py::object tree_report_of(const SphereTree& tree) {
  const TreeReport r = check(tree);
  return make_result("TreeReport", r.valid, py::tuple(py::cast(r.problems)), r.sphere_count,
                     r.node_count, r.leaf_count, r.depth, r.branching, r.root_radius,
                     r.mean_inflation);
}

py::array level_of(const SphereTree& tree, int level) {
  if (level < 0 || level > tree.depth()) {
    throw Error("level",
                std::to_string(level) + " is not from 0 to " + std::to_string(tree.depth()));
  }
  return array_of(tree.level(level));
}

template <class Number>
auto column(const std::vector<Number> SphereTreeData::*member) {
  return [member](const py::object& self) {
    const std::vector<Number>& all = self.cast<const SphereTree&>().data().*member;
    return view(all.data(), {static_cast<py::ssize_t>(all.size())}, self);
  };
}

std::string tree_text(const SphereTree& tree) {
  return "<spherule.SphereTree: " + std::to_string(tree.spheres().size()) + " spheres, " +
         std::to_string(tree.node_count()) + " nodes, depth " + std::to_string(tree.depth()) + ">";
}

void bind_tree_class(py::module_& module) {
  py::class_<SphereTree, TreePointer>(
      module, "SphereTree",
      "Bounding sphere hierarchy over a set of spheres; build_tree() makes one. Immutable; threads "
      "may share it. In every inner node's sphere lie those of its children, in exact arithmetic.")
      .def_property_readonly(
          "spheres",
          [](const py::object& self) {
            return view(self.cast<const SphereTree&>().spheres(), self);
          },
          "The spheres of the leaves as they were given: shape (n, 4), read-only, no copy.")
      .def_property_readonly("node_count", &SphereTree::node_count)
      .def_property_readonly("depth", &SphereTree::depth,
                             "Edges on the longest way from the root to a leaf.")
      .def_property_readonly("branching", &SphereTree::branching,
                             "Largest number of children of a node.")
      .def_property_readonly(
          "root", [](const SphereTree& tree) { return array_of(tree.root()); },
          "The sphere of node 0, shape (4,).")
      .def_property_readonly("reach", &SphereTree::reach,
                             "Upper bound of the distance from the origin to any point.")
      .def_property_readonly(
          "box",
          [](const SphereTree& tree) {
            const AxisAlignedBox& box = tree.box();
            return array_of(
                Eigen::AlignedBox3d(box.center - box.half_size, box.center + box.half_size));
          },
          "Low and high corner of a box around the spheres, shape (2, 3), up to rounding.")
      .def_property_readonly("x", column(&SphereTreeData::x), "Of every node, breadth first.")
      .def_property_readonly("y", column(&SphereTreeData::y), "Of every node, breadth first.")
      .def_property_readonly("z", column(&SphereTreeData::z), "Of every node, breadth first.")
      .def_property_readonly("radius", column(&SphereTreeData::radius),
                             "Of every node, breadth first.")
      .def_property_readonly("first_child", column(&SphereTreeData::first_child),
                             "Of an inner node its first child, of a leaf the index of its sphere.")
      .def_property_readonly("child_count", column(&SphereTreeData::child_count),
                             "Of every node; 0 marks a leaf.")
      .def("level", &level_of, py::arg("level"),
           Help("level(self, level)",
                "The spheres at that distance from the root and the leaves above them, shape "
                "(n, 4): their union contains all spheres. 0 is the root.")
               .c_str())
      .def("__eq__",
           [](const SphereTree& tree, const py::object& other) {
             return py::isinstance<SphereTree>(other) &&
                    internal::encode_tree(tree) ==
                        internal::encode_tree(other.cast<const SphereTree&>());
           })
      .def("__len__", [](const SphereTree& tree) { return tree.spheres().size(); })
      .def("__repr__", &tree_text)
      .def(py::pickle([](const SphereTree& tree) { return py::bytes(internal::encode_tree(tree)); },
                      [](const py::bytes& bytes) {
                        return std::make_shared<SphereTree>(
                            internal::decode_tree(std::string_view(bytes), "pickle"));
                      }));
}

// From the fields of CoverLevel.
std::vector<SphereLevel> levels_of(const py::sequence& levels) {
  std::vector<SphereLevel> result;
  for (const py::handle level : levels) {
    result.push_back({spheres(level.attr("spheres"), "levels").copy(),
                      indices(level.attr("parent_of"), "parent_of")});
  }
  return result;
}

py::tuple level_tree_of(const py::object& spheres_in, const py::sequence& levels, int branching) {
  const Spheres all = spheres(spheres_in, "spheres");
  const std::vector<SphereLevel> given = levels_of(levels);
  LevelTree made = [&] {
    const WithoutLock unlocked;
    return build_tree_from_levels(all.span(), given, {.branching = branching});
  }();
  py::list nodes;
  for (std::vector<std::int32_t>& of_level : made.nodes)
    nodes.append(array_of(std::move(of_level)));
  return py::make_tuple(std::make_shared<SphereTree>(std::move(made.tree)), py::tuple(nodes));
}

}  // namespace

void bind_tree(py::module_& module) {
  bind_tree_class(module);
  module.def("spheres_of", &spheres_of, py::arg("centers"), py::arg("radii"),
             Help("spheres_of(centers, radii)",
                  "Spheres as this package takes them, shape (n, 4), of centres (n, 3) and radii "
                  "(n,).")
                 .c_str());
  module.def(
      "build_tree", &built, py::arg("spheres"), py::kw_only(), py::arg("branching") = 8,
      Help("build_tree(spheres, *, branching=8)",
           "The tree over spheres of shape (n, 4), rows x, y, z, radius. `branching`: children "
           "of a wide node, 2 to 16.")
          .c_str());
  module.def("refit", &refitted, py::arg("tree"), py::arg("moved"),
             Help("refit(tree, moved)",
                  "The tree over spheres that have moved, grown or shrunk: as many, in the same "
                  "order. Every query is as right as on a new tree, but may be slower.")
                 .c_str());
  module.def(
      "check", &tree_report_of, py::arg("tree"),
      Help("check(tree)", "Checks all invariants with outward rounding: a TreeReport.").c_str());
  module.def(
      "cut", [](const SphereTree& tree, std::size_t count) { return array_of(cut(tree, count)); },
      py::arg("tree"), py::arg("count"),
      Help("cut(tree, count)",
           "At most `count` spheres, shape (n, 4), whose union contains all spheres of the tree.")
          .c_str());
  module.def(
      "build_tree_from_levels", &level_tree_of, py::arg("spheres"), py::arg("levels"),
      py::kw_only(), py::arg("branching") = 8,
      Help("build_tree_from_levels(spheres, levels, *, branching=8)",
           "The tree whose inner nodes are the spheres of the levels, the finest first "
           "(CoverLevel, or what has `spheres` and `parent_of`), and for each level the nodes "
           "in which its spheres stand.")
          .c_str());
  module.def(
      "save_tree",
      [](const SphereTree& tree, const py::object& path) {
        save_tree(tree, path_of(path, "path"));
      },
      py::arg("tree"), py::arg("path"),
      Help("save_tree(tree, path)", "Writes the tree in the format of docs/tree-file.md.").c_str());
  module.def(
      "load_tree",
      [](const py::object& path) {
        return std::make_shared<SphereTree>(load_tree(path_of(path, "path")));
      },
      py::arg("path"), Help("load_tree(path)", "Reads a tree, bit for bit.").c_str());
}

namespace {

py::object pose_or_none(const std::optional<BodyCopy>& copy) {
  return copy ? py::cast(copy->pose) : py::object(py::none());
}

py::object body_object(const BodyRecord& body) {
  return make_result("BodyRecord", body.name, body.sphere_count, record_object(body.certificate),
                     py::cast(body.options), copy_of(body.copy), pose_or_none(body.copy),
                     body.interrupted);
}

std::vector<BodyRecord> bodies_of(const py::object& bodies) {
  std::vector<BodyRecord> result;
  for (const py::handle body : bodies) {
    BodyRecord& record = result.emplace_back();
    record.name = py::str(body.attr("name"));
    record.sphere_count = body.attr("sphere_count").cast<std::size_t>();
    record.certificate = record_of(body.attr("certificate"));
    record.options = body.attr("options").cast<std::map<std::string, OptionValue>>();
    record.interrupted = body.attr("interrupted").cast<bool>();
    if (body.attr("copy_of").is_none()) continue;
    record.copy = {body.attr("copy_of").cast<std::size_t>(), pose_of(body.attr("pose"), "pose")};
  }
  return result;
}

void save_file(const py::object& file, const py::object& path) {
  SphereFile content = file_of(file);
  save_spheres(content, path_of(path, "path"));
}

}  // namespace

py::object copy_of(const std::optional<BodyCopy>& copy) {
  return copy ? py::object(py::int_(copy->of)) : py::object(py::none());
}

py::object file_object(SphereFile file) {
  py::list bodies;
  for (const BodyRecord& body : file.bodies) bodies.append(body_object(body));
  return make_result("SphereFile", array_of(std::move(file.spheres)),
                     record_object(file.certificate), py::cast(file.options), py::tuple(bodies),
                     file.interrupted);
}

SphereFile file_of(const py::object& file) {
  return {.spheres = spheres(file.attr("spheres"), "spheres").copy(),
          .certificate = record_of(file.attr("certificate")),
          .options = file.attr("options").cast<std::map<std::string, OptionValue>>(),
          .bodies = bodies_of(file.attr("bodies")),
          .interrupted = file.attr("interrupted").cast<bool>()};
}

void bind_sphere_files(py::module_& module) {
  module.def("save_spheres", &save_file, py::arg("file"), py::arg("path"),
             Help("save_spheres(file, path)",
                  "Writes a SphereFile as SPHERES.json. Of a Simplification it is `.file`; "
                  "SphereFile(spheres) makes one of any spheres.")
                 .c_str());
  module.def(
      "load_spheres",
      [](const py::object& path) { return file_object(load_spheres(path_of(path, "path"))); },
      py::arg("path"),
      Help("load_spheres(path)", "Reads SPHERES.json: a SphereFile, doubles bit for bit.").c_str());
}

}  // namespace spherule::python
