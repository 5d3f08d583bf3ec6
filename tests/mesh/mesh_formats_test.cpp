// SPDX-License-Identifier: BSD-3-Clause
// What each format can hold, and what is wrong with broken files.
#include "base/error.h"
#include "geometry/mesh_report.h"
#include "io/mesh_io.h"
#include "tests/mesh/mesh_files.h"
#include "tests/mesh/read_files.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace spherule {
namespace {

class Formats : public test::ReadFiles {
 protected:
  TriangleMesh cube_ = test::cube_mesh();
};

using test::replaced;

TEST_F(Formats, BinaryStlOfWrongSize) {
  const std::string good = test::binary_stl(cube_);
  EXPECT_TRUE(refused("stl", good.substr(0, good.size() - 1), "cut short"));
  EXPECT_TRUE(refused("stl", good + "x", "12 triangles"));
  EXPECT_TRUE(refused("stl", good.substr(0, 84), "12 triangles in 684 bytes, but it has 84"));
  EXPECT_TRUE(refused("stl", good.substr(0, 60), "not an STL file"));
  std::string huge = good;
  huge.replace(80, 4, "\xFF\xFF\xFF\xFF");
  EXPECT_TRUE(refused("stl", huge, "4294967295 triangles"));
  std::string none = good.substr(0, 84);
  none.replace(80, 4, std::string(4, '\0'));
  EXPECT_TRUE(refused("stl", none, "no triangles"));
  EXPECT_TRUE(refused("stl", test::binary_stl(cube_, "solid x").substr(0, 600), "12 triangles"));
}

TEST_F(Formats, BinaryStlWithBadNumbers) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f}) {
    std::string bytes = test::binary_stl(cube_);
    std::memcpy(bytes.data() + 84 + 12 + 50 * 3, &bad, sizeof bad);
    EXPECT_TRUE(refused("stl", bytes, bad == 1e30f ? "beyond 1e15" : "not finite"));
    // The normal is not used.
    bytes = test::binary_stl(cube_);
    std::memcpy(bytes.data() + 84, &bad, sizeof bad);
    EXPECT_EQ(error("stl", bytes), "");
  }
}

TEST_F(Formats, TextStl) {
  const std::string good = test::text_stl(cube_, "several words of a name");
  const std::string two =
      good + test::text_stl(test::moved(cube_, Eigen::Isometry3d(Eigen::Translation3d(3, 0, 0))));
  EXPECT_EQ(mesh_report(read("stl", two)).components, 2u);
  std::string shouted = good;
  for (char& c : shouted) c = static_cast<char>(std::toupper(c));
  EXPECT_EQ(read("stl", shouted).triangles.size(), 12u);
  EXPECT_EQ(read("stl", "\n \t" + good).triangles.size(), 12u);
  EXPECT_EQ(read("stl", replaced(good, "normal 0 0 0", "normal nan -nan inf")).triangles.size(),
            12u);
  for (const char* bad : {"nan", "-inf", "inf", "1e999", "x", "0x10", "1,5", "--1"}) {
    EXPECT_TRUE(refused("stl", replaced(good, "vertex 0", std::string("vertex ") + bad), "line 4"))
        << bad;
  }
  EXPECT_TRUE(refused("stl", replaced(good, "vertex 0", "vertex 1e20"), "beyond 1e15"));
  EXPECT_TRUE(
      refused("stl", replaced(good, "vertex 0", "vertex 100000000000000000000"), "beyond 1e15"));
  EXPECT_TRUE(refused("stl", replaced(good, "  vertex 0 0 0\n", ""), "fewer than three"));
  EXPECT_TRUE(refused("stl", replaced(good, "endfacet", ""), "'endfacet' expected"));
  EXPECT_TRUE(refused("stl", good.substr(0, good.find("endsolid")), "cut short"));
  EXPECT_TRUE(refused("stl", good.substr(0, good.size() / 2), "line"));
  EXPECT_TRUE(refused("stl", "solid\nendsolid\n", "no triangles"));
  // A loop of four corners is a fan of two triangles.
  EXPECT_EQ(read("stl", replaced(good, " endloop", "vertex 5 5 5\n endloop")).triangles.size(),
            13u);
}

