// The conflict of a point with a node: the rule of predicates/conflict.h for corners that lie in no
// common mesh.
//
// The rule for a ghost in space whose facet's plane has the point needs a vertex below the facet;
// any does, as its height decides nothing. So corners of the first simplex serve, of which one lies
// below the plane.
#include "delaunay/distributed/node.h"

#include <utility>

#include "delaunay/mesh/start_mesh.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay {
namespace {

template <int D>
Position<D> position_of(const RowPoint& point) {
  return Position<D>(point.position);
}

int volume_sign(const std::array<glm::dvec2, 3>& p) { return orient2d(p[0], p[1], p[2]); }
int volume_sign(const std::array<glm::dvec3, 4>& p) { return orient3d(p[0], p[1], p[2], p[3]); }

bool conflict_with(std::array<glm::dvec2, 3>& p, unsigned infinite, const FirstSimplex<2>&,
                   const glm::dvec2& q) {
  if (infinite > 2) return circle_conflict(p[0], p[1], p[2], q);
  const glm::dvec2 &a = p[(infinite + 1) % 3], &b = p[(infinite + 2) % 3];
  const int side = orient2d(a, b, q);
  return side != 0 ? side > 0 : strictly_between(a, b, q);
}

bool conflict_with(std::array<glm::dvec3, 4>& p, unsigned infinite, const FirstSimplex<3>& first,
                   const glm::dvec3& q) {
  constexpr AnyPoints predicates;
  if (infinite > 3) return sphere_conflict(predicates, p[0], p[1], p[2], p[3], q);
  p[infinite] = q;
  const int side = volume_sign(p);
  if (side != 0) return side > 0;
  for (const RowPoint& below : first) {
    p[infinite] = below.position;
    if (volume_sign(p) == 0) continue;
    std::swap(p[infinite == 0 ? 1 : 0], p[infinite == 3 ? 2 : 3]);
    return sphere_conflict(predicates, p[0], p[1], p[2], p[3], q);
  }
  return false;  // not of a first simplex
}

}  // namespace

template <int D>
bool conflict(const Node<D>& node, const FirstSimplex<D>& first, const glm::dvec3& q) {
  std::array<Position<D>, D + 1> p;
  for (unsigned k = 0; k <= D; ++k) p[k] = position_of<D>(node.corners[k]);
  return conflict_with(p, node.infinite_corner(), first, Position<D>(q));
}

template <int D>
unsigned facet_towards(const Node<D>& node, const glm::dvec3& q, unsigned begin) {
  std::array<Position<D>, D + 1> p;
  for (unsigned k = 0; k <= D; ++k) p[k] = position_of<D>(node.corners[k]);
  for (unsigned i = 0; i <= D; ++i) {
    const unsigned k = (begin + i) % (D + 1);
    const Position<D> corner = std::exchange(p[k], Position<D>(q));
    if (volume_sign(p) < 0) return k;
    p[k] = corner;
  }
  return D + 1;
}

template <int D>
std::vector<Node<D>> first_nodes(const FirstSimplex<D>& first) {
  Mesh<D> mesh(D + 2);
  std::array<VertexNumber, D + 1> corners;
  for (unsigned k = 0; k <= D; ++k) corners[k] = k;
  internal::start_mesh(mesh, corners);
  std::vector<Node<D>> nodes(D + 2);
  for (SimplexNumber s = 0; s < nodes.size(); ++s) {
    nodes[s].id = {0, 0, s};
    for (unsigned k = 0; k <= D; ++k) {
      const VertexNumber vertex = mesh.vertex(corner_of(s, k));
      nodes[s].corners[k] =
          vertex == kInfiniteVertex ? RowPoint{glm::dvec3(0), kInfiniteRow} : first[vertex];
      nodes[s].neighbours[k] = {0, 0, simplex_of(mesh.neighbour(corner_of(s, k)))};
    }
  }
  return nodes;
}

template bool conflict<2>(const Node<2>&, const FirstSimplex<2>&, const glm::dvec3&);
template bool conflict<3>(const Node<3>&, const FirstSimplex<3>&, const glm::dvec3&);
template unsigned facet_towards<2>(const Node<2>&, const glm::dvec3&, unsigned);
template unsigned facet_towards<3>(const Node<3>&, const glm::dvec3&, unsigned);
template std::vector<Node<2>> first_nodes<2>(const FirstSimplex<2>&);
template std::vector<Node<3>> first_nodes<3>(const FirstSimplex<3>&);

}  // namespace delray::delaunay
