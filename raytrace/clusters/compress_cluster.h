// Clusters in fewer bytes, for their way to other ranks.
#pragma once

#include <cstddef>
#include <span>

#include "comm/buffer.h"
#include "raytrace/clusters/cluster.h"

namespace delray::raytrace {

// What pack() gives, as planes of bytes of differences, compressed by LZ4 (Wald et al. 2001 pack
// voxels before they send them). Exact.
comm::Buffer compress(const ClusterData& cluster);

// Throws comm::BadMessage for what compress() does not give. Memory: some hundred times the message
// at most.
ClusterData decompress_cluster(std::span<const std::byte> message);

}  // namespace delray::raytrace
