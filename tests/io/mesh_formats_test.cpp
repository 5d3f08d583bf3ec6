// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "geometry/triangle_mesh.h"
#include "io/mesh_io.h"
#include "tests/io/read_files.h"
#include "tests/support/mesh_files.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace spherule::test {
namespace {

// Largest distance of corresponding corners; the triangles must be in the same order.
double largest_shift(const TriangleMesh& a, const TriangleMesh& b) {
  double worst = a.triangles.size() == b.triangles.size() ? 0.0 : INFINITY;
  for (std::size_t i = 0; i < std::min(a.triangles.size(), b.triangles.size()); ++i) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = a.vertices[static_cast<std::size_t>(a.triangles[i][k])];
      const Eigen::Vector3d& q = b.vertices[static_cast<std::size_t>(b.triangles[i][k])];
      worst = std::max(worst, (p - q).norm());
    }
  }
  return worst;
}

TriangleMesh ugly_numbers() {
  TriangleMesh mesh = icosphere(2);
  Random random(11);
  for (Eigen::Vector3d& v : mesh.vertices) v = 123.456789 * v + random.direction();
  return mesh;
}

// Through memory, because g++ 12 at -O2 may turn double(float(x)) in a loop into x.
TriangleMesh rounded_to_float(TriangleMesh mesh) {
  for (Eigen::Vector3d& v : mesh.vertices) {
    for (double& x : v) {
      const volatile float rounded = static_cast<float>(x);
      x = rounded;
    }
  }
  return mesh;
}

using Formats = ReadFiles;

TEST_F(Formats, WhatIsNoFileOrNoMesh) {
  EXPECT_TRUE(refused(dir_.path() / "absent.stl", "no such file"));
  EXPECT_TRUE(refused(dir_.path(), "is a directory"));
  EXPECT_TRUE(refused("/dev/null", "not a regular file"));
  EXPECT_TRUE(refused(dir_.write("part", "solid"), "not a mesh format"));
  EXPECT_TRUE(refused("stl", "", "empty"));
  EXPECT_TRUE(refused("step", "ISO-10303-21;", "a CAD file, not a mesh"));
  EXPECT_TRUE(refused("txt", "solid", "not a mesh format"));
  for (const char* extension : {"stl", "obj", "ply", "off", "dae", "3mf", "gltf", "glb"}) {
    for (const std::string& bytes :
         {std::string("hello"), std::string("\0\1\2\3", 4), std::string(500, 'x'),
          std::string(500, '\0'), std::string("<a/>"), std::string("{}")}) {
      EXPECT_NE(error(extension, bytes), "") << extension;
    }
  }
}

TEST_F(Formats, BadScale) {
  const auto path = dir_.write("cube.stl", text_stl(cube_));
  for (const double scale : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(refused(path, "must be a positive", scale)) << scale;
  }
  EXPECT_TRUE(refused(path, "beyond 1e15", 1e16));
  EXPECT_NO_THROW(read_mesh(path, {.scale = 1e15}));
}

TEST(ReadMesh, BinaryFormatsAreExact) {
  const TempDir dir;
  const TriangleMesh mesh = rounded_to_float(ugly_numbers());
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  for (const auto& path :
       {dir.write("a.stl", binary_stl(mesh)),
        dir.write("solid.STL", binary_stl(mesh, "solid like text")),
        dir.write("l.ply", ply_bytes(mesh, PlyForm::kLittleEndian, false)),
        dir.write("b.ply", ply_bytes(mesh, PlyForm::kBigEndian, false)),
        dir.write("a.glb", glb_bytes(mesh, zero)), dir.write("a.gltf", gltf_text(mesh, zero))}) {
    const TriangleMesh read = read_mesh(path);
    EXPECT_EQ(read.vertex_error, 0.0) << path;
    EXPECT_EQ(largest_shift(mesh, read), 0.0) << path;
    EXPECT_EQ(read.vertices.size(), mesh.vertices.size()) << path;
  }
  const TriangleMesh doubles = ugly_numbers();
  const auto path = dir.write("d.ply", ply_bytes(doubles, PlyForm::kBigEndian, true));
  EXPECT_EQ(largest_shift(doubles, read_mesh(path)), 0.0);
}

