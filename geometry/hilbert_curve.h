// The Hilbert curve through the cells of a cube.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace delray::geometry {

// One level of the Hilbert curve in a cube that is passed from corner `entry` along axis
// `direction` (C. Hamilton, Compact Hilbert Indices, 2006).
struct Turn {
  std::uint8_t place;  // of the octant along the curve, 0 .. 7
  std::uint8_t next;   // state inside the octant
};
using Turns = std::array<std::array<Turn, 8>, 24>;  // state: 8 * direction + entry

constexpr unsigned rotate_left3(unsigned x, unsigned by) {
  return ((x << by) | (x >> (3 - by))) & 7U;
}

constexpr Turns make_turns() {
  Turns turns = {};
  for (unsigned direction = 0; direction < 3; ++direction) {
    for (unsigned entry = 0; entry < 8; ++entry) {
      for (unsigned octant = 0; octant < 8; ++octant) {
        const unsigned axis = (direction + 1) % 3;
        const unsigned gray = rotate_left3(octant ^ entry, (3 - axis) % 3);
        const unsigned place = gray ^ (gray >> 1) ^ (gray >> 2);
        const unsigned before = place == 0 ? 0 : 2 * ((place - 1) / 2);
        const unsigned corner = place == 0 ? 0 : before ^ (before >> 1);
        const unsigned ones = place == 0 ? 0 : std::countr_one(place % 2 == 0 ? place - 1 : place);
        const unsigned next_entry = entry ^ rotate_left3(corner, axis);
        const unsigned next_direction = (direction + ones % 3 + 1) % 3;
        turns[8 * direction + entry][octant] = {
            static_cast<std::uint8_t>(place),
            static_cast<std::uint8_t>(8 * next_direction + next_entry)};
      }
    }
  }
  return turns;
}

inline constexpr Turns kTurns = make_turns();

// The place along the curve of a cell of the grid with 2^bits cells along each axis.
// REQUIRES: 3 bits <= 64.
inline std::uint64_t place_on_curve(const std::array<std::uint32_t, 3>& cell, int bits) {
  std::uint64_t place = 0;
  unsigned state = 0;
  for (int bit = bits - 1; bit >= 0; --bit) {
    const unsigned octant =
        (cell[0] >> bit & 1U) | (cell[1] >> bit & 1U) << 1 | (cell[2] >> bit & 1U) << 2;
    const Turn turn = kTurns[state][octant];
    place = place << 3 | turn.place;
    state = turn.next;
  }
  return place;
}

}  // namespace delray::geometry
