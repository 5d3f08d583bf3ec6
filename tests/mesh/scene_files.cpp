// SPDX-License-Identifier: BSD-3-Clause
#include "tests/mesh/scene_files.h"

#include "tests/mesh/mesh_files.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <cstring>
#include <sstream>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  return text.substr(begin, text.find(to) + to.size() - begin);
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

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

std::string spaced(const Vector3d& v) {
  return joined(v, " ");
}

// Accessors over one buffer.
class GltfBuffer {
 public:
  // Returns the number of the accessor.
  template <class T>
  int add(const std::vector<T>& values, int components, const char* type, int component_type) {
    const std::size_t at = bytes_.size();
    for (const T value : values) {
      char image[sizeof(T)];
      std::memcpy(image, &value, sizeof(T));
      bytes_.append(image, sizeof(T));
    }
    const std::string before = count_ == 0 ? "" : ",";
    views_ += before + R"({"buffer":0,"byteOffset":)" + std::to_string(at) + R"(,"byteLength":)" +
              std::to_string(bytes_.size() - at) + "}";
    accessors_ += before + R"({"bufferView":)" + std::to_string(count_) + R"(,"componentType":)" +
                  std::to_string(component_type) + R"(,"type":")" + type + R"(","count":)" +
                  std::to_string(values.size() / static_cast<std::size_t>(components)) + "}";
    return count_++;
  }

  int add_vectors(const std::vector<Vector3d>& vectors) {
    std::vector<float> values;
    for (const Vector3d& v : vectors) {
      for (const double x : v) values.push_back(static_cast<float>(x));
    }
    return add(values, 3, "VEC3", 5126);
  }

  int add_indices(const TriangleMesh& mesh) {
    std::vector<std::uint16_t> values;
    for (const Eigen::Vector3i& t : mesh.triangles) {
      for (const int corner : t) values.push_back(static_cast<std::uint16_t>(corner));
    }
    return add(values, 1, "SCALAR", 5123);
  }

  // The whole file.
  std::string file(const std::string& content) const {
    return R"({"asset":{"version":"2.0"},"scene":0,)" + content + R"(,"accessors":[)" + accessors_ +
           R"(],"bufferViews":[)" + views_ + R"(],"buffers":[{"byteLength":)" +
           std::to_string(bytes_.size()) + R"(,"uri":"data:application/octet-stream;base64,)" +
           base64(bytes_) + R"("}]})";
  }

 private:
  std::string bytes_, views_, accessors_;
  int count_ = 0;
};

// One transform of a node.
std::string dae_transform(Random& random) {
  const Vector3d v = 3.0 * random.direction();
  switch (random.index(4)) {
    case 0:
      return "<translate>" + spaced(v) + "</translate>";
    case 1:
      return "<rotate>" + spaced(v.normalized()) + " " +
             std::to_string(random.between(-360.0, 360.0)) + "</rotate>";
    case 2:
      return "<scale>" + spaced(v.cwiseAbs() + Vector3d::Constant(0.5)) + "</scale>";
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

std::string skinned_dae(const TriangleMesh& mesh) {
  const std::string count = std::to_string(mesh.vertices.size());
  std::string ones, zeros;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    ones += i == 0 ? "1" : " 1";
    zeros += i == 0 ? "0 0" : " 0 0";
  }
  const std::string controller =
      R"(<library_controllers><controller id="c"><skin source="#g"><bind_shape_matrix>1 0 0 50 )"
      R"(0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix><source id="js"><Name_array id="ja" count="1">)"
      R"(J</Name_array></source><source id="bs"><float_array id="ba" count="16">1 0 0 0 0 1 0 0 )"
      R"(0 0 1 0 0 0 0 1</float_array><technique_common><accessor source="#ba" count="1" )"
      R"(stride="16"><param name="TRANSFORM" type="float4x4"/></accessor></technique_common>)"
      R"(</source><source id="ws"><float_array id="wa" count="1">1</float_array>)"
      R"(<technique_common><accessor source="#wa" count="1"><param name="WEIGHT" type="float"/>)"
      R"(</accessor></technique_common></source><joints><input semantic="JOINT" source="#js"/>)"
      R"(<input semantic="INV_BIND_MATRIX" source="#bs"/></joints><vertex_weights count=")" +
      count +
      R"("><input semantic="JOINT" source="#js" offset="0"/><input semantic="WEIGHT" )"
      R"(source="#ws" offset="1"/><vcount>)" +
      ones + "</vcount><v>" + zeros +
      "</v></vertex_weights></skin></controller></library_controllers><library_visual_scenes>";
  const std::string plain = dae_text(mesh, Eigen::Matrix4d::Identity());
  const std::string node =
      R"(<node id="J" sid="J" type="JOINT"><translate>0 0 7</translate></node><node id="n">)"
      R"(<instance_controller url="#c"><skeleton>#J</skeleton></instance_controller></node>)";
  return with(with(plain, between(plain, "<node", "</node>"), node), "<library_visual_scenes>",
              controller);
}

std::string skinned_gltf(const TriangleMesh& mesh) {
  GltfBuffer buffer;
  buffer.add_vectors(mesh.vertices);
  buffer.add_indices(mesh);
  buffer.add(std::vector<std::uint8_t>(4 * mesh.vertices.size(), 0), 4, "VEC4", 5121);
  std::vector<float> weights(4 * mesh.vertices.size(), 0.0F);
  for (std::size_t i = 0; i < weights.size(); i += 4) weights[i] = 1.0F;
  buffer.add(weights, 4, "VEC4", 5126);
  return buffer.file(
      R"("scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"skin":0,"translation":[7,7,7]},)"
      R"({"translation":[100,0,0]}],"skins":[{"joints":[1]}],"meshes":[{"primitives":[)"
      R"({"attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3},"indices":1}]}])");
}

std::string morphed_gltf(const TriangleMesh& mesh) {
  GltfBuffer buffer;
  buffer.add_vectors(mesh.vertices);
  buffer.add_indices(mesh);
  buffer.add_vectors(std::vector<Vector3d>(mesh.vertices.size(), Vector3d(50, 0, 0)));
  return buffer.file(
      R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[)"
      R"({"attributes":{"POSITION":0},"indices":1,"targets":[{"POSITION":2}]}],"weights":[1.0]}])");
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
  GltfBuffer buffer;
  buffer.add_vectors(mesh.vertices);
  buffer.add_indices(mesh);
  const std::size_t count = 2 + random.index(6);
  std::string nodes, below;
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
  return buffer.file(R"("scenes":[{"nodes":[0]}],"nodes":[)" + nodes + R"(],"meshes":[{)" +
                     R"("primitives":[{"attributes":{"POSITION":0},"indices":1}]}])");
}

}  // namespace spherule::test