TEST(ReadMesh, TextFormatsReadTheNearestDouble) {
  const TempDir dir;
  const TriangleMesh mesh = ugly_numbers();  // written with 17 digits
  for (const auto& path : {dir.write("a.stl", text_stl(mesh)), dir.write("a.obj", obj_text(mesh)),
                           dir.write("a.off", off_text(mesh)),
                           dir.write("a.ply", ply_bytes(mesh, PlyForm::kText, true))}) {
    const TriangleMesh read = read_mesh(path);
    EXPECT_EQ(largest_shift(mesh, read), 0.0) << path;
    EXPECT_GT(read.vertex_error, 0.0) << path;
    EXPECT_LT(read.vertex_error, 1e-13) << path;
  }
}

TEST(ReadMesh, ErrorBoundHoldsUnderTransformsAndScale) {
  const TempDir dir;
  const TriangleMesh mesh = ugly_numbers();
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    Eigen::Isometry3d motion(random.rotation());
    motion.translation() = 1000.0 * random.direction();
    Eigen::Affine3d map(motion);
    map.scale(random.between(0.1, 10.0));
    const double scale = random.between(0.001, 1000.0);

    const auto dae = dir.write("a.dae", dae_text(mesh, map.matrix(), "0.0254"));
    TriangleMesh expected = mesh;
    for (Eigen::Vector3d& v : expected.vertices) v = scale * (0.0254 * (map * v));
    const TriangleMesh read = read_mesh(dae, {.scale = scale});
    const double shift = largest_shift(expected, read);
    EXPECT_GT(shift, 0.0);
    EXPECT_LE(shift, read.vertex_error);
    EXPECT_LE(read.vertex_error, 1e-5 * scale * 0.0254 * (1000.0 + 10.0 * 130.0));

    const auto glb = dir.write("a.glb", glb_bytes(mesh, motion.translation()));
    expected = rounded_to_float(mesh);
    for (Eigen::Vector3d& v : expected.vertices) v = scale * (v + 2.0 * motion.translation());
    const TriangleMesh read_glb = read_mesh(glb, {.scale = scale});
    EXPECT_LE(largest_shift(expected, read_glb), read_glb.vertex_error);
  }
}

TEST(ReadMesh, ScaleErrorIsCharged) {
  const TempDir dir;
  const TriangleMesh mesh = rounded_to_float(ugly_numbers());
  const auto path = dir.write("a.stl", binary_stl(mesh));
  const TriangleMesh read = read_mesh(path, {.scale = 1000.0});
  EXPECT_GT(read.vertex_error, 0.0);
  EXPECT_LT(read.vertex_error, 1e-9);
  EXPECT_LT((mesh_report(read).box.sizes() - 1000.0 * mesh_report(mesh).box.sizes()).norm(), 1e-9);
}

TEST(ReadMesh, ColladaKeepsItsAxesAndComesInMetres) {
  const TempDir dir;
  const TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 2, 4});
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"}) {
    const auto path = dir.write("a.dae", dae_text(mesh, Eigen::Matrix4d::Identity(), "0.5", up));
    const MeshReport report = mesh_report(read_mesh(path));
    EXPECT_EQ(report.box.max(), Eigen::Vector3d(0.5, 1, 2)) << up;
    EXPECT_TRUE(report.closed);
  }
}

TEST(ReadMesh, EqualVerticesAreJoinedOthersAreNot) {
  const TempDir dir;
  const auto path = dir.write("a.stl", text_stl(cube_mesh()));
  EXPECT_EQ(read_mesh(path).vertices.size(), 8u);
  TriangleMesh cracked = cube_mesh();
  cracked.vertices.push_back(cracked.vertices[0] + Eigen::Vector3d(1e-15, 0, 0));
  cracked.triangles[0][0] = 8;
  EXPECT_EQ(read_mesh(dir.write("b.obj", obj_text(cracked))).vertices.size(), 9u);
}

TEST(ReadMesh, KeepsWhatIsUnusualAsDoesWriteStl) {
  const TempDir dir;
  for (const NamedMesh& entry : mesh_zoo()) {
    const auto path = dir.write("a.off", off_text(entry.mesh));
    EXPECT_EQ(largest_shift(entry.mesh, read_mesh(path)), 0.0) << entry.name;
    write_stl(entry.mesh, dir.path() / "out.stl");
    const TriangleMesh written = read_mesh(dir.path() / "out.stl");
    EXPECT_EQ(largest_shift(rounded_to_float(entry.mesh), written), 0.0) << entry.name;
  }
}

