// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/io/internal/scene_file.h"

#include "mesh/io/internal/mesh_readers.h"
#include "mesh/io/internal/placed_part.h"
#include "spheretree/error.h"

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <sstream>
#include <vector>

namespace spherule::internal {
namespace {

constexpr double kFloatRoundoff = 0x1p-24;
// The entries of a node matrix, relative to its norm: decimals, the sine and cosine of a rotation,
// and the product of the few elementary transforms a node may list.
constexpr double kTransformError = 16.0 * kFloatRoundoff;

// Opens the file itself, and for glTF the buffers in its folder or below; nothing else.
class ConfinedIo : public Assimp::DefaultIOSystem {
 public:
  ConfinedIo(const std::filesystem::path& file, bool with_buffers)
      : file_(std::filesystem::weakly_canonical(file)), with_buffers_(with_buffers) {}

  bool Exists(const char* name) const override { return allowed(name); }
  Assimp::IOStream* Open(const char* name, const char* mode = "rb") override {
    return allowed(name) ? DefaultIOSystem::Open(name, mode) : nullptr;
  }

 private:
  bool allowed(const char* name) const {
    std::error_code error;
    const std::filesystem::path path = std::filesystem::weakly_canonical(name, error);
    if (error || !std::filesystem::is_regular_file(path, error)) return false;
    if (path == file_) return true;
    const auto relative = path.lexically_relative(file_.parent_path());
    return with_buffers_ && !relative.empty() && *relative.begin() != "..";
  }

  std::filesystem::path file_;
  bool with_buffers_;
};

// Leaves only the importer of the extension, so that no other parser sees the file. glTF 1 shares
// its extensions with glTF 2 and is told apart by its name.
void keep_importer(Assimp::Importer& importer, const std::string& extension) {
  std::vector<Assimp::BaseImporter*> others;
  for (std::size_t i = 0; i < importer.GetImporterCount(); ++i) {
    const aiImporterDesc& info = *importer.GetImporterInfo(i);
    std::istringstream extensions(info.mFileExtensions);
    bool keep = false;
    for (std::string word; extensions >> word;) keep |= word == extension;
    keep &= std::string_view(info.mName).find("glTF Importer") == std::string_view::npos;
    if (!keep) others.push_back(importer.GetImporter(i));
  }
  for (Assimp::BaseImporter* other : others) {
    const std::unique_ptr<Assimp::BaseImporter> owner(other);  // it is given back to us
    importer.UnregisterLoader(other);
  }
}

Affine to_affine(const aiMatrix4x4& m, const std::string& subject) {
  Affine result;
  result.linear << m.a1, m.a2, m.a3, m.b1, m.b2, m.b3, m.c1, m.c2, m.c3;
  result.offset << m.a4, m.b4, m.c4;
  if (!result.linear.allFinite() || !result.offset.allFinite() || m.d1 != 0 || m.d2 != 0 ||
      m.d3 != 0 || m.d4 != 1) {
    throw Error(subject, "a node transform that is not affine and finite");
  }
  return result;
}

class SceneReader {
 public:
  SceneReader(const aiScene& scene, double coordinate_error, const std::string& subject)
      : scene_(scene), coordinate_error_(coordinate_error), subject_(subject) {}

  TriangleMesh run() {
    visit(*scene_.mRootNode);
    return std::move(result_);
  }

 private:
  void visit(const aiNode& node) {
    // Exactly: IsIdentity() of assimp has a tolerance.
    const bool moves = node.mTransformation != aiMatrix4x4();
    if (moves) chain_.push_back(to_affine(node.mTransformation, subject_));
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      if (node.mMeshes[i] >= scene_.mNumMeshes) throw Error(subject_, "a node shows no mesh");
      add(*scene_.mMeshes[node.mMeshes[i]]);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i]);
    if (moves) chain_.pop_back();
  }

  void add(const aiMesh& mesh) {
    TriangleMesh part;
    part.vertices.reserve(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& v = mesh.mVertices[i];
      part.vertices.emplace_back(v.x, v.y, v.z);
    }
    std::vector<std::int64_t> corners;
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      corners.assign(face.mIndices, face.mIndices + face.mNumIndices);
      add_polygon(part, corners, part.vertices.size(), subject_);
    }
    if (part.triangles.empty()) return;
    place(part, chain_, coordinate_error_, kTransformError);
    append(result_, part, subject_);
  }

  const aiScene& scene_;
  double coordinate_error_;
  const std::string& subject_;
  std::vector<Affine> chain_;
  TriangleMesh result_;
};

std::size_t count_faces(const aiScene& scene) {
  std::size_t count = 0;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    count += static_cast<std::size_t>(
        std::count_if(mesh.mFaces, mesh.mFaces + mesh.mNumFaces,
                      [](const aiFace& face) { return face.mNumIndices >= 3; }));
  }
  return count;
}

}  // namespace

TriangleMesh read_scene(const std::filesystem::path& path, std::string_view bytes,
                        const std::string& extension) {
  const std::string subject = path.string();
  const bool gltf = extension == "gltf" || extension == "glb";
  const std::size_t expected = gltf ? check_gltf(bytes, subject) : 0;
  try {
    if (extension == "dae") check_collada(bytes, subject);
    Assimp::Importer importer;
    keep_importer(importer, extension);
    importer.SetIOHandler(new ConfinedIo(path, gltf));  // the importer owns it
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    // Without this, a file that has bones and no mesh would show the bones as triangles.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    // No post-processing: those steps move, join and drop vertices.
    const aiScene* scene = importer.ReadFile(subject, 0);
    if (scene == nullptr || scene->mRootNode == nullptr) {
      throw Error(subject, std::string("not a mesh: ") + importer.GetErrorString());
    }
    if (gltf && count_faces(*scene) != expected) {
      throw Error(subject, "a corner of a triangle is out of range");
    }
    return SceneReader(*scene, gltf ? 0.0 : kDecimalError, subject).run();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& fault) {
    throw Error(subject, std::string("not a mesh: ") + fault.what());
  }
}

}  // namespace spherule::internal
