// The plan of an insertion: which thread inserts which points, in which order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

namespace delray::delaunay {

struct Plan {
  std::vector<std::uint32_t> points;  // the numbers of all points, part after part
  std::vector<std::size_t> begins;    // part i is [begins[i], begins[i + 1]); one more than parts

  std::size_t parts() const { return begins.size() - 1; }
};

// Assigns the points to `parts` parts whose sizes differ by at most one. `split` is one of those of
// splits() in methods.h (Kohout 2004, 7.8.7):
// - random: any points;
// - slabs: by x, so that parts are strips;
// - distance: by the distance from the origin, so that parts are rings;
// - curve: intervals of a Hilbert curve.
// Within a part points are in the order called `order`, see insertion_order(), each part from
// another place along the curve. O(n log n).
//
// Throws std::invalid_argument for other names, and for no parts. REQUIRES: finite coordinates.
Plan make_plan(std::span<const glm::dvec2> points, std::size_t parts, std::string_view split,
               std::string_view order, std::uint64_t seed, std::size_t threads = 1);
Plan make_plan(std::span<const glm::dvec3> points, std::size_t parts, std::string_view split,
               std::string_view order, std::uint64_t seed, std::size_t threads = 1);

}  // namespace delray::delaunay
