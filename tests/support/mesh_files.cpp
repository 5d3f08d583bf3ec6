// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/mesh_files.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <utility>
#include <vector>
#include <zlib.h>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

template <class Values>
std::string joined(const Values& values, const char* separator) {
  std::ostringstream out;
  out.precision(17);
  const char* before = "";
  for (const double value : values) {
    out << before << value;
    before = separator;
  }
  return out.str();
}

std::string number(double x) {
  return joined(std::array{x}, "");
}

std::string numbers(const Vector3d& v) {
  return joined(v, " ");
}

// The three corners, counted from `first`, after a word.
std::string corners(const char* word, const Eigen::Vector3i& t, int first = 0) {
  std::ostringstream out;
  out << word << " " << t[0] + first << " " << t[1] + first << " " << t[2] + first << "\n";
  return out.str();
}

template <class T>
void append(std::string& bytes, T value, bool big_endian = false) {
  std::array<char, sizeof(T)> image;
  std::memcpy(image.data(), &value, sizeof(T));
  if (big_endian) std::reverse(image.begin(), image.end());
  bytes.append(image.data(), image.size());
}

const Vector3d& corner(const TriangleMesh& mesh, const Eigen::Vector3i& t, int k) {
  return mesh.vertices[static_cast<std::size_t>(t[k])];
}

// Positions as floats, then indices as 32-bit numbers.
std::string buffer_of(const TriangleMesh& mesh) {
  std::string bytes;
  for (const Vector3d& v : mesh.vertices) {
    for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(v[k]));
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) append(bytes, static_cast<std::uint32_t>(t[k]));
  }
  return bytes;
}

std::string gltf_json(const TriangleMesh& mesh, const Vector3d& translation,
                      const std::string& uri) {
  Vector3d low = mesh.vertices.front(), high = low;
  for (const Vector3d& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const auto list = [](const Vector3d& v) { return "[" + joined(v, ",") + "]"; };
  const std::size_t positions = 12 * mesh.vertices.size(), indices = 12 * mesh.triangles.size();
  std::ostringstream out;
  out << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
      << R"("nodes":[{"children":[1],"translation":)" << list(translation)
      << R"(},{"mesh":0,"translation":)" << list(translation) << R"(}],)"
      << R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
      << R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)"
      << mesh.vertices.size() << R"(,"min":)" << list(low) << R"(,"max":)" << list(high)
      << R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)"
      << 3 * mesh.triangles.size() << R"(}],"bufferViews":[{"buffer":0,"byteOffset":0,)"
      << R"("byteLength":)" << positions << R"(},{"buffer":0,"byteOffset":)" << positions
      << R"(,"byteLength":)" << indices << R"(}],"buffers":[{"byteLength":)" << positions + indices
      << uri << "}]}";
  return out.str();
}

