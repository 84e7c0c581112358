// Groups of primitives as messages.
#pragma once

#include <deque>
#include <span>
#include <vector>

#include "comm/buffer.h"
#include "raster/pipeline/draws.h"

namespace delray::raster {

// Pieces that came from other ranks, and the meshes that they consist of. Addresses stay valid.
struct Arrivals {
  std::deque<scenes::Mesh> meshes;
  std::deque<glm::mat4x3> transforms;
  std::vector<Piece> pieces;
};

// The pieces with the vertices that they use, renumbered: everything that rendering them needs but
// materials, textures and lights. O(triangles).
comm::Buffer pack_geometry(std::span<const Piece> pieces);
// Appends what pack_geometry put in.
void unpack_geometry(const comm::Buffer& message, Arrivals& arrivals);

// Numbers only: the receiver has the scene. `first_primitives` as in pieces_of.
comm::Buffer pack_numbers(std::span<const Piece> pieces);
void unpack_numbers(const comm::Buffer& message, const scenes::Scene& scene,
                    std::span<const std::uint64_t> first_primitives, Arrivals& arrivals);

}  // namespace delray::raster
