// SPDX-License-Identifier: BSD-3-Clause
#include "io/sphere_file.h"

#include "io/sphere_text.h"
#include "tests/support/random_scene.h"
#include "tests/support/temporary_folder.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>

namespace spherule::test {
namespace {

class SphereFiles : public TemporaryFolder {};

constexpr double kInfinity = std::numeric_limits<double>::infinity();

SphereFile full_file() {
  SphereFile file;
  file.spheres = {{{0.1, -0.2, 1.0 / 3.0}, 0.5}, {{1e-9, 1e15, -0.0}, 0x1p-1074}};
  file.certificate = {.covered = true,
                      .uncovered_depth_lower = 0.0,
                      .uncovered_depth_upper = 1e-7,
                      .protrusion_over_simplified_max = 0.25,
                      .protrusion_over_mesh_max = kInfinity,
                      .sphere_count = 2,
                      .volume_ratio = 1.3,
                      .filled_volume = 0.7,
                      .filled_volume_error = 0.1,
                      .closing_slack = 0.03};
  file.options = {{"max-error", 3.0},
                  {"seed", std::int64_t{3}},
                  {"negative", std::int64_t{-9}},
                  {"largest", std::numeric_limits<std::int64_t>::max()},
                  {"least", std::numeric_limits<std::int64_t>::min()},
                  {"limit", -kInfinity},
                  {"reachable", true},
                  {"method", std::string("cover \"\\\n \xC3\xA9")},
                  {"empty", std::string()}};
  return file;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void expect_same(const SphereFile& a, const SphereFile& b) {
  ASSERT_EQ(a.spheres.size(), b.spheres.size());
  for (std::size_t i = 0; i < a.spheres.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_TRUE(same_bits(a.spheres[i].center[axis], b.spheres[i].center[axis]));
    }
    EXPECT_TRUE(same_bits(a.spheres[i].radius, b.spheres[i].radius));
  }
  EXPECT_EQ(a.options, b.options);  // the types of the values, too
  ASSERT_EQ(a.certificate.has_value(), b.certificate.has_value());
  if (!a.certificate) return;
  const auto numbers = [](const CertificateRecord& c) {
    return std::tie(c.covered, c.uncovered_depth_lower, c.uncovered_depth_upper,
                    c.protrusion_over_simplified_max, c.protrusion_over_mesh_max, c.sphere_count,
                    c.volume_ratio, c.filled_volume, c.filled_volume_error, c.closing_slack);
  };
  EXPECT_EQ(numbers(*a.certificate), numbers(*b.certificate));
}

SphereFile read(const std::string& text) {
  return internal::decode_spheres(text, "a.json");
}

// A file whose parts can be replaced one by one.
std::string text_with(const std::string& spheres, const std::string& more = "",
                      const std::string& version = "1") {
  return R"({"format":"spherule-spheres","version":)" + version + R"(,"spheres":)" + spheres +
         more + "}";
}
const std::string kGood = R"([{"center":[1,2,3],"radius":0.5}])";

void expect_refused(const std::string& text, const std::string& reason) {
  const std::string error = error_of([&] { read(text); });
  EXPECT_TRUE(error.starts_with("a.json: ")) << error << " for " << text.substr(0, 200);
  EXPECT_NE(error.find(reason), std::string::npos) << error << " for " << text.substr(0, 200);
}

TEST_F(SphereFiles, RoundTripKeepsEveryBitAndType) {
  const SphereFile file = full_file();
  const std::string text = internal::encode_spheres(file, "a.json");
  expect_same(read(text), file);
  EXPECT_EQ(internal::encode_spheres(read(text), "a.json"), text);
}

TEST_F(SphereFiles, RoundTripOfManyRandomDoubles) {
  Random random(77);
  SphereFile file;
  const auto any = [&random] {
    for (;;) {
      const double value = std::bit_cast<double>(random.bits());
      if (std::abs(value) <= kMaxCoordinate) return value;
    }
  };
  for (int i = 0; i < 5000; ++i) {
    const double x = any();
    const double y = any();
    file.spheres.push_back({{x, y, any()}, std::abs(any())});
  }
  for (const Family& family : sphere_families(100, 1)) {
    file.spheres.insert(file.spheres.end(), family.spheres.begin(), family.spheres.end());
  }
  expect_same(read(internal::encode_spheres(file, "a.json")), file);
}

TEST_F(SphereFiles, AbsentPartsStayAbsent) {
  SphereFile file;
  expect_same(read(internal::encode_spheres(file, "a.json")), file);
  file.certificate.emplace();
  expect_same(read(internal::encode_spheres(file, "a.json")), file);
  expect_same(read(text_with("[]")), SphereFile{});
  expect_same(read(text_with("[]", R"(,"certificate":null,"options":null)")), SphereFile{});
  const SphereFile nulls =
      read(text_with("[]", R"(,"certificate":{"covered":false,"uncovered_depth":[0,"inf"],)"
                           R"("protrusion_over_simplified_max":null,"sphere_count":0})"));
  EXPECT_FALSE(nulls.certificate->covered);
  EXPECT_EQ(nulls.certificate->uncovered_depth_upper, kInfinity);
  EXPECT_FALSE(nulls.certificate->protrusion_over_simplified_max.has_value());
}

TEST_F(SphereFiles, IsTheDocumentedJson) {
  SphereFile file;
  file.spheres = {{{1, -2.5, 0}, 0.125}};
  file.certificate = {.covered = true, .uncovered_depth_upper = 0.5, .sphere_count = 1};
  file.options["seed"] = std::int64_t{7};
  EXPECT_EQ(internal::encode_spheres(file, "a.json"),
            "{\"format\":\"spherule-spheres\",\"version\":1,\n"
            "\"spheres\":[\n"
            "{\"center\":[1.0,-2.5,0.0],\"radius\":0.125}\n"
            "],\n"
            "\"certificate\":{\"covered\":true,\"uncovered_depth\":[0.0,0.5],\"sphere_count\":1},\n"
            "\"options\":{\"seed\":7}}\n");
}

TEST_F(SphereFiles, AnInterruptedSearchIsMarkedAndNoOtherIs) {
  SphereFile file = full_file();
  const std::string whole = internal::encode_spheres(file, "a.json");
  EXPECT_EQ(whole.find("interrupted"), std::string::npos);
  EXPECT_FALSE(read(whole).interrupted);
  file.interrupted = true;
  const std::string marked = internal::encode_spheres(file, "a.json");
  EXPECT_EQ(marked, whole.substr(0, whole.rfind('}')) + ",\n\"interrupted\":true}\n");
  EXPECT_TRUE(read(marked).interrupted);
  expect_refused(text_with("[]", R"(,"interrupted":1)"), "\"interrupted\" is not true or false");
}

TEST_F(SphereFiles, ToleratesWhatItDoesNotKnowAndOtherOrders) {
  const SphereFile file = read(
      "\n{ \"spheres\" : [ {\"radius\":1, \"center\":[1,2,3], \"name\":\"tip\"} ], "
      "\"unit\":\"mm\", "
      "\"version\":1, \"options\":{\"a\":1,\"b\":1.0}, \"format\":\"spherule-spheres\"}");
  ASSERT_EQ(file.spheres.size(), 1U);
  EXPECT_EQ(file.spheres[0], (Sphere{{1, 2, 3}, 1.0}));
  EXPECT_TRUE(std::holds_alternative<std::int64_t>(file.options.at("a")));
  EXPECT_TRUE(std::holds_alternative<double>(file.options.at("b")));
}

TEST_F(SphereFiles, RefusesWhatIsNotThisFormat) {
  for (const std::string text : {"", "hello", "{", "{\"format\":", "[1,2", "{} {}", "\xff\xfe"}) {
    expect_refused(text, "is not JSON");
  }
  expect_refused(std::string(1000000, '['), "is nested too deeply");
  expect_refused(text_with(kGood) + "x", "is not JSON");
  expect_refused("[]", "is not an object");
  expect_refused("{}", "is not of format");
  expect_refused(R"({"format":"other","version":1,"spheres":[]})", "is not of format");
  expect_refused(R"({"format":1,"version":1,"spheres":[]})", "is not of format");
  expect_refused(R"({"format":"spherule-spheres","spheres":[]})", "\"version\" is missing");
  expect_refused(R"({"format":"spherule-spheres","version":1})", "\"spheres\" is missing");
  expect_refused(text_with(kGood, "", "2"), "format version 2");
  for (const std::string version : {"0", "-1", "1.0", "\"1\"", "null", "99999999999999999999"}) {
    expect_refused(text_with(kGood, "", version), "version");
  }
  expect_refused(text_with(kGood, R"(,"spheres":[])"), "\"spheres\" appears twice");
}

TEST_F(SphereFiles, RefusesBadValues) {
  const auto sphere = [](const std::string& center, const std::string& radius) {
    return text_with(R"([{"center":[0,0,0],"radius":1},{"center":)" + center + R"(,"radius":)" +
                     radius + "}]");
  };
  const auto with = [](const std::string& more) { return text_with(kGood, "," + more); };
  const auto certificate = [&](const std::string& depth, const std::string& count) {
    return with(R"("certificate":{"covered":true,"uncovered_depth":)" + depth +
                R"(,"sphere_count":)" + count + "}");
  };
  for (const std::string bad :
       {"null", "1", "[]", "[1,2]", "[1,2,3,4]", "[1,2,null]", "[1,\"2\",3]", "{}", "[[1],2,3]",
        "[1,2,true]", "[1,2,1e16]", "[1,\"-inf\",3]"}) {
    expect_refused(sphere(bad, "1"), "sphere 1");
  }
  for (const std::string bad :
       {"null", "\"1\"", "[1]", "true", "-1", "-1e-300", "1e16", "1e300", "\"inf\"", "\"nan\""}) {
    expect_refused(sphere("[1,2,3]", bad), "sphere 1");
  }
  for (const std::string bad : {"NaN", "Infinity", "1e999", "0x10", "01", "+1"}) {
    expect_refused(sphere("[1,2,3]", bad), "is not JSON");
  }
  for (const std::string bad : {"1", "[1]", "[2,1]", "[0,null]", "[-1,0]", "[0,1,2]"}) {
    expect_refused(certificate(bad, "1"), "uncovered_depth");
  }
  for (const std::string bad : {"2", "-1", "1.0", "null", "\"1\""}) {
    expect_refused(certificate("[0,1]", bad), "sphere_count");
  }
  for (const std::string bad : {"null", "[]", "{}", "18446744073709551615"}) {
    expect_refused(with(R"("options":{"seed":)" + bad + "}"), "option seed");
  }
  expect_refused(text_with("{}"), "\"spheres\" is not a list");
  expect_refused(text_with("[1]"), "sphere 0 is not an object");
  expect_refused(text_with(R"([{"center":[0,0,0]}])"), "\"radius\" is missing");
  expect_refused(text_with(R"([{"radius":1}])"), "\"center\" is missing");
  expect_refused(text_with(R"([{"center":[0,0,0],"radius":1,"radius":2}])"), "appears twice");
  expect_refused(certificate("[0,1]", R"(1,"volume_ratio":"x")"), "volume_ratio");
  expect_refused(with(R"("certificate":1)"), "\"certificate\" is not an object");
  expect_refused(with(R"("certificate":{})"), "\"covered\" is missing");
  expect_refused(with(R"("certificate":{"covered":1,"uncovered_depth":[0,1],"sphere_count":1})"),
                 "covered");
  expect_refused(with(R"("options":[])"), "\"options\" is not an object");
}

TEST_F(SphereFiles, RefusesToWriteWhatItCouldNotRead) {
  using Change = void (*)(SphereFile&);
  for (const Change change : std::initializer_list<Change>{
           [](SphereFile& file) { file.spheres[0].radius = -1.0; },
           [](SphereFile& file) { file.spheres[1].center.x() = std::nan(""); },
           [](SphereFile& file) { file.certificate->volume_ratio = std::nan(""); },
           [](SphereFile& file) { file.certificate->sphere_count = 3; },
           [](SphereFile& file) { file.certificate->uncovered_depth_lower = 1.0; },
           [](SphereFile& file) { file.options["bad"] = std::nan(""); },
           [](SphereFile& file) { file.options["bad"] = std::string("inf"); },
           [](SphereFile& file) { file.options["bad"] = std::string("\xff"); },
           [](SphereFile& file) { file.options["\xff"] = true; }}) {
    SphereFile file = full_file();
    change(file);
    const std::string error = error_of([&] { internal::encode_spheres(file, "a.json"); });
    EXPECT_TRUE(error.starts_with("a.json: ")) << error;
  }
}

TEST_F(SphereFiles, SavesAndLoads) {
  save_spheres(full_file(), path("a.json"));
  EXPECT_EQ(bytes_of(path("a.json")), internal::encode_spheres(full_file(), ""));
  expect_same(load_spheres(path("a.json")), full_file());
  EXPECT_EQ(files_in_folder(), 1U);
  put(path("bad.json"), "{");
  for (const auto& bad : {path("bad.json"), path("missing"), path("")}) {
    const std::string error = error_of([&] { load_spheres(bad); });
    EXPECT_TRUE(error.starts_with(bad.string() + ": ")) << error;
  }
  // What cannot be written leaves the old file as it was.
  SphereFile bad = full_file();
  bad.spheres[0].radius = -1.0;
  EXPECT_NE(error_of([&] { save_spheres(bad, path("a.json")); }), "");
  expect_same(load_spheres(path("a.json")), full_file());
}

SphereFile two_bodies() {
  SphereFile file;
  file.spheres = {{{0, 0, 0}, 1}, {{5, 0, 0}, 1}};
  CertificateRecord one{.covered = true, .protrusion_over_simplified_max = 0.5, .sphere_count = 1};
  file.bodies = {
      {.name = "bolt", .sphere_count = 1, .certificate = one, .options = {{"seed", 1.0}}},
      {.name = "bolt:2",
       .sphere_count = 1,
       .certificate = one,
       .copy = BodyCopy{0, Pose({0.6, 0, 0, 0.8}, {5, 0.1, -1.0 / 3.0})}}};
  return file;
}

TEST_F(SphereFiles, BodiesSurviveTheRoundTrip) {
  SphereFile file = two_bodies();
  file.bodies[1].interrupted = true;
  const SphereFile read = internal::decode_spheres(internal::encode_spheres(file, "file"), "file");
  expect_same(file, read);
  ASSERT_EQ(read.bodies.size(), 2u);
  EXPECT_EQ(read.bodies[0].name, "bolt");
  EXPECT_EQ(read.bodies[0].options, file.bodies[0].options);
  EXPECT_FALSE(read.bodies[0].copy);
  EXPECT_FALSE(read.bodies[0].interrupted);
  EXPECT_TRUE(read.bodies[1].interrupted);
  EXPECT_EQ(read.bodies[1].certificate->protrusion_over_simplified_max, 0.5);
  ASSERT_TRUE(read.bodies[1].copy);
  EXPECT_EQ(read.bodies[1].copy->of, 0u);
  EXPECT_EQ(read.bodies[1].copy->pose.matrix(), file.bodies[1].copy->pose.matrix());
  EXPECT_EQ(read.bodies[1].copy->pose.translation(), file.bodies[1].copy->pose.translation());
}

TEST_F(SphereFiles, BodiesThatDoNotFitTheSpheresAreRefused) {
  const std::string good = internal::encode_spheres(two_bodies(), "file");
  const auto refused = [&](const std::string& from, const std::string& to,
                           const std::string& reason) {
    const std::size_t at = good.rfind(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::string text = good;
    expect_refused(text.replace(at, from.size(), to), reason);
  };
  refused(R"("copy_of":0)", R"("copy_of":1)", "\"copy_of\" is not the number of a body before");
  refused(R"("name":"bolt:2")", R"("name":"")", "body 1: \"name\" is not a text");
  refused(R"("pose":[5.0,)", R"("pose":[)", "\"pose\" is not seven numbers");
  refused(R"("bodies":[)", R"("bodies":{},"more":[)", "\"bodies\" is not a list");
  SphereFile file = two_bodies();
  file.bodies.pop_back();
  EXPECT_THROW(internal::encode_spheres(file, "file"), Error);
}

}  // namespace
}  // namespace spherule::test
