// A cluster of a draw's mesh whose vertices have been transformed, and the corners of its
// triangles.
#pragma once

#include <cstddef>
#include <cstdint>

#include "raster/pipeline/prepared_draw.h"

namespace delray::raster {

// Everything that triangles of a cluster are set up or bounded from.
struct ClusterOnScreen {
  const Screen& screen;
  const PreparedDraw& draw;
  const ClusterBlock& block;  // of the draw's mesh
  const MeshCluster& cluster;
  const ScreenVertices& vertices;  // the cluster's
};

// A triangle of a cluster: numbers of its corners within the cluster.
struct LocalCorners {
  std::uint32_t a, b, c;
};
inline LocalCorners corners_at(const ClusterBlock& block, const MeshCluster& cluster,
                               std::uint32_t place) {
  const std::uint8_t* corners = block.corners.data() + cluster.first_corner + place;
  const std::uint32_t stride = cluster.corner_stride();
  return {corners[0], corners[stride], corners[std::size_t{2} * stride]};
}

}  // namespace delray::raster