std::string deflated(const std::string& data) {
  std::string result(data.size() + data.size() / 8 + 64, '\0');
  z_stream stream{};
  constexpr int kRaw = -15, kMemory = 8;
  deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kRaw, kMemory, Z_DEFAULT_STRATEGY);
  std::string input = data;  // zlib takes its input as not constant
  stream.next_in = reinterpret_cast<Bytef*>(input.data());
  stream.avail_in = static_cast<uInt>(input.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

// A ZIP archive of these files, by name and content.
std::string zip(const std::vector<std::pair<std::string, std::string>>& files, Zip form) {
  const bool large = form == Zip::kDeflated64;
  std::string body, directory;
  for (const auto& [name, data] : files) {
    const std::string packed = large ? deflated(data) : data;
    const std::size_t offset = body.size();
    std::string common;  // what the local and the central header share
    for (const int word : {20, 0, large ? 8 : 0, 0, 33}) {
      append(common, static_cast<std::uint16_t>(word));
    }
    const uLong crc =
        crc32(0, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size()));
    append(common, static_cast<std::uint32_t>(crc));
    std::string extra;
    if (large) {
      common.append(8, '\xFF');
      append(extra, std::uint16_t{1});
      append(extra, std::uint16_t{16});
      append(extra, std::uint64_t{data.size()});
      append(extra, std::uint64_t{packed.size()});
    } else {
      append(common, static_cast<std::uint32_t>(packed.size()));
      append(common, static_cast<std::uint32_t>(data.size()));
    }
    append(common, static_cast<std::uint16_t>(name.size()));
    append(common, static_cast<std::uint16_t>(extra.size()));
    body += "PK\3\4" + common + name + extra + packed;
    directory += "PK\1\2";
    append(directory, std::uint16_t{20});
    directory += common + std::string(10, '\0');
    append(directory, static_cast<std::uint32_t>(offset));
    directory += name + extra;
  }
  std::string end;
  if (large) {
    end = "PK\6\6";
    append(end, std::uint64_t{44});
    end.append(12, '\0');
    for (const std::size_t word : {files.size(), files.size(), directory.size(), body.size()}) {
      append(end, std::uint64_t{word});
    }
    end += "PK\6\7" + std::string(4, '\0');
    append(end, std::uint64_t{body.size() + directory.size()});
    append(end, std::uint32_t{1});
    end += "PK\5\6" + std::string(4, '\0') + std::string(12, '\xFF');
  } else {
    end = "PK\5\6" + std::string(4, '\0');
    append(end, static_cast<std::uint16_t>(files.size()));
    append(end, static_cast<std::uint16_t>(files.size()));
    append(end, static_cast<std::uint32_t>(directory.size()));
    append(end, static_cast<std::uint32_t>(body.size()));
  }
  append(end, std::uint16_t{0});
  return body + directory + end;
}

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  return text.substr(begin, text.find(to) + to.size() - begin);
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

// One transform of a node.
std::string dae_transform(Random& random) {
  const Vector3d v = 3.0 * random.direction();
  switch (random.index(4)) {
    case 0:
      return "<translate>" + numbers(v) + "</translate>";
    case 1:
      return "<rotate>" + numbers(v.normalized()) + " " +
             std::to_string(random.between(-360.0, 360.0)) + "</rotate>";
    case 2:
      return "<scale>" + numbers(v.cwiseAbs() + Vector3d::Constant(0.5)) + "</scale>";
    default: {
      const Eigen::Matrix3d m = random.rotation().toRotationMatrix();
      std::string rows;
      for (int r = 0; r < 3; ++r) {
        rows += joined(Vector3d(m.row(r)), " ") + " " + std::to_string(v[r]) + " ";
      }
      return "<matrix>" + rows + "0 0 0 1</matrix>";
    }
  }
}

std::string dae_node(Random& random, int depth, bool may_refer) {
  std::string text = "<node>";
  for (std::size_t i = random.index(4); i > 0; --i) text += dae_transform(random);
  if (depth == 0 || random.index(2) == 0) text += "<instance_geometry url=\"#g\"/>";
  if (may_refer && random.index(3) == 0) text += "<instance_node url=\"#shared\"/>";
  for (std::size_t i = depth == 0 ? 0 : random.index(3); i > 0; --i) {
    text += dae_node(random, depth - 1, may_refer);
  }
  return text + "</node>";
}

}  // namespace

std::string text_stl(const TriangleMesh& mesh, const std::string& name) {
  std::string out = "solid " + name + "\n";
  for (const Eigen::Vector3i& t : mesh.triangles) {
    out += "facet normal 0 0 0\n outer loop\n";
    for (int k = 0; k < 3; ++k) out += "  vertex " + numbers(corner(mesh, t, k)) + "\n";
    out += " endloop\nendfacet\n";
  }
  return out + "endsolid " + name + "\n";
}

std::string binary_stl(const TriangleMesh& mesh, std::string_view header) {
  std::string bytes(header);
  bytes.resize(80, '\0');
  append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Eigen::Vector3i& t : mesh.triangles) {
    bytes.append(12, '\0');
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) append(bytes, static_cast<float>(corner(mesh, t, k)[i]));
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string obj_text(const TriangleMesh& mesh) {
  std::string out = "# cube\nmtllib absent.mtl\no part\n";
  for (const Vector3d& v : mesh.vertices) out += "v " + numbers(v) + "\n";
  for (const Eigen::Vector3i& t : mesh.triangles) {
    out += corners("f", t, 1);
  }
  return out;
}

