// Centres of spheres against exact ones: how far off they are is known, and little.
#include "delaunay/predicates/circumcentres.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>

namespace delray::delaunay::internal {
namespace {

using Exact = std::array<mpq_class, 3>;
using Corners = std::array<Vector3<double>, 4>;

Exact exact(const Vector3<double>& p) { return {mpq_class(p.x), mpq_class(p.y), mpq_class(p.z)}; }

Exact difference(const Exact& a, const Exact& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

mpq_class product(const Exact& a, const Exact& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Exact cross_product(const Exact& a, const Exact& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// As seen from q.
Exact exact_centre(const Corners& at, const Vector3<double>& q) {
  const Exact origin = exact(at[0]);
  const Exact a = difference(exact(at[1]), origin), b = difference(exact(at[2]), origin),
              c = difference(exact(at[3]), origin);
  const Exact bc = cross_product(b, c), ca = cross_product(c, a), ab = cross_product(a, b);
  const mpq_class aa = product(a, a), bb = product(b, b), cc = product(c, c);
  Exact centre = difference(origin, exact(q));
  for (std::size_t k = 0; k < 3; ++k) {
    centre[k] += (aa * bc[k] + bb * ca[k] + cc * ab[k]) / (2 * product(a, bc));
  }
  return centre;
}

double distance(const Vector3<double>& from, const Exact& to) {
  const Exact off = difference(exact(from), to);
  return mpq_class(abs(off[0]) + abs(off[1]) + abs(off[2])).get_d();
}

// Three corners within about `size` of each other and the fourth about 1 away, then the second as
// much as `flat` allows on the line of the first and the third; all of it about `far` from the
// origin, so that differences are rounded.
Corners corners(double size, double flat, double far, std::mt19937_64& random) {
  std::uniform_real_distribution<> unit(-1, 1);
  const auto any = [&](double scale) {
    return Vector3<double>{scale * unit(random), scale * unit(random), scale * unit(random)};
  };
  const Vector3<double> start = any(far);
  Corners at = {start, start + any(size), start + any(size), start + any(1)};
  at[1] = start + (unit(random) * (at[2] - start) + flat * any(size));
  return at;
}

struct Shape {
  double size, flat, far;
};

constexpr Shape kShapes[] = {{1, 1, 0},       {1, 1, 1},         {0.01, 1, 1}, {1e-5, 1, 3},
                             {1, 1e-3, 1},    {1, 1e-5, 1},      {1, 1e-5, 0}, {0.01, 1e-4, 1},
                             {0.01, 1e-6, 3}, {1e-3, 1e-4, 100}, {1, 1e-9, 1}, {1, 1e-13, 1}};

TEST(Circumcentres, AreNoFartherOffThanTheyAreSaidToBe) {
  std::mt19937_64 random(4);
  int known = 0;
  for (const Shape& shape : kShapes) {
    SCOPED_TRACE(std::to_string(shape.size) + " " + std::to_string(shape.flat));
    for (int round = 0; round < 300; ++round) {
      const Corners at = corners(shape.size, shape.flat, shape.far, random);
      const Vector3<double> q = corners(shape.size, 1, shape.far, random)[0];
      const auto centre = centre_of<double>(at, q);
      if (!centre.known()) continue;
      ++known;
      ASSERT_LE(distance(centre.at, exact_centre(at, q)), centre.error);
    }
  }
  EXPECT_GT(known, 3000);
}

// Clusters have many long and flat tetrahedra: doubles do for them.
TEST(Circumcentres, OfFlatTetrahedraAreKnownWell) {
  std::mt19937_64 random(5);
  for (const double flat : {1.0, 1e-2, 1e-4}) {
    SCOPED_TRACE(flat);
    int known_well = 0;
    for (int round = 0; round < 300; ++round) {
      const Corners at = corners(0.01, flat, 1, random);
      const auto centre = centre_of<double>(at, at[0]);
      known_well += centre.known() && centre.error <= 0x1p-43 * norm(centre.at);
    }
    EXPECT_GE(known_well, 297);
  }
}

}  // namespace
}  // namespace delray::delaunay::internal