TEST_F(Formats, ObjIndices) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  EXPECT_EQ(read("obj", vertices + "f 1 2 3\n").triangles.size(), 1u);
  EXPECT_EQ(read("obj", vertices + "f -4 -3 -2\n").vertices[1], Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(read("obj", vertices + "f 1/7/9 2//9 3/7\n").triangles.size(), 1u);
  EXPECT_EQ(read("obj", "f 1 2 3\n" + vertices).triangles.size(), 1u);  // used before it is named
  EXPECT_EQ(read("obj", vertices + "f 1 2 \\\n 3 4\n").triangles.size(), 2u);
  // A polygon comes by each vertex a few times at most.
  const auto face_of = [](int corners) {
    std::string text = "f";
    for (int i = 0; i < corners; ++i) text += ' ' + std::to_string(1 + i % 4);
    return text + '\n';
  };
  EXPECT_EQ(read("obj", vertices + face_of(19)).triangles.size(), 17u);
  EXPECT_TRUE(refused("obj", vertices + face_of(20), "a face of 20 corners, with 4 vertices"));
  EXPECT_TRUE(refused("obj", vertices + "f 1 2 5\n", "vertex 4 (from 0) of 4"));
  EXPECT_TRUE(refused("obj", vertices + "f 1 2 0\n", "vertex 0; the first one is 1"));
  EXPECT_TRUE(refused("obj", vertices + "f 1 2 -5\n", "vertex -1"));
  EXPECT_TRUE(refused("obj", vertices + "f 1 2 99999999999999999999\n", "not a whole number"));
  EXPECT_TRUE(refused("obj", vertices + "f 1 2 x\n", "line 5"));
  EXPECT_TRUE(refused("obj", vertices + "l 1 2\np 3\n", "no triangles"));
  EXPECT_TRUE(refused("obj", vertices, "no triangles"));
  EXPECT_TRUE(refused("obj", "v 0 0 nan\n" + vertices + "f 1 2 3\n", "finite"));
  EXPECT_TRUE(refused("obj", "v 0 0\n" + vertices + "f 1 2 3\n", "line"));
  EXPECT_TRUE(refused("obj", "v 0 0 1 0.5\n" + vertices + "f 1 2 3\n", "weight"));
  EXPECT_EQ(read("obj", "v 0 0 1 0.5 0.5 0.5\n" + vertices + "f 1 2 3\n").triangles.size(), 1u);
  EXPECT_TRUE(refused("obj", vertices + "surf 0 1 0 1 1 2 3\n", "not supported"));
}

// All patches and curves, those of old versions too, and what only sets how they are drawn.
TEST_F(Formats, ObjOfOtherThanPolygonsIsRefused) {
  const std::string good = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
  for (const std::string word : {"surf", "curv", "call", "bsp", "bzp", "cdc", "cdp", "res"}) {
    EXPECT_TRUE(
        refused("obj", good + word + " 1 2 3\n", "line 5: '" + word + "' is not supported"));
  }
}

// A backslash at the end of a line continues every statement, and no comment.
TEST_F(Formats, ObjLinesAreContinued) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const std::string face = "f 1 2 3\n";
  const auto count = [&](const std::string& text) {
    return read("obj", vertices + text).triangles.size();
  };
  EXPECT_EQ(count("g a \\\nf 1 3 4\n" + face), 1u);
  EXPECT_EQ(count("usemtl a\\\r\nf 1 3 4\\\nf 1 2 4\n" + face), 1u);
  EXPECT_EQ(count("# C:\\\nf 1 3 4\n" + face), 2u);
  EXPECT_EQ(count("g a # C:\\\nf 1 3 4\n" + face), 2u);
  EXPECT_EQ(count("g a\\b\nf 1 3 4\n" + face), 2u);
  EXPECT_EQ(count("f 1 3\\\n 4\n" + face), 2u);
  EXPECT_EQ(count("f 1 3\\\r\n\t4 \\\n\n" + face), 2u);
  EXPECT_TRUE(refused("obj", vertices + "f 1 2 3 \\", "not a whole number"));
  EXPECT_TRUE(refused("obj", vertices + "f 1 3\\\n4\n", "a word goes on in the next line"));
  EXPECT_TRUE(refused("obj", vertices + "f\\\n1 3 4\n" + face, "a word goes on"));
  // Other formats have no such thing.
  EXPECT_EQ(read("stl", test::text_stl(cube_, "C:\\")).triangles.size(), 12u);
  const std::string ply = test::ply_bytes(cube_, test::PlyForm::kText, false);
  EXPECT_EQ(read("ply", replaced(ply, "comment", "comment C:\\\ncomment")).triangles.size(), 12u);
  EXPECT_TRUE(refused("ply", replaced(ply, "vertex 8", "vertex \\\n8"), "not a whole number"));
}

