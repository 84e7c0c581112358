// Meshes that bend.
#pragma once

#include <span>

#include "scenes/scene.h"

namespace delray::scenes::internal {

// Positions, normals and tangents of `mesh` by weights of its morph targets and, where it has a
// skin, by the transforms of its joints from the mesh to the world (glTF 2.0, 3.7.2.2 and 3.7.3.3).
// The nearer a vertex's transform is to flat, the less its normal means; one that vanishes is (0,
// 0, 1). Parallel; O(vertices * (targets with a weight + influences) + triangles).
//
// False if a coordinate is not finite or larger than 1e18; the mesh is then partly bent.
//
// REQUIRES: as many weights as targets and joints as the skin has; `mesh` has the vertices that
// `deformed` is of.
bool deform(const DeformedMesh& deformed, std::span<const double> weights,
            std::span<const glm::dmat4> joints, Mesh& mesh);

// What a mesh needs that its file does not have.
struct Completion {
  float crease_cosine = 0.5F;  // compute_normals
  int tangents_of_set = -1;    // compute_tangents; -1: none are needed
};

// Makes a mesh that is ready for it: what its vertices are without weights and joints. Where it has
// no normals they are computed, here and in every pose; that and tangents may split vertices.
//
// REQUIRES: the deformation has elements for the vertices of the mesh.
DeformedMesh make_deformed(Mesh& mesh, Deformation&& deformation, const Completion& completion);

}  // namespace delray::scenes::internal
