// How far two surfaces are apart.
#pragma once

#include "scenes/scene.h"

namespace delray::packs::internal {

// The largest distance of a place on either mesh to the nearest one on the other, in either
// direction: measured from corners, middles of edges and of triangles. Attributes count as further
// dimensions: where normals, colours or texture coordinates there differ by 1, that is as far as
// `attribute_scale`. O(n log n) for meshes that are much alike. The meshes have the same
// attributes.
float surface_error(const scenes::Mesh& a, const scenes::Mesh& b, float attribute_scale);

// The mean length of a mesh's edges.
float mean_edge(const scenes::Mesh& mesh);

}  // namespace delray::packs::internal
