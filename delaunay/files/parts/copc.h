// Cloud-optimised point clouds: a LAZ file whose chunks are the nodes of an octree.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "delaunay/files/las_header.h"
#include "delaunay/files/laz/laz_file.h"
#include "delaunay/point_filter.h"

namespace delray::delaunay {

// The octree that a file says its chunks are (COPC 1.0, https://copc.io).
struct CopcOctree {
  glm::dvec3 centre{0};
  double half_size = 0, spacing = 0;  // of the root: its cube, the distance between its points
  std::uint64_t root_begin = 0, root_size = 0;  // of the page of nodes that begins with the root
};

// None if the file is no COPC. Throws FileError (input) for numbers that cannot be.
std::optional<CopcOctree> parse_copc(const ByteSource& source, const LasHeader& header);

// Of `chunks`, in their order, those of nodes that may have points that the filter wants: whose
// cubes touch the bounds, and whose parents' points are further apart than the resolution. Reads
// the pages of such nodes only. Throws FileError (input) for pages that are not in the file, more
// nodes than chunks and nodes that are no chunk. O(nodes read + chunks).
std::vector<laz::Chunk> wanted_chunks(const ByteSource& source, const CopcOctree& octree,
                                      std::vector<laz::Chunk> chunks, const PointFilter& filter);

}  // namespace delray::delaunay
