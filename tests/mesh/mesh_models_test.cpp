// SPDX-License-Identifier: BSD-3-Clause
// The real models, where SPHERULE_MODELS names their folder: what we read against the numbers that
// their manifest.json states (made by another program).
#include "geometry/mesh_report.h"
#include "io/mesh_io.h"
#include "tests/support/models.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iostream>
#include <string>

namespace spherule {
namespace {

TEST(MeshModels, AgreeWithTheirManifest) {
  const auto dir = test::models_dir();
  if (!dir) GTEST_SKIP() << "SPHERULE_MODELS is not set";
  std::ifstream file(*dir / "manifest.json");
  const nlohmann::json manifest = nlohmann::json::parse(file);
  int meshes = 0, same_topology = 0;
  for (const nlohmann::json& entry : manifest) {
    if (!entry.contains("chk") || !entry["chk"].contains("tris")) continue;
    const nlohmann::json& stated = entry["chk"];
    const std::string name = entry["f"];
    SCOPED_TRACE(name);
    ++meshes;
    const MeshReport report = mesh_report(read_mesh(*dir / name));
    EXPECT_EQ(report.triangles, stated["tris"].get<std::size_t>());
    const double size = report.box.diagonal().norm();
    // The manifest writes six digits after the point.
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      EXPECT_NEAR(report.box.sizes()[k], stated["bbox"][axis].get<double>(), 1e-6 * (1 + size));
      EXPECT_NEAR(report.box.min()[k], stated["min"][axis].get<double>(), 1e-6 * (1 + size));
    }
    EXPECT_NEAR(report.area, stated["area"].get<double>(), 1e-5 * report.area);
    // Its vertices are joined within 1e-6 of the diagonal, ours where they are equal: topology can
    // be compared only where that makes no difference.
    if (report.vertices != stated["verts"].get<std::size_t>()) continue;
    ++same_topology;
    EXPECT_EQ(report.boundary_edges, stated["open"].get<std::size_t>());
    EXPECT_EQ(report.non_manifold_edges, stated["nonman"].get<std::size_t>());
    EXPECT_EQ(report.misoriented_edges, stated["misorient"].get<std::size_t>());
    EXPECT_EQ(report.duplicate_triangles, stated["dup"].get<std::size_t>());
    if (stated["watertight"].get<bool>() && stated["oriented"].get<bool>()) {
      EXPECT_TRUE(report.closed);
      EXPECT_NEAR(report.volume, stated["vol"].get<double>(), 1e-5 * report.area * size);
    }
  }
  EXPECT_GT(meshes, 80);
  EXPECT_GT(same_topology, meshes / 2);
  std::cout << meshes << " meshes, " << same_topology << " with the same vertices\n";
}

}  // namespace
}  // namespace spherule