std::string off_text(const TriangleMesh& mesh) {
  std::string out = "OFF\n# a comment\n" + std::to_string(mesh.vertices.size()) + " " +
                    std::to_string(mesh.triangles.size()) + " 0\n";
  for (const Vector3d& v : mesh.vertices) out += numbers(v) + "\n";
  for (const Eigen::Vector3i& t : mesh.triangles) {
    out += corners("3", t);
  }
  return out;
}

std::string ply_bytes(const TriangleMesh& mesh, PlyForm form, bool doubles) {
  const std::string type = doubles ? "double" : "float";
  const bool text = form == PlyForm::kText, big = form == PlyForm::kBigEndian;
  std::string out = "ply\nformat ";
  out += text ? "ascii" : big ? "binary_big_endian" : "binary_little_endian";
  out += " 1.0\ncomment made by a test\nelement vertex " + std::to_string(mesh.vertices.size()) +
         "\nproperty " + type + " x\nproperty " + type + " y\nproperty " + type +
         " z\nproperty uchar red\nelement face " + std::to_string(mesh.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vector3d& v : mesh.vertices) {
    if (text) {
      out += numbers(v) + " 7\n";
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      doubles ? append(out, v[k], big) : append(out, static_cast<float>(v[k]), big);
    }
    append(out, std::uint8_t{7});
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    if (text) {
      out += corners("3", t);
      continue;
    }
    append(out, std::uint8_t{3});
    for (int k = 0; k < 3; ++k) append(out, t[k], big);
  }
  return out;
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool padding = i + k > bytes.size();
      result += padding ? '=' : kDigits[word >> (18 - 6 * k) & 63];
    }
  }
  return result;
}

std::string dae_text(const TriangleMesh& mesh, const Eigen::Matrix4d& matrix,
                     const std::string& meter, const std::string& up) {
  std::ostringstream out;
  out.precision(17);
  out << R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="unit" meter=")"
      << meter << R"("/><up_axis>)" << up << R"(</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count=")"
      << 3 * mesh.vertices.size() << R"(">)";
  for (const Vector3d& v : mesh.vertices) out << numbers(v) << " ";
  out << R"(</float_array><technique_common><accessor source="#a" count=")" << mesh.vertices.size()
      << R"(" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>)"
      << R"(<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count=")"
      << mesh.triangles.size() << R"("><input semantic="VERTEX" source="#v" offset="0"/><p>)";
  for (const Eigen::Vector3i& t : mesh.triangles) out << t[0] << " " << t[1] << " " << t[2] << " ";
  out << R"(</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><matrix>)";
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) out << matrix(r, c) << " ";
  }
  out << R"(</matrix><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
  return out.str();
}

std::string gltf_text(const TriangleMesh& mesh, const Vector3d& translation) {
  const std::string uri =
      R"(,"uri":"data:application/octet-stream;base64,)" + base64(buffer_of(mesh)) + "\"";
  return gltf_json(mesh, translation, uri);
}

std::string glb_bytes(const TriangleMesh& mesh, const Vector3d& translation) {
  std::string json = gltf_json(mesh, translation, "");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string buffer = buffer_of(mesh);
  std::string bytes = "glTF";
  for (const std::size_t word : {std::size_t{2}, 28 + json.size() + buffer.size(), json.size()}) {
    append(bytes, static_cast<std::uint32_t>(word));
  }
  bytes += "JSON" + json;
  append(bytes, static_cast<std::uint32_t>(buffer.size()));
  bytes.append("BIN\0", 4);
  return bytes + buffer;
}

std::string threemf_bytes(const std::string& model, Zip form, const std::string& target) {
  return zip(
      {{"[Content_Types].xml",
        R"(<?xml version="1.0" encoding="UTF-8"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)"},
       {"_rels/.rels",
        R"(<?xml version="1.0" encoding="UTF-8"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target=")" +
            target +
            R"(" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)"},
       {"3D/3dmodel.model", model}},
      form);
}

