// SPDX-License-Identifier: BSD-3-Clause
#include "io/sphere_file.h"
#include "io/sphere_text.h"
#include "simplifier/types/zones.h"
#include "spheretree/build.h"
#include "spheretree/tree_bytes.h"
#include "tests/fuzz/fuzz_seeds.h"
#include "tests/fuzz/sealed_content.h"

namespace spherule::test {
namespace {

const std::vector<Sphere> kSpheres = {
    {{0, 0, 0}, 1.0}, {{1.5, -0.25, 1e-3}, 0.5}, {{-3, 2, 1}, 1e3}, {{0.1, 0.2, 0.3}, 0.0}};

}  // namespace

std::vector<std::string> sphere_file_seeds() {
  SphereFile plain;
  plain.spheres = kSpheres;
  SphereFile certified = plain;
  certified.certificate.emplace();
  certified.certificate->sphere_count = kSpheres.size();
  certified.options["max-error"] = 0.5;
  return {internal::encode_spheres(plain, "plain"),
          internal::encode_spheres(certified, "certified")};
}

std::vector<std::string> tree_seeds() {
  return {internal::encode_tree(build_tree(kSpheres))};
}

std::vector<std::string> tree_content_seeds() {
  return {without_checksum(internal::encode_tree(build_tree(kSpheres)))};
}

std::vector<std::string> zone_seeds() {
  return {R"({"format":"spherule-zones","version":1,"zones":[
    {"shape":"ball","center":[1,2,3],"radius":0.5,"max_error":0.1,"min_external":0.4},
    {"shape":"box","min":[0,0,0],"max":[1,1,1],"max_error":0.2},
    {"shape":"capsule","from":[0,0,0],"to":[1,0,0],"radius":0.1,"min_external":0.5}]})"};
}

}  // namespace spherule::test