TEST(WriteStl, RefusesBadInputAndLeavesNoFile) {
  const TempDir dir;
  TriangleMesh mesh = cube_mesh();
  EXPECT_THROW(write_stl(mesh, dir.path() / "absent" / "a.stl"), Error);
  mesh.vertices[3].x() = std::nan("");
  EXPECT_THROW(write_stl(mesh, dir.path() / "a.stl"), Error);
  EXPECT_THROW(write_stl(TriangleMesh(), dir.path() / "a.stl"), Error);
  EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
}

// What each format can hold, and what is wrong with broken files.

TEST_F(Formats, BinaryStlOfWrongSize) {
  const std::string good = binary_stl(cube_);
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
  EXPECT_TRUE(refused("stl", binary_stl(cube_, "solid x").substr(0, 600), "12 triangles"));
}

TEST_F(Formats, BinaryStlWithBadNumbers) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f}) {
    std::string bytes = binary_stl(cube_);
    std::memcpy(bytes.data() + 84 + 12 + 50 * 3, &bad, sizeof bad);
    EXPECT_TRUE(refused("stl", bytes, bad == 1e30f ? "beyond 1e15" : "not finite"));
    // The normal is not used.
    bytes = binary_stl(cube_);
    std::memcpy(bytes.data() + 84, &bad, sizeof bad);
    EXPECT_EQ(error("stl", bytes), "");
  }
}

TEST_F(Formats, TextStl) {
  const std::string good = text_stl(cube_, "several words of a name");
  const std::string two =
      good + text_stl(moved(cube_, Eigen::Isometry3d(Eigen::Translation3d(3, 0, 0))));
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
  expect_refused("stl", good,
                 {{"vertex 0", "vertex 1e20", "beyond 1e15"},
                  {"vertex 0", "vertex 100000000000000000000", "beyond 1e15"},
                  {"  vertex 0 0 0\n", "", "fewer than three"},
                  {"endfacet", "", "'endfacet' expected"}});
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
  EXPECT_EQ(read("stl", text_stl(cube_, "C:\\")).triangles.size(), 12u);
  const std::string ply = ply_bytes(cube_, PlyForm::kText, false);
  EXPECT_EQ(read("ply", replaced(ply, "comment", "comment C:\\\ncomment")).triangles.size(), 12u);
  expect_refused("ply", ply, {{"vertex 8", "vertex \\\n8", "not a whole number"}});
}

TEST_F(Formats, TextStlWithAFacetInTheLineOfTheName) {
  const std::string good = text_stl(cube_, "x");
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
  const std::string good = off_text(cube_);
  EXPECT_EQ(read("off", replaced(good, "OFF", "COFF")).triangles.size(), 12u);
  EXPECT_EQ(read("off", replaced(good, "3 0 2 3", "3 0 2 3 255 0 0")).triangles.size(), 12u);
  expect_refused("off", good,
                 {{"3 0 2 3", "3 0 2 8", "vertex 8 (from 0) of 8"},
                  {"3 0 2 3", "3 0 2 -1", "vertex -1"},
                  {"8 12", "9 12", "line"},
                  {"8 12", "8 11", "more lines"},
                  {"8 12", "8 13", "is missing"},
                  {"8 12", "8 1200000000", "cannot hold"},
                  {"8 12", "-8 12", "cannot hold"},
                  {"OFF", "OFF BINARY", "whole number"},
                  {"OFF", "4OFF", "not an OFF file"}});
  EXPECT_TRUE(refused("off", "OFF\n2 1 0\n0 0 0\n1 1 1\n2 0 1\n", "no triangles"));
}

