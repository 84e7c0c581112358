#include "scenes/internal/import.h"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include <cmath>
#include <exception>
#include <utility>

#include "files/read_file.h"
#include "image/srgb.h"
#include "scenes/internal/check_file.h"
#include "scenes/internal/mtl_material.h"
#include "scenes/internal/polygon.h"
#include "scenes/internal/weld.h"

namespace delray::scenes::internal {
namespace {

constexpr std::uint64_t kMostVertices = 0xFFFFFFFEU;

// Serves the scene file from memory and the files that it names, its materials, from its folder.
class SourceFiles final : public Assimp::IOSystem {
 public:
  SourceFiles(const Source& source, std::string main) : source_(source), main_(std::move(main)) {}

  bool Exists(const char* name) const override {
    std::error_code ignored;
    return name == main_ || std::filesystem::is_regular_file(name, ignored);
  }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* /*mode*/) override {
    if (name == main_) return serve(source_.content);
    try {
      // Parsers look a little ahead: after the end of the file there is an empty line.
      return serve(files::read_file(name) + "\n\n");
    } catch (const files::FileError& e) {
      missing_.push_back(e.what());
      return nullptr;
    }
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

  const std::vector<std::string>& missing() const { return missing_; }

 private:
  static Assimp::IOStream* serve(std::string_view content) {
    auto* copy = new std::uint8_t[content.size()];
    content.copy(reinterpret_cast<char*>(copy), content.size());
    return new Assimp::MemoryIOStream(copy, content.size(), true);
  }

  const Source& source_;
  std::string main_;
  std::vector<std::string> missing_;
};

glm::vec3 vector_of(const aiVector3D& v) { return {v.x, v.y, v.z}; }

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// What the checks of the formats have seen already, after Assimp has had it in its hands.
void check_meshes(const Source& source, const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    if (mesh.mMaterialIndex >= scene.mNumMaterials) source.fail("", "a material is missing");
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const glm::vec3 p = vector_of(mesh.mVertices[i]);
      if (!finite(p)) source.fail("vertex " + std::to_string(i), "a coordinate is not finite");
      if (glm::any(glm::greaterThan(glm::abs(p), glm::vec3(kLargestCoordinate)))) {
        source.fail("vertex " + std::to_string(i), "a coordinate is larger than 1e18");
      }
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k) {
        if (mesh.mFaces[f].mIndices[k] >= mesh.mNumVertices) {
          source.fail("face " + std::to_string(f), "there is no such vertex");
        }
      }
    }
  }
}

const aiScene& read(const Source& source, const std::string& name, Assimp::Importer& importer) {
  const auto refuse = [&](const std::string& why) {
    source.fail("", why.empty() ? "the file cannot be read" : why);
  };
  const aiScene* scene = nullptr;
  try {
    scene = importer.ReadFile(name, 0);
    if (scene) check_meshes(source, *scene);
  } catch (const files::FileError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    refuse(e.what());
  }
  if (!scene || !scene->mRootNode) refuse(importer.GetErrorString());
  return *scene;
}

// Programs that write colours of vertices write what they show: sRGB.
float linear(float value) {
  const float code = value * 255.0F;
  const float nearest = std::round(code);
  if (!(code > 0)) return 0;
  if (code >= 255) return 1;
  if (std::abs(code - nearest) < 1e-3F)
    return image::decode_srgb(static_cast<std::uint8_t>(nearest));
  return image::decode_srgb_value(value);
}

void copy_normals(const aiMesh& from, Mesh& mesh) {
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    const glm::vec3 n = vector_of(from.mNormals[i]);
    const float length = glm::length(n);
    if (!(length > 1e-6F) || !std::isfinite(length)) return mesh.normals.clear();
    mesh.normals.push_back(n / length);
  }
}