TEST_F(Formats, TextStlWithAFacetInTheLineOfTheName) {
  const std::string good = test::text_stl(cube_, "x");
  for (const char* name : {"solid", "solid x", "solid a facet of x", "SOLID facet"}) {
    std::string joined = replaced(good, "solid x", name);
    EXPECT_EQ(read("stl", joined).triangles.size(), 12u) << name;
    joined.replace(joined.find('\n'), 1, " ");
    EXPECT_EQ(read("stl", joined).triangles.size(), 12u) << name;
  }
  std::string one_line = good;
  for (char& c : one_line) c = c == '\n' ? ' ' : c;
  EXPECT_EQ(read("stl", one_line).triangles.size(), 12u);
  EXPECT_TRUE(refused("stl", one_line + one_line, "a facet in the line of 'endsolid'"));
}

TEST_F(Formats, NumbersThatUnderflowAreNearlyZero) {
  const TriangleMesh mesh = read("obj", "v 0 1e-400 0\nv 1 0 0\nv 1 1 -2e-324\nf 1 2 3\n");
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3d::Zero());
  EXPECT_GT(mesh.vertex_error, 0.0);
  const TriangleMesh tiny = read("obj", "v 0 0 1e-400\nv 5e-324 0 0\nv 0 7e-324 0\nf 1 2 3\n");
  EXPECT_GE(tiny.vertex_error, 0x1p-1073);
  EXPECT_LT(tiny.vertex_error, 1e-300);
}

TEST_F(Formats, PolygonsAreDivided) {
  // A pentagon, and a dart, which a fan about its first corner would reach out of.
  const TriangleMesh pentagon =
      read("obj", "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n");
  EXPECT_EQ(pentagon.triangles.size(), 3u);
  EXPECT_DOUBLE_EQ(mesh_report(pentagon).area, 5.0);
  const TriangleMesh dart = read("off", "OFF 4 1 0\n2 0 0\n0 1 0\n1 0 0\n0 -1 0\n4 0 1 2 3\n");
  EXPECT_EQ(dart.triangles.size(), 2u);
  EXPECT_DOUBLE_EQ(mesh_report(dart).area, 1.0);
  const std::string many = [] {
    std::string text = "OFF\n40 1 0\n";
    for (int i = 0; i < 40; ++i) {
      text +=
          std::to_string(std::cos(0.157 * i)) + " " + std::to_string(std::sin(0.157 * i)) + " 0\n";
    }
    text += "40";
    for (int i = 0; i < 40; ++i) text.append(" ").append(std::to_string(i));
    return text + "\n";
  }();
  EXPECT_EQ(read("off", many).triangles.size(), 38u);
}

TEST_F(Formats, Off) {
  const std::string good = test::off_text(cube_);
  EXPECT_EQ(read("off", replaced(good, "OFF", "COFF")).triangles.size(), 12u);
  EXPECT_EQ(read("off", replaced(good, "3 0 2 3", "3 0 2 3 255 0 0")).triangles.size(), 12u);
  EXPECT_TRUE(refused("off", replaced(good, "3 0 2 3", "3 0 2 8"), "vertex 8 (from 0) of 8"));
  EXPECT_TRUE(refused("off", replaced(good, "3 0 2 3", "3 0 2 -1"), "vertex -1"));
  EXPECT_TRUE(refused("off", replaced(good, "8 12", "9 12"), "line"));
  EXPECT_TRUE(refused("off", replaced(good, "8 12", "8 11"), "more lines"));
  EXPECT_TRUE(refused("off", replaced(good, "8 12", "8 13"), "is missing"));
  EXPECT_TRUE(refused("off", replaced(good, "8 12", "8 1200000000"), "cannot hold"));
  EXPECT_TRUE(refused("off", replaced(good, "8 12", "-8 12"), "cannot hold"));
  EXPECT_TRUE(refused("off", replaced(good, "OFF", "OFF BINARY"), "whole number"));
  EXPECT_TRUE(refused("off", replaced(good, "OFF", "4OFF"), "not an OFF file"));
  EXPECT_TRUE(refused("off", "OFF\n2 1 0\n0 0 0\n1 1 1\n2 0 1\n", "no triangles"));
}