std::string threemf_model(const TriangleMesh& mesh, const std::string& item_transform) {
  std::string out =
      R"(<?xml version="1.0" encoding="UTF-8"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources><object id="1" type="model"><mesh><vertices>)";
  for (const Vector3d& v : mesh.vertices) {
    out += "<vertex x=\"" + number(v.x()) + "\" y=\"" + number(v.y()) + "\" z=\"" + number(v.z()) +
           "\"/>";
  }
  out += "</vertices><triangles>";
  for (const Eigen::Vector3i& t : mesh.triangles) {
    out += "<triangle v1=\"" + std::to_string(t[0]) + "\" v2=\"" + std::to_string(t[1]) +
           "\" v3=\"" + std::to_string(t[2]) + "\"/>";
  }
  out += R"(</triangles></mesh></object></resources><build><item objectid="1")";
  if (!item_transform.empty()) out += " transform=\"" + item_transform + "\"";
  return out + "/></build></model>";
}

std::string random_dae(const TriangleMesh& mesh, Random& random) {
  std::string text = dae_text(mesh, Eigen::Matrix4d::Identity());
  std::string nodes;
  for (std::size_t i = 1 + random.index(2); i > 0; --i) nodes += dae_node(random, 3, true);
  text = with(text, between(text, "<node", "</node>"),
              nodes + "<node>" + dae_transform(random) + "<instance_geometry url=\"#g\"/></node>");
  std::string shared = dae_node(random, 2, false);
  shared.insert(5, " id=\"shared\"");
  text = with(text, "<library_visual_scenes>",
              "<library_nodes>" + shared + "</library_nodes><library_visual_scenes>");
  const std::string triangles = between(text, "<triangles", "</triangles>");
  const std::string input = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"1\"/>";
  std::string single, all, counts;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    // With an index of something else before each.
    const std::string corners = "7 " + std::to_string(t[0]) + " 5 " + std::to_string(t[1]) + " 0 " +
                                std::to_string(t[2]) + " ";
    single += "<p>" + corners + "</p>";
    all += corners;
    counts += "3 ";
  }
  switch (random.index(4)) {
    case 0:
      return with(text, triangles,
                  "<polygons count=\"" + std::to_string(mesh.triangles.size()) + "\">" + input +
                      single + "</polygons>");
    case 1:
      return with(text, triangles,
                  "<tristrips count=\"" + std::to_string(mesh.triangles.size()) + "\">" + input +
                      single + "</tristrips>");
    case 2:
      return with(text, triangles,
                  "<polylist count=\"" + std::to_string(mesh.triangles.size()) + "\">" + input +
                      "<vcount>" + counts + "</vcount><p>" + all + "</p></polylist>");
    default:
      return text;
  }
}

std::string random_gltf(const TriangleMesh& mesh, Random& random) {
  const std::size_t count = 2 + random.index(6);
  std::string nodes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d v = 3.0 * random.direction();
    const Eigen::Quaterniond q = random.rotation();
    std::string node = i == 0 ? "{" : ",{";
    if (random.index(2) == 0) {
      Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
      m.topLeftCorner<3, 3>() = q.toRotationMatrix();
      m.topRightCorner<3, 1>() = v;
      node += "\"matrix\":[" + joined(std::vector<double>(m.data(), m.data() + 16), ",") + "]";
    } else {
      node += "\"translation\":[" + joined(v, ",") + "],\"rotation\":[" +
              joined(Eigen::Vector4d(q.coeffs()), ",") + "],\"scale\":[" +
              joined(Vector3d(v.cwiseAbs() + Vector3d::Constant(0.5)), ",") + "]";
    }
    // A chain, in which some show the mesh.
    if (i + 1 < count) node += ",\"children\":[" + std::to_string(i + 1) + "]";
    if (i + 1 == count || random.index(2) == 0) node += ",\"mesh\":0";
    nodes += node + "}";
  }
  const std::string text = gltf_text(mesh, Vector3d::Zero());
  const std::size_t begin = text.find("\"nodes\":[{"), end = text.find(",\"meshes\"");
  return text.substr(0, begin) + "\"nodes\":[" + nodes + "]" + text.substr(end);
}

}  // namespace spherule::test
