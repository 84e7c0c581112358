// The triangulations that four points can have.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace delray::delaunay::internal {

// Points 0 to 3 and 4, the vertex at infinity, in 6 simplices: triangles first, then the ghosts of
// the hull's edges, as HullMesh wants them.
struct FourPoints {
  bool exists = false;
  // Corner k of simplex t is at 3 t + k; neighbours are numbered 4 t + k.
  std::array<std::uint8_t, 18> vertices{}, neighbours{};
  // The ghost of the edge that starts at a point; 0 if the point is within the hull.
  std::array<std::uint8_t, 4> ghosts{};
};

namespace four_points {

// Bit i of `turns` says that the points but for number 3 - i turn left in ascending order.
constexpr int turn(unsigned turns, unsigned a, unsigned b, unsigned c) {
  const bool left = (turns >> (a + b + c - 3) & 1) != 0;
  const bool odd = (a > b) != ((a > c) != (b > c));
  return left != odd ? 1 : -1;
}

constexpr FourPoints make(unsigned turns, bool inside) {
  FourPoints result;
  std::array<std::array<std::uint8_t, 3>, 6> simplices{};
  std::size_t count = 0;
  std::array<std::uint8_t, 4> hull{};
  std::size_t hull_size = 0;
  const auto add = [&](unsigned a, unsigned b, unsigned c) {
    simplices[count++] = {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b),
                          static_cast<std::uint8_t>(c)};
  };
  // One point within the triangle of the others?
  for (unsigned m = 0; m < 4 && hull_size == 0; ++m) {
    const unsigned a = m == 0 ? 1 : 0;
    unsigned b = m <= 1 ? 2 : 1, c = m == 3 ? 2 : 3;
    if (turn(turns, a, b, c) < 0) {
      const unsigned other = b;
      b = c, c = other;
    }
    if (turn(turns, a, b, m) < 0 || turn(turns, b, c, m) < 0 || turn(turns, c, a, m) < 0) continue;
    add(a, b, m), add(b, c, m), add(c, a, m);
    hull = {simplices[0][0], simplices[1][0], simplices[2][0]};
    hull_size = 3;
  }
  // Convex?
  for (unsigned a = 1; a < 4 && hull_size == 0; ++a) {
    for (unsigned b = 1; b < 4; ++b) {
      if (a == b) continue;
      const unsigned c = 6 - a - b;
      if (turn(turns, 0, a, b) < 0 || turn(turns, a, b, c) < 0 || turn(turns, b, c, 0) < 0 ||
          turn(turns, c, 0, a) < 0) {
        continue;
      }
      // The triangle 0, 1, 2 belongs to the diagonal from 0 to b, or to the other if b is 3.
      if ((b != 3) == !inside) {
        add(0, a, b), add(0, b, c);
      } else {
        add(0, a, c), add(a, b, c);
      }
      hull = {0, static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b),
              static_cast<std::uint8_t>(c)};
      hull_size = 4;
      break;
    }
  }
  if (hull_size == 0) return result;
  result.exists = true;
  for (std::size_t i = 0; i < hull_size; ++i) {
    result.ghosts[hull[i]] = static_cast<std::uint8_t>(count);
    add(hull[(i + 1) % hull_size], hull[i], 4);
  }
  for (unsigned t = 0; t < 6; ++t) {
    for (unsigned k = 0; k < 3; ++k) {
      result.vertices[3 * t + k] = simplices[t][k];
      for (unsigned other = 0; other < 18; ++other) {
        const auto& mate = simplices[other / 3];
        const unsigned i = other % 3;
        if (mate[(i + 1) % 3] == simplices[t][(k + 2) % 3] &&
            mate[(i + 2) % 3] == simplices[t][(k + 1) % 3]) {
          result.neighbours[3 * t + k] = static_cast<std::uint8_t>(4 * (other / 3) + i);
        }
      }
    }
  }
  return result;
}

constexpr std::array<FourPoints, 32> make_all() {
  std::array<FourPoints, 32> all;
  for (unsigned i = 0; i < 32; ++i) all[i] = make(i & 15, (i & 16) != 0);
  return all;
}

}  // namespace four_points

// Bits 0 to 3: whether the points 0 1 2, 0 1 3, 0 2 3 and 1 2 3 turn left. Bit 4: whether point 3
// is in the circle of the others. Some combinations do not exist.
inline constexpr std::array<FourPoints, 32> kFourPoints = four_points::make_all();

}  // namespace delray::delaunay::internal
