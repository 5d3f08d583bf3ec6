// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/sphere_formats.h"
#include "tests/robot/formats/sphere_sets.h"
#include "tests/support/models.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

namespace spherule::sphere_formats_models_test {
namespace {

struct Published {
  const char* file;  // below robots
  SphereFormat format;
  std::size_t spheres;
  std::size_t links;  // with spheres
};

constexpr Published kPublished[] = {
    {"franka_panda/peer_spheres/curobo_franka.yml", SphereFormat::kCurobo, 61, 11},
    {"franka_panda/peer_spheres/robometrics_franka_spheres.yml", SphereFormat::kCurobo, 61, 11},
    {"franka_panda/peer_spheres/morphit_franka.yml", SphereFormat::kCurobo, 158, 11},
    {"franka_panda/peer_spheres/vamp_panda_spherized.urdf", SphereFormat::kUrdf, 59, 11},
    {"franka_panda/peer_spheres/foam_smaller_panda_spherized.urdf", SphereFormat::kUrdf, 59, 11},
    {"franka_panda/peer_spheres/cricket_panda_spherized_1.urdf", SphereFormat::kUrdf, 11, 11},
    {"franka_panda/peer_spheres/morphit_panda.spherical.urdf", SphereFormat::kUrdf, 220, 11},
    {"franka_fr3/peer_spheres/cricket_fr3_spherized.urdf", SphereFormat::kUrdf, 55, 11},
};

TEST(PublishedSpheres, AreReadAsTheyAre) {
  const auto models = test::models_dir();
  if (!models) GTEST_SKIP() << "SPHERULE_MODELS is not set";
  const test::TempDir folder;
  for (const Published& set : kPublished) {
    SCOPED_TRACE(set.file);
    const auto path = *models / "robots" / set.file;
    const SphereFormatFile file = read_robot_spheres(path);
    EXPECT_EQ(file.format, set.format);
    std::size_t spheres = 0;
    std::size_t links = 0;
    for (const LinkSpheres& link : file.spheres.links) {
      spheres += link.spheres.size();
      links += link.spheres.empty() ? 0 : 1;
    }
    EXPECT_EQ(spheres, set.spheres);
    EXPECT_EQ(links, set.links);
    EXPECT_EQ(file.spheres.switched_off, 0u);
    // Written over itself, it holds the same.
    const auto copy = folder.path() / "copy";
    write_robot_spheres(file.spheres, file.format, {.urdf = path, .original = path}, copy);
    EXPECT_EQ(difference(read_robot_spheres(copy).spheres.links, file.spheres.links), "");
  }
}

TEST(PublishedSpheres, VampAndFoamShipTheSame) {
  const auto models = test::models_dir();
  if (!models) GTEST_SKIP() << "SPHERULE_MODELS is not set";
  const auto folder = *models / "robots/franka_panda/peer_spheres";
  EXPECT_EQ(
      difference(read_robot_spheres(folder / "vamp_panda_spherized.urdf").spheres.links,
                 read_robot_spheres(folder / "foam_smaller_panda_spherized.urdf").spheres.links),
      "");
}

}  // namespace
}  // namespace spherule::sphere_formats_models_test
