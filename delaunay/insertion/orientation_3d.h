// Orientation in space where one of the points may be the infinite vertex.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "delaunay/mesh/mesh.h"
#include "delaunay/order/curve_order_3d.h"
#include "delaunay/points.h"
#include "delaunay/predicates/orientation.h"
#include "delaunay/predicates/sphere_tests.h"

namespace delray::delaunay {

// As in the plane: the infinite vertex lies opposite to a point just inside the first tetrahedron,
// its first vertex moved by less and less towards the others. No three vertices that are not
// collinear lie in a plane with that point, so whatever the hull is, the ghosts tile what is
// outside of it.
template <>
class Orientation<3> {
 public:
  // REQUIRES: `points` outlives it; `first` are vertices of a positively oriented tetrahedron.
  // O(points).
  Orientation(std::span<const glm::dvec3> points, const std::array<VertexNumber, 4>& first)
      : points_(points.data()),
        inner_{points[first[0]], points[first[1]], points[first[2]], points[first[3]]},
        tests_(internal::finite_range({reinterpret_cast<const std::byte*>(points.data()),
                                       points.size(), sizeof(glm::dvec3)})) {}

  // The sign of a tetrahedron's volume; `vertices` has at most one infinite.
  int operator()(const std::array<VertexNumber, 4>& vertices) const {
    std::array<const glm::dvec3*, 4> p{};
    unsigned infinite = 4;
    for (unsigned k = 0; k < 4; ++k) {
      if (vertices[k] == kInfiniteVertex) {
        infinite = k;
      } else {
        p[k] = points_ + vertices[k];
      }
    }
    return sign(p, infinite);
  }
  // The orientation with q in the place of corner `replaced`: 0 or more if q is on the
  // tetrahedron's side of the facet opposite to that corner.
  int with(const glm::dvec3& q, unsigned replaced,
           const std::array<VertexNumber, 4>& vertices) const {
    std::array<const glm::dvec3*, 4> p{};
    unsigned infinite = 4;
    for (unsigned k = 0; k < 4; ++k) {
      if (k == replaced) {
        p[k] = &q;
      } else if (vertices[k] == kInfiniteVertex) {
        infinite = k;
      } else {
        p[k] = points_ + vertices[k];
      }
    }
    return sign(p, infinite);
  }

  const glm::dvec3& point(VertexNumber vertex) const { return points_[vertex]; }
  const internal::SphereTests& tests() const { return tests_; }

 private:
  int sign(std::array<const glm::dvec3*, 4>& p, unsigned infinite) const {
    if (infinite == 4) return tests_.orient3d(*p[0], *p[1], *p[2], *p[3]);
    for (const glm::dvec3& inner : inner_) {
      p[infinite] = &inner;
      const int side = tests_.orient3d(*p[0], *p[1], *p[2], *p[3]);
      if (side != 0) return -side;
    }
    return 0;
  }

  const glm::dvec3* points_;
  std::array<glm::dvec3, 4> inner_;
  internal::SphereTests tests_;
};

}  // namespace delray::delaunay
