// Small point sets that break triangulations, made anew from every seed.
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

using Points = std::vector<glm::dvec2>;

struct HardPoints {
  std::string name;
  std::function<glm::dvec2(std::mt19937_64&)> point;

  Points make(std::size_t n, std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    Points points(n);
    for (auto& p : points) p = point(random);
    return points;
  }
};

inline std::vector<HardPoints> hard_points() {
  using Random = std::mt19937_64;
  const auto unit = [](Random& random) { return std::uniform_real_distribution<>(0, 1)(random); };
  const auto integer = [](Random& random, int n) {
    return static_cast<double>(random() % static_cast<unsigned>(n));
  };
  const auto near_half = [](Random& random) {
    double x = 0.5;
    for (auto steps = random() % 4; steps > 0; --steps) x = std::nextafter(x, 1.0);
    return x;
  };
  constexpr double kTiny = std::numeric_limits<double>::denorm_min();
  const std::vector<HardPoints> sets = {
      {"uniform", [=](Random& r) { return glm::dvec2(unit(r), unit(r)); }},
      {"equal", [=](Random&) { return glm::dvec2(0.1, 0.7); }},
      {"duplicates, -0",
       [=](Random& r) {
         return glm::dvec2(integer(r, 3) * (integer(r, 2) - 0.5), integer(r, 2) * -0.0);
       }},
      {"on a horizontal line", [=](Random& r) { return glm::dvec2(integer(r, 9), 1); }},
      {"on a vertical line", [=](Random& r) { return glm::dvec2(1, unit(r)); }},
      {"on a slanted line",
       [=](Random& r) {
         const double x = integer(r, 99);
         return glm::dvec2(x, 3 * x + 1);
       }},
      {"on a line but for some",
       [=](Random& r) {
         const double x = integer(r, 30);
         return glm::dvec2(x, x + (r() % 8 == 0 ? 1 : 0));
       }},
      {"lattice", [=](Random& r) { return glm::dvec2(integer(r, 5), integer(r, 5)); }},
      {"lattice of tenths",
       [=](Random& r) { return glm::dvec2(0.1 * integer(r, 5), 0.1 * integer(r, 5)); }},
      {"lattice far away",
       [=](Random& r) { return glm::dvec2(4e6 + 0.5 * integer(r, 5), 7e5 + 0.5 * integer(r, 5)); }},
      {"hexagonal lattice",
       [=](Random& r) {
         const double row = integer(r, 5);
         return glm::dvec2(2 * integer(r, 5) + std::fmod(row, 2), row * std::sqrt(3.0));
       }},
      {"exactly on a circle",
       [=](Random& r) {
         // 65^2 = 16^2 + 63^2 = 33^2 + 56^2 = 25^2 + 60^2 = 39^2 + 52^2
         const double legs[5][2] = {{16, 63}, {33, 56}, {25, 60}, {39, 52}, {0, 65}};
         const auto* leg = legs[r() % 5];
         const bool turned = r() % 2 != 0;
         const double x = leg[turned ? 1 : 0], y = leg[turned ? 0 : 1];
         return glm::dvec2(r() % 2 != 0 ? x : -x, r() % 2 != 0 ? y : -y);
       }},
      {"near a circle",
       [=](Random& r) {
         const double angle = 7 * unit(r);
         return glm::dvec2(std::cos(angle), std::sin(angle));
       }},
      {"circles about a point",
       [=](Random& r) {
         const double angle = 0.5235987755982988 * integer(r, 12), radius = integer(r, 3);
         return glm::dvec2(radius * std::cos(angle), radius * std::sin(angle));
       }},
      {"one ulp off", [=](Random& r) { return glm::dvec2(near_half(r), near_half(r)); }},
      {"two lines", [=](Random& r) { return glm::dvec2(integer(r, 20), integer(r, 2)); }},
      {"parabola",
       [=](Random& r) {
         const double x = integer(r, 30) - 15;
         return glm::dvec2(x, x * x);
       }},
      {"1e9", [=](Random& r) { return 1e9 * glm::dvec2(unit(r), unit(r)); }},
      {"1e-9", [=](Random& r) { return 1e-9 * glm::dvec2(unit(r), integer(r, 4)); }},
      {"1e300", [=](Random& r) { return 1e300 * glm::dvec2(unit(r) - 0.5, integer(r, 4)); }},
      {"largest",
       [=](Random& r) {
         return std::numeric_limits<double>::max() * glm::dvec2(integer(r, 3) - 1, unit(r) - 0.5);
       }},
      {"denormal", [=](Random& r) { return kTiny * glm::dvec2(integer(r, 6), integer(r, 6)); }},
      {"of all sizes",
       [=](Random& r) {
         return glm::dvec2(std::ldexp(unit(r), static_cast<int>(r() % 1800) - 1000),
                           std::ldexp(unit(r) - 0.5, static_cast<int>(r() % 1800) - 1000));
       }},
      {"clusters in clusters",
       [=](Random& r) {
         glm::dvec2 p(0);
         for (double size = 1; r() % 4 != 0; size *= 1e-7) {
           p += size * glm::dvec2(integer(r, 2), integer(r, 2));
         }
         return p;
       }},
  };
  return sets;
}

}  // namespace delray::delaunay