TEST_F(Formats, Ply) {
  const std::string good = test::ply_bytes(cube_, test::PlyForm::kText, false);
  EXPECT_EQ(read("ply", good).triangles.size(), 12u);
  EXPECT_TRUE(refused("ply", replaced(good, "3 0 2 3", "3 0 2 8"), "vertex 8 (from 0) of 8"));
  EXPECT_TRUE(refused("ply", replaced(good, "3 0 2 3", "3 0 2 -3"), "vertex -3"));
  EXPECT_TRUE(refused("ply", replaced(good, "3 0 2 3", "3 0 2 1.5"), "whole number"));
  EXPECT_TRUE(refused("ply", replaced(good, "3 0 2 3", "4000 0 2 3"), "length"));
  EXPECT_TRUE(refused("ply", replaced(good, "vertex 8", "vertex 9"), "line"));
  EXPECT_TRUE(refused("ply", replaced(good, "vertex 8", "vertex 999999999"), "cannot hold"));
  EXPECT_TRUE(refused("ply", replaced(good, "float y", "float w"), "lack one of x, y and z"));
  EXPECT_TRUE(refused("ply", replaced(good, "float y", "real y"), "not a type"));
  EXPECT_TRUE(refused("ply", replaced(good, "vertex_indices", "corners"), "lacks the list"));
  EXPECT_TRUE(refused("ply", replaced(good, "ascii", "utf8"), "not a PLY format"));
  EXPECT_TRUE(refused("ply", replaced(good, "end_header", "comment"), "header is broken"));
  EXPECT_TRUE(refused("ply", replaced(good, "element face 12", "element face 0"), "more data"));
  EXPECT_TRUE(refused("ply", replaced(good, "3 0 2 3", "3 0 2"), "face 0 has too few numbers"));
  EXPECT_TRUE(
      refused("ply", replaced(good, "3 0 2 3", "3 0 2 3 1"), "face 0 has too many numbers"));
  EXPECT_TRUE(refused("ply", replaced(good, "ascii 1.0", "ascii 1.1"), "version 1.0"));
  EXPECT_TRUE(refused("ply", replaced(good, "float y", "float x"), "'x' is there twice"));
  std::string properties = "float y";
  for (int i = 0; i < 1000; ++i) properties += "\nproperty float p" + std::to_string(i);
  EXPECT_TRUE(refused("ply", replaced(good, "float y", properties), "more than 1000 properties"));
  const std::string binary = test::ply_bytes(cube_, test::PlyForm::kLittleEndian, true);
  EXPECT_TRUE(refused("ply", binary.substr(0, binary.size() - 1), "cut short"));
  EXPECT_TRUE(refused("ply", binary + "x", "more data"));
  // A line ends as the first one does: data may begin with the byte of a line feed.
  const std::string header = binary.substr(0, binary.find("end_header\n") + 11);
  std::string first_is_ten = binary;
  first_is_ten[header.size()] = '\n';
  for (const std::string line_end : {"\n", "\r", "\r\n"}) {
    std::string bytes;
    for (const char c : header) c == '\n' ? bytes += line_end : bytes += c;
    bytes += first_is_ten.substr(header.size());
    EXPECT_EQ(read("ply", bytes).triangles.size(), 12u);
  }
  // A strip of four corners, a break, and one of three.
  const TriangleMesh strip = read(
      "ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty int x\nproperty int y\nproperty int z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 1 2\n");
  ASSERT_EQ(strip.triangles.size(), 3u);
  for (const Eigen::Vector3i& t : strip.triangles) {
    const auto at = [&](int k) { return strip.vertices[static_cast<std::size_t>(t[k])]; };
    EXPECT_EQ((at(1) - at(0)).cross(at(2) - at(0)).z(), 1.0);
  }
}

