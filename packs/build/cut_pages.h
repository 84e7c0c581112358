// Runs of a mesh's triangles as pages.
#pragma once

#include <span>
#include <vector>

#include "packs/page.h"

namespace delray::packs::internal {

// Pages of triangles [begin, end) of the mesh, in their order: each has as many as its clusters, of
// so many triangles and vertices at most, can hold. O(end - begin). Runs in the calling thread.
//
// REQUIRES: indices are in range.
std::vector<Page> cut_pages(const scenes::Mesh& mesh, std::uint32_t begin, std::uint32_t end);

// The box of a page's vertices, and a cone around the normals of all its triangles.
geometry::Box3 box_of(const Page& page);
NormalCone cone_of(const Page& page);

}  // namespace delray::packs::internal