void copy_attributes(const aiMesh& from, bool keep_normals, Mesh& mesh) {
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    mesh.positions.push_back(vector_of(from.mVertices[i]));
  }
  if (keep_normals && from.HasNormals()) copy_normals(from, mesh);
  if (from.HasTextureCoords(0)) {
    for (unsigned i = 0; i < from.mNumVertices; ++i) {
      const aiVector3D& uv = from.mTextureCoords[0][i];
      const bool usable = std::isfinite(uv.x) && std::isfinite(uv.y);
      // Assimp's v grows upwards.
      mesh.uvs.push_back(usable ? glm::vec2(uv.x, 1.0F - uv.y) : glm::vec2(0));
    }
  }
  if (from.HasVertexColors(0)) {
    for (unsigned i = 0; i < from.mNumVertices; ++i) {
      const aiColor4D& c = from.mColors[0][i];
      const float alpha = std::isfinite(c.a) ? std::clamp(c.a, 0.0F, 1.0F) : 1.0F;
      mesh.colours.emplace_back(linear(c.r), linear(c.g), linear(c.b), alpha);
    }
  }
}

struct Dropped {
  std::uint64_t lines_and_points = 0;
};

Mesh convert(const aiMesh& from, const ImportRules& rules, Dropped& dropped) {
  Mesh mesh;
  mesh.name = from.mName.C_Str();
  mesh.material = from.mMaterialIndex;
  copy_attributes(from, rules.keep_normals, mesh);
  mesh.triangles.reserve(from.mNumFaces);
  for (unsigned f = 0; f < from.mNumFaces; ++f) {
    const aiFace& face = from.mFaces[f];
    if (face.mNumIndices < 3) ++dropped.lines_and_points;
    triangulate_polygon({face.mIndices, face.mNumIndices}, mesh.positions, mesh.triangles);
  }
  if (!rules.keep_vertices) weld(mesh);
  return mesh;
}

glm::dmat4 matrix_of(const aiMatrix4x4& m) {
  return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2,
          m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

void add_instances(const aiNode& node, const glm::dmat4& parent,
                   const std::vector<std::uint32_t>& mesh_numbers, Scene& scene) {
  const glm::dmat4 world = parent * matrix_of(node.mTransformation);
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const std::uint32_t mesh = mesh_numbers[node.mMeshes[i]];
    if (mesh != kNone) scene.instances.push_back({mesh, glm::mat4x3(glm::dmat4x3(world))});
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    add_instances(*node.mChildren[i], world, mesh_numbers, scene);
  }
}

}  // namespace

Scene import(const Source& source, const ImportRules& rules) {
  // The suffix decides how Assimp reads a file, and ours may be wrong or missing.
  const std::string name =
      (source.path.parent_path() / source.path.stem()).string() + "." + rules.suffix;
  Assimp::Importer importer;
  auto* source_files = new SourceFiles(source, name);
  importer.SetIOHandler(source_files);  // takes ownership
  const aiScene& from = read(source, name, importer);
  for (const std::string& what : source_files->missing()) source.warn(what);

  Scene scene;
  TextureFiles textures(source, scene.textures);
  for (unsigned m = 0; m < from.mNumMaterials; ++m) {
    scene.materials.push_back(mtl_material(*from.mMaterials[m], textures));
  }
  Dropped dropped;
  std::vector<std::uint32_t> mesh_numbers(from.mNumMeshes, kNone);
  for (unsigned m = 0; m < from.mNumMeshes; ++m) {
    if (from.mMeshes[m]->mNumVertices > kMostVertices) source.fail("", "a mesh is too large");
    Mesh mesh = convert(*from.mMeshes[m], rules, dropped);
    if (mesh.triangles.empty()) continue;
    mesh_numbers[m] = static_cast<std::uint32_t>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
  }
  add_instances(*from.mRootNode, glm::dmat4(1.0), mesh_numbers, scene);
  if (dropped.lines_and_points > 0) {
    source.warn(std::to_string(dropped.lines_and_points) + " points and lines left out");
  }
  return scene;
}

}  // namespace delray::scenes::internal