TEST_F(Formats, ThreeMf) {
  const std::string model = test::threemf_model(cube_, "1 0 0 0 1 0 0 0 1 10 20 30");
  for (const test::Zip form : {test::Zip::kStored, test::Zip::kDeflated64}) {
    const TriangleMesh mesh = read("3mf", test::threemf_bytes(model, form));
    EXPECT_EQ(mesh_report(mesh).box.min(), Eigen::Vector3d(10, 20, 30));
    EXPECT_TRUE(mesh_report(mesh).closed);
    EXPECT_EQ(mesh.triangles.size(), 12u);
  }
  const auto read_model = [&](const std::string& text) {
    return read("3mf", test::threemf_bytes(text));
  };
  const auto refused_model = [&](const std::string& from, const std::string& to,
                                 const std::string& reason) {
    return refused("3mf", test::threemf_bytes(replaced(model, from, to)), reason);
  };
  // Rows of the transform are the images of the axes: x goes to y.
  const TriangleMesh turned =
      read_model(replaced(model, "1 0 0 0 1 0 0 0 1 10 20 30", "0 2 0 -1 0 0 0 0 +3 0 0 1e1"));
  EXPECT_EQ(mesh_report(turned).box.min(), Eigen::Vector3d(-1, 0, 10));
  EXPECT_EQ(mesh_report(turned).box.max(), Eigen::Vector3d(0, 2, 13));
  EXPECT_GT(turned.vertex_error, 0.0);
  EXPECT_LT(turned.vertex_error, 1e-12);

  for (const char* target : {"3D/3dmodel.model", "./3D/3dmodel.model"}) {
    const std::string bytes = test::threemf_bytes(model, test::Zip::kStored, target);
    EXPECT_EQ(read("3mf", bytes).triangles.size(), 12u) << target;
  }
  // As XML Schema has numbers.
  const TriangleMesh schema = read_model(
      replaced(replaced(replaced(model, "v3=\"3\"", "v3=\" +3 \""), "z=\"1\"", "z=\"\t+1 \""),
               "objectid=\"1\"", "objectid=\"\n1\""));
  EXPECT_TRUE(mesh_report(schema).closed);
  EXPECT_EQ(mesh_report(schema).box.max(), Eigen::Vector3d(11, 21, 31));
  EXPECT_TRUE(refused_model("v3=\"3\"", "v3=\"+-3\"", "not a whole number"));
  EXPECT_TRUE(refused_model("v3=\"3\"", "v3=\" \"", "number is missing"));
  EXPECT_TRUE(refused_model("z=\"1\"", "z=\"1 1\"", "not a finite number"));
  EXPECT_TRUE(refused_model("v3=\"3\"", "v3=\"8\"", "vertex 8"));
  EXPECT_TRUE(refused_model("v3=\"3\"", "v3=\"-1\"", "vertex -1"));
  EXPECT_TRUE(refused_model("v3=\"3\"", "", "no attribute 'v3'"));
  EXPECT_TRUE(refused_model("z=\"1\"", "z=\"inf\"", "number"));
  EXPECT_TRUE(refused_model("z=\"1\"", "z=\"1e30\"", "beyond 1e15"));
  EXPECT_TRUE(refused_model("objectid=\"1\"", "objectid=\"9\"", "object 9"));
  EXPECT_TRUE(refused_model("1 10 20 30", "1 10 20", "number"));
  EXPECT_TRUE(refused_model("1 10 20 30", "1 10 20 30 40", "more than twelve"));
  EXPECT_TRUE(refused_model("1 10 20 30", "1 10 20 nan", "not a finite"));
  EXPECT_TRUE(refused_model("unit=", "requiredextensions=\"p\" unit=", "requires extensions"));
  EXPECT_TRUE(refused_model("<triangles>", "<beams/><triangles>", "shape"));
  EXPECT_TRUE(refused_model("<build>", "<build><", "line 1"));
  EXPECT_TRUE(refused_model("<model", "<!DOCTYPE m [<!ENTITY e \"x\">]><model", "document type"));
}

