// Small point sets in space that break triangulations, made anew from every seed.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace delray::delaunay {

struct HardPoints3d {
  std::string name;
  std::function<glm::dvec3(std::mt19937_64&)> point;

  std::vector<glm::dvec3> make(std::size_t n, std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::vector<glm::dvec3> points(n);
    for (auto& p : points) p = point(random);
    return points;
  }
};

inline std::vector<HardPoints3d> hard_points_3d() {
  using Random = std::mt19937_64;
  using Vector = glm::dvec3;
  const auto unit = [](Random& r) { return std::uniform_real_distribution<>(0, 1)(r); };
  const auto integer = [](Random& r, int n) {
    return static_cast<double>(r() % static_cast<unsigned>(n));
  };
  const auto any = [=](Random& r) {
    const double x = unit(r), y = unit(r);
    return Vector(x, y, unit(r));
  };
  const auto cell = [=](Random& r, int n) {
    const double x = integer(r, n), y = integer(r, n);
    return Vector(x, y, integer(r, n));
  };
  const auto near_half = [](Random& r) {
    double x = 0.5;
    for (auto steps = r() % 4; steps > 0; --steps) x = std::nextafter(x, 1.0);
    return x;
  };
  constexpr double kTiny = std::numeric_limits<double>::denorm_min();
  constexpr double kLargest = std::numeric_limits<double>::max();
  return {
      {"uniform", any},
      {"equal", [](Random&) { return Vector(0.1, 0.7, 0.3); }},
      {"duplicates, -0", [=](Random& r) { return (cell(r, 3) - 1.0) * -0.0 + cell(r, 2) * -1.0; }},
      {"on a line", [=](Random& r) { return integer(r, 99) * Vector(1, 3, -2) + 1.0; }},
      {"on a line but for some",
       [=](Random& r) {
         const double x = integer(r, 30);
         return Vector(x, x, x + (r() % 5 == 0 ? 1.0 + integer(r, 3) : 0.0)) +
                Vector(0, r() % 5 == 0 ? 1 : 0, 0);
       }},
      {"in a plane",
       [=](Random& r) {
         const double x = integer(r, 9), y = integer(r, 9);
         return Vector(x, y, x + 2 * y);
       }},
      {"in a plane but for some",
       [=](Random& r) {
         const double x = integer(r, 6), y = integer(r, 6);
         return Vector(x, y, r() % 8 == 0 ? 1 + integer(r, 2) : 0);
       }},
      {"in two planes",
       [=](Random& r) {
         const double x = integer(r, 5), y = integer(r, 5);
         return Vector(x, y, integer(r, 2));
       }},
      {"lattice", [=](Random& r) { return cell(r, 4); }},
      {"lattice of tenths", [=](Random& r) { return 0.1 * cell(r, 4); }},
      {"lattice far away", [=](Random& r) { return Vector(4e6, 7e5, 3) + 0.5 * cell(r, 4); }},
      {"wide lattice", [=](Random& r) { return 1e5 * cell(r, 4) + cell(r, 2); }},
      {"exactly on a sphere",
       [=](Random& r) {
         // 9^2 = 1 + 16 + 64 = 16 + 16 + 49
         const double legs[3][3] = {{1, 4, 8}, {4, 4, 7}, {0, 0, 9}};
         const auto* leg = legs[r() % 3];
         const auto turn = r() % 3;
         const auto sign = [&] { return r() % 2 == 0 ? 1.0 : -1.0; };
         const double x = sign(), y = sign();
         return Vector(x * leg[turn], y * leg[(turn + 1) % 3], sign() * leg[(turn + 2) % 3]);
       }},
      {"near a sphere", [=](Random& r) { return glm::normalize(any(r) - 0.5); }},
      {"one ulp off",
       [=](Random& r) {
         const double x = near_half(r), y = near_half(r);
         return Vector(x, y, near_half(r));
       }},
      {"two lines",
       [=](Random& r) {
         const double x = integer(r, 20);
         return r() % 2 == 0 ? Vector(x, 0, 0) : Vector(0, x, 1);
       }},
      {"paraboloid",
       [=](Random& r) {
         const double x = integer(r, 9) - 4, y = integer(r, 9) - 4;
         return Vector(x, y, x * x + y * y);
       }},
      {"1e9", [=](Random& r) { return 1e9 * any(r); }},
      {"1e-9", [=](Random& r) { return 1e-9 * any(r) * Vector(1, 1, 0.1); }},
      {"1e300", [=](Random& r) { return 1e300 * (cell(r, 3) - 0.5); }},
      {"largest", [=](Random& r) { return kLargest * (cell(r, 3) - 1.0); }},
      {"denormal", [=](Random& r) { return kTiny * cell(r, 4); }},
      {"of all sizes",
       [=](Random& r) {
         const auto size = [&] { return std::ldexp(1.0, static_cast<int>(r() % 1800) - 1000); };
         const double x = size(), y = size();
         return Vector(x, y, size()) * (any(r) - 0.5);
       }},
      {"clusters in clusters",
       [=](Random& r) {
         Vector p(0);
         for (double size = 1; r() % 4 != 0; size *= 1e-7) p += size * cell(r, 2);
         return p;
       }},
  };
}

}  // namespace delray::delaunay
