// Meshes of glTF.
#pragma once

#include <span>
#include <vector>

#include "scenes/gltf/gltf_document.h"
#include "scenes/gltf/gltf_material.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// A primitive, and how its vertices move.
struct GltfPrimitive {
  Mesh mesh;
  Deformation deformation;
};

// The primitives of meshes[number], each as a mesh of its own; strips, loops and fans are taken
// apart. Points are 3 pixels wide and lines 1.5, as the file does not say. Vertices that no
// triangle of the primitive uses are left out. A primitive without a material has material kNone.
// Texture coordinates are what the material's textures use; that a primitive does not have them is
// told once for each material, unless TEXCOORD_0 is all that it asks for. Joints are read where
// there is a skin, weights of a vertex sum up to 1.
std::vector<GltfPrimitive> read_mesh(const GltfDocument& document, std::size_t number,
                                     std::span<GltfMaterial> materials, bool has_skin);

// Whether a primitive is triangles of which runs can be read, and their vertices: with indices, as
// the file has them, and all the texture coordinates that its material asks for.
bool has_runs(const GltfDocument& document, const JsonView& primitive,
              const GltfMaterial& material);
// Vertices [first, last) of such a primitive, directions not yet normalized. REQUIRES: there are so
// many; has_runs.
Mesh read_vertices(const GltfDocument& document, const JsonView& primitive,
                   const GltfMaterial& material, std::uint64_t first, std::uint64_t last);

}  // namespace delray::scenes::internal