TEST_F(Formats, ThreeMfComponents) {
  const std::string model = test::threemf_model(cube_);
  const auto with_objects = [&](const std::string& objects, const std::string& shown) {
    return test::threemf_bytes(replaced(replaced(model, "</resources>", objects + "</resources>"),
                                        "<item objectid=\"1\"",
                                        "<item objectid=\"" + shown + "\""));
  };
  const auto object = [](const std::string& id, const std::vector<std::string>& parts) {
    std::string text = "<object id=\"" + id + "\"><components>";
    for (const std::string& part : parts) text += "<component objectid=\"" + part + "\"/>";
    return text + "</components></object>";
  };
  const std::string moved =
      "<object id=\"2\"><components><component objectid=\"1\"/><component objectid=\"1\" "
      "transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/></components></object>";
  const TriangleMesh twice = read("3mf", with_objects(moved, "2"));
  EXPECT_EQ(twice.triangles.size(), 24u);
  EXPECT_EQ(mesh_report(twice).box.max(), Eigen::Vector3d(6, 1, 1));
  EXPECT_EQ(read("3mf", with_objects(moved, "1")).triangles.size(), 12u);

  EXPECT_TRUE(refused("3mf", with_objects(object("2", {"2"}), "2"), "not there before"));
  EXPECT_TRUE(refused("3mf", with_objects(object("2", {"3"}) + object("3", {"2"}), "2"),
                      "not there before"));
  EXPECT_TRUE(refused("3mf", with_objects(object("1", {"1"}), "1"), "there twice"));
  std::string doubled, chain;
  for (int i = 2; i < 80; ++i) {
    const std::string before = std::to_string(i - 1);
    if (i < 40) doubled += object(std::to_string(i), {before, before});
    chain += object(std::to_string(i), {before});
  }
  EXPECT_TRUE(refused("3mf", with_objects(doubled, "39"), "more than 2^18 nodes"));
  EXPECT_EQ(read("3mf", with_objects(doubled, "3")).triangles.size(), 48u);
  EXPECT_TRUE(refused("3mf", with_objects(chain, "79"), "64 deep"));
}

// Every part of the archive that could mislead: sizes, offsets, checksums, names.
TEST_F(Formats, ThreeMfArchives) {
  const std::string model = test::threemf_model(cube_);
  const std::string good = test::threemf_bytes(model);
  EXPECT_TRUE(refused("3mf", "PK", "no end record"));
  EXPECT_TRUE(refused("3mf", good.substr(0, good.size() - 1), "no end record"));
  EXPECT_TRUE(refused("3mf", replaced(good, "v3=\"3\"", "v3=\"4\""), "checksum"));
  EXPECT_TRUE(refused("3mf", replaced(good, "PK\1\2", "PK\1\3"), "directory"));
  std::string renamed = good;
  for (std::size_t at; (at = renamed.find("3D/3dmodel.model")) != std::string::npos;) {
    renamed.replace(at, 4, "3d/4");
  }
  EXPECT_TRUE(refused("3mf", renamed, "checksum"));  // the relation was renamed as well
  const std::string packed = test::threemf_bytes(model, test::Zip::kDeflated64);
  // The uncompressed size of the last member, in its ZIP64 record of the directory.
  const std::size_t record = packed.rfind(std::string("\1\0\x10\0", 4));
  ASSERT_NE(record, std::string::npos);
  const auto with_size = [&](std::uint64_t size) {
    std::string bytes = packed;
    for (std::size_t i = 0; i < 8; ++i) bytes[record + 4 + i] = static_cast<char>(size >> 8 * i);
    return bytes;
  };
  EXPECT_EQ(read("3mf", with_size(model.size())).triangles.size(), 12u);
  EXPECT_TRUE(refused("3mf", with_size(model.size() - 1), "damaged"));
  EXPECT_TRUE(refused("3mf", with_size(model.size() + 1), "damaged"));
  EXPECT_TRUE(refused("3mf", with_size(std::uint64_t{1} << 29), "damaged"));
  EXPECT_TRUE(refused("3mf", with_size(~std::uint64_t{0}), "larger than 2^29"));
}

}  // namespace
}  // namespace spherule