TEST_F(Formats, Ply) {
  const std::string good = ply_bytes(cube_, PlyForm::kText, false);
  EXPECT_EQ(read("ply", good).triangles.size(), 12u);
  expect_refused("ply", good,
                 {{"3 0 2 3", "3 0 2 8", "vertex 8 (from 0) of 8"},
                  {"3 0 2 3", "3 0 2 -3", "vertex -3"},
                  {"3 0 2 3", "3 0 2 1.5", "whole number"},
                  {"3 0 2 3", "4000 0 2 3", "whole number from 0 to 255"},
                  {"vertex 8", "vertex 9", "line"},
                  {"vertex 8", "vertex 999999999", "cannot hold"},
                  {"float y", "float w", "lack one of x, y and z"},
                  {"float y", "real y", "not a type"},
                  {"vertex_indices", "corners", "lacks the list"},
                  {"ascii", "utf8", "not a PLY format"},
                  {"end_header", "comment", "header is broken"},
                  {"element face 12", "element face 0", "more data"},
                  {"3 0 2 3", "3 0 2", "face 0 has too few numbers"},
                  {"3 0 2 3", "3 0 2 3 1", "face 0 has too many numbers"},
                  {"ascii 1.0", "ascii 1.1", "version 1.0"},
                  {"float y", "float x", "'x' is there twice"}});
  std::string properties = "float y";
  for (int i = 0; i < 1000; ++i) properties += "\nproperty float p" + std::to_string(i);
  EXPECT_TRUE(refused("ply", replaced(good, "float y", properties), "more than 1000 properties"));
  const std::string binary = ply_bytes(cube_, PlyForm::kLittleEndian, true);
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

// Colours, normals and texture coordinates; what is used is read strictly.
TEST_F(Formats, NumbersThatAreNotUsedMayBeAnything) {
  const auto triangles = [&](const std::string& extension, const std::string& bytes) {
    return read(extension, bytes).triangles.size();
  };
  const std::string obj =
      "v 0 0 0 nan -nan inf\nv 1 0 0 1e999 x 0 1\nv 0 1 0\nvn nan nan nan\nvt inf\nf 1/1/1 2 "
      "3//1\n";
  EXPECT_EQ(triangles("obj", obj), 1U);
  EXPECT_TRUE(refused("obj", replaced(obj, "v 0 0 0", "v 0 0 nan"), "not a finite number"));
  EXPECT_TRUE(refused("obj", replaced(obj, "v 0 1 0", "v 0 1 0 nan"), "not a finite number"));
  EXPECT_TRUE(refused("obj", replaced(obj, "v 0 1 0", "v 0 1 0 2"), "a weight other than 1"));
  const std::string off =
      "CNOFF\n3 1 0\n0 0 0 nan nan nan inf 0 0 1\n1 0 0 nan\n0 1 0\n"
      "3 0 1 2 nan nan nan\n";
  EXPECT_EQ(triangles("off", off), 1U);
  EXPECT_TRUE(refused("off", replaced(off, "1 0 0 nan", "nan 0 0 1"), "not a finite number"));
  const std::string stl =
      "solid\nfacet normal nan inf -nan\nouter loop\nvertex 0 0 0\n"
      "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
  EXPECT_EQ(triangles("stl", stl), 1U);
  EXPECT_TRUE(refused("stl", replaced(stl, "1 0 0", "1 nan 0"), "not a finite number"));
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty short x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty float nx\nelement face 1\n"
      "property list uchar int vertex_indices\nproperty list uchar float texcoord\n"
      "element camera 1\nproperty float view\nend_header\n"
      "0 0 0 300 nan\n1 0 0 -1 inf\n0 1 0 1.5 1e999\n3 0 1 2 2 nan inf\nnan\n";
  EXPECT_EQ(triangles("ply", ply), 1U);
  EXPECT_TRUE(refused("ply", replaced(ply, "0 0 0 300", "0 nan 0 300"), "not a finite number"));
  EXPECT_TRUE(refused("ply", replaced(ply, "0 0 0 300", "40000 0 0 300"),
                      "line 15: '40000' is not a whole number from -32768 to 32767"));
  EXPECT_TRUE(refused("ply", replaced(ply, "0 0 0 300", "0.5 0 0 300"), "is not a whole number"));
  EXPECT_TRUE(refused("ply", replaced(ply, "3 0 1 2", "300 0 1 2"),
                      "'300' is not a whole number from 0 to 255"));
  EXPECT_TRUE(refused("ply", replaced(ply, "2 nan inf", "2 nan"), "too few numbers"));
}

TEST_F(Formats, ThreeMf) {
  const std::string model = threemf_model(cube_, "1 0 0 0 1 0 0 0 1 10 20 30");
  for (const Zip form : {Zip::kStored, Zip::kDeflated64}) {
    const TriangleMesh mesh = read("3mf", threemf_bytes(model, form));
    EXPECT_EQ(mesh_report(mesh).box.min(), Eigen::Vector3d(10, 20, 30));
    EXPECT_TRUE(mesh_report(mesh).closed);
    EXPECT_EQ(mesh.triangles.size(), 12u);
  }
  const auto threemf_of = [](const std::string& text) { return threemf_bytes(text); };
  const auto read_model = [&](const std::string& text) { return read("3mf", threemf_of(text)); };
  // Rows of the transform are the images of the axes: x goes to y.
  const TriangleMesh turned =
      read_model(replaced(model, "1 0 0 0 1 0 0 0 1 10 20 30", "0 2 0 -1 0 0 0 0 +3 0 0 1e1"));
  EXPECT_EQ(mesh_report(turned).box.min(), Eigen::Vector3d(-1, 0, 10));
  EXPECT_EQ(mesh_report(turned).box.max(), Eigen::Vector3d(0, 2, 13));
  EXPECT_GT(turned.vertex_error, 0.0);
  EXPECT_LT(turned.vertex_error, 1e-12);

  for (const char* target : {"3D/3dmodel.model", "./3D/3dmodel.model"}) {
    const std::string bytes = threemf_bytes(model, Zip::kStored, target);
    EXPECT_EQ(read("3mf", bytes).triangles.size(), 12u) << target;
  }
  // As XML Schema has numbers.
  const TriangleMesh schema = read_model(
      replaced(replaced(replaced(model, "v3=\"3\"", "v3=\" +3 \""), "z=\"1\"", "z=\"\t+1 \""),
               "objectid=\"1\"", "objectid=\"\n1\""));
  EXPECT_TRUE(mesh_report(schema).closed);
  EXPECT_EQ(mesh_report(schema).box.max(), Eigen::Vector3d(11, 21, 31));
  expect_refused("3mf", model,
                 {{"v3=\"3\"", "v3=\"+-3\"", "not a whole number"},
                  {"v3=\"3\"", "v3=\" \"", "number is missing"},
                  {"z=\"1\"", "z=\"1 1\"", "not a finite number"},
                  {"v3=\"3\"", "v3=\"8\"", "vertex 8"},
                  {"v3=\"3\"", "v3=\"-1\"", "vertex -1"},
                  {"v3=\"3\"", "", "no attribute 'v3'"},
                  {"z=\"1\"", "z=\"inf\"", "number"},
                  {"z=\"1\"", "z=\"1e30\"", "beyond 1e15"},
                  {"objectid=\"1\"", "objectid=\"9\"", "object 9"},
                  {"1 10 20 30", "1 10 20", "number"},
                  {"1 10 20 30", "1 10 20 30 40", "more than twelve"},
                  {"1 10 20 30", "1 10 20 nan", "not a finite"},
                  {"unit=", "requiredextensions=\"p\" unit=", "requires extensions"},
                  {"<triangles>", "<beams/><triangles>", "shape"},
                  {"<build>", "<build><", "line 1"},
                  {"<model", "<!DOCTYPE m [<!ENTITY e \"x\">]><model", "document type"}},
                 threemf_of);
}

TEST_F(Formats, ThreeMfComponents) {
  const std::string model = threemf_model(cube_);
  const auto with_objects = [&](const std::string& objects, const std::string& shown) {
    return threemf_bytes(replaced(replaced(model, "</resources>", objects + "</resources>"),
                                  "<item objectid=\"1\"", "<item objectid=\"" + shown + "\""));
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
  const std::string model = threemf_model(cube_);
  const std::string good = threemf_bytes(model);
  EXPECT_TRUE(refused("3mf", "PK", "no end record"));
  EXPECT_TRUE(refused("3mf", good.substr(0, good.size() - 1), "no end record"));
  expect_refused("3mf", good,
                 {{"v3=\"3\"", "v3=\"4\"", "checksum"}, {"PK\1\2", "PK\1\3", "directory"}});
  std::string renamed = good;
  for (std::size_t at; (at = renamed.find("3D/3dmodel.model")) != std::string::npos;) {
    renamed.replace(at, 4, "3d/4");
  }
  EXPECT_TRUE(refused("3mf", renamed, "checksum"));  // the relation was renamed as well
  const std::string packed = threemf_bytes(model, Zip::kDeflated64);
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
}  // namespace spherule::test
