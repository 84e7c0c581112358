// Normals and tangents for meshes that come without.
#pragma once

#include "scenes/scene.h"

namespace delray::scenes::internal {

// Gives `mesh` unit normals: at every corner the sum of the area vectors of the triangles that are
// connected to it around the vertex across edges where the surface bends by an angle whose cosine
// is at least `crease_cosine`. Vertices of equal position count as one, so seams of texture
// coordinates and unindexed triangles come out smooth; a vertex on a crease is split, its copies
// are appended. Triangles without area take part in no sum; a vertex with no other triangle gets
// (0, 0, 1). O(vertices + triangles) but for vertices of very many triangles, which cost n log n;
// parallel. Sums are in double precision and in an order of their own: the same on every machine,
// for every thread count and for every order of the triangles.
void compute_normals(Mesh& mesh, float crease_cosine);

// Gives `mesh` tangents along growing u of its uvs_of(set), orthogonal to the normals; a vertex
// whose triangles disagree on the handedness of u and v is split. Triangles without area in texture
// space take part in no sum; a vertex with no other triangle gets any tangent.
//
// REQUIRES: normals and uvs_of(set) have one value per vertex.
void compute_tangents(Mesh& mesh, int set);

}  // namespace delray::scenes::internal
