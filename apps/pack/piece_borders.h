// The triangles along the borders of pieces of a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <unordered_set>
#include <vector>

#include "geometry/box.h"
#include "scenes/scene.h"

namespace delray::apps {

struct PlaceHash {
  std::size_t operator()(const glm::vec3& p) const;
};
using Places = std::unordered_set<glm::vec3, PlaceHash>;

// What other pieces need of one for the normals on their common border.
struct PieceBorder {
  geometry::Box3 box;                               // of the places on the border
  std::vector<std::array<glm::vec3, 3>> triangles;  // with a corner there, in order
};

// The places of a piece's vertices that other pieces have, too.
Places border_places(std::span<const glm::vec3> positions, std::span<const std::uint8_t> shared);

// The triangles of a piece that have a corner at one of them. O(triangles).
PieceBorder border_of(const scenes::Mesh& piece, const Places& places);

// Puts around the triangles of a piece those of others that have a corner at one of its border's
// places: of earlier pieces before its own, of later ones behind. Returns how many are before.
// O(pieces + triangles of neighbours' borders).
std::uint32_t add_neighbours(std::span<const PieceBorder> borders, std::size_t number,
                             const Places& places, scenes::Mesh& piece);

}  // namespace delray::apps
