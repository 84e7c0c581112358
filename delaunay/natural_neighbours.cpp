#include "delaunay/natural_neighbours.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <unordered_map>
#include <utility>

#include "delaunay/internal/first_tetrahedron.h"
#include "delaunay/predicates.h"

namespace delray::delaunay {
namespace {

// In the plane, or in a plane of space. Positions are relative to q: areas are
// small beside coordinates.
struct Triangle {
  std::array<std::uint32_t, 3> rows;
  std::array<glm::dvec2, 3> p;  // counterclockwise
};
struct Tetrahedron {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::array<std::uint32_t, 4> rows;
  std::array<glm::dvec3, 4> p;  // positively oriented
  // Which of the cavity lies beyond the facet opposite to a vertex; kNone for a side of the cavity.
  std::array<std::size_t, 4> beyond;
  glm::dvec3 centre;

  bool is_side(std::size_t k) const { return beyond[k] == kNone; }
};

// For each corner of a tetrahedron the three others, such that with it they are an even
// permutation.
constexpr std::array<std::array<std::size_t, 3>, 4> kFacets = {
    {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

glm::dvec2 circumcentre(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const glm::dvec2 u = b - a, v = c - a;
  const double uu = glm::dot(u, u), vv = glm::dot(v, v), twice = 2 * cross(u, v);
  return a + glm::dvec2(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / twice;
}

glm::dvec3 circumcentre(const std::array<glm::dvec3, 4>& p) {
  const glm::dvec3 a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
  const glm::dvec3 bc = glm::cross(b, c);
  const glm::dvec3 sum =
      glm::dot(a, a) * bc + glm::dot(b, b) * glm::cross(c, a) + glm::dot(c, c) * glm::cross(a, b);
  return p[0] + sum / (2 * glm::dot(a, bc));
}

// Parts of what neighbours lose.
class Shares {
 public:
  void add(std::uint32_t row, double part) { parts_.push_back({row, part}); }

  // Their sums, as shares of the whole.
  std::vector<NaturalNeighbour> normalized() && {
    std::ranges::stable_sort(parts_, {}, &NaturalNeighbour::row);
    std::vector<NaturalNeighbour> shares;
    double whole = 0;
    for (const NaturalNeighbour& part : parts_) {
      if (shares.empty() || shares.back().row != part.row) shares.push_back({part.row, 0});
      shares.back().weight += part.weight;
      whole += part.weight;
    }
    for (NaturalNeighbour& share : shares) share.weight /= whole;
    return shares;
  }

 private:
  std::vector<NaturalNeighbour> parts_;
};

// Of the triangles whose circles hold q. `on_line(a, b)` is whether q is on the line through two
// rows: that is an edge of the hull then.
//
// What a neighbour loses is a polygon about it: from the centre of q and an edge of the cavity that
// leaves it, over those of the triangles there, to that of q and the edge that enters it.
template <class OnLine>
std::vector<NaturalNeighbour> shares_of_area(const std::vector<Triangle>& cavity,
                                             const OnLine& on_line) {
  struct Edge {
    std::uint32_t start, end;
    glm::dvec2 centre;  // of the triangle on its left; of a side: of that with q
  };
  const auto ends = [](const Edge& edge) { return std::pair(edge.start, edge.end); };
  std::vector<Edge> edges, sides;
  for (const Triangle& t : cavity) {
    const glm::dvec2 centre = circumcentre(t.p[0], t.p[1], t.p[2]);
    for (std::size_t k = 0; k < 3; ++k) edges.push_back({t.rows[k], t.rows[(k + 1) % 3], centre});
  }
  std::ranges::sort(edges, {}, ends);
  Shares shares;
  for (const Triangle& t : cavity) {
    const glm::dvec2 own = circumcentre(t.p[0], t.p[1], t.p[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t.rows[k], b = t.rows[(k + 1) % 3];
      const auto twin = std::ranges::lower_bound(edges, std::pair(b, a), {}, ends);
      if (twin != edges.end() && ends(*twin) == std::pair(b, a)) {
        shares.add(a, cross(twin->centre, own));
        continue;
      }
      const glm::dvec2 &at_a = t.p[k], &at_b = t.p[(k + 1) % 3];
      if (on_line(a, b)) {
        const double from_a = glm::length(at_a), from_b = glm::length(at_b);
        return {{a, from_b / (from_a + from_b)}, {b, from_a / (from_a + from_b)}};
      }
      const glm::dvec2 outer = circumcentre(glm::dvec2(0), at_a, at_b);
      shares.add(a, cross(outer, own));
      shares.add(b, cross(own, outer));
      sides.push_back({a, b, outer});
    }
  }
  std::ranges::sort(sides, {}, ends);
  for (const Edge& entering : sides) {
    const Edge& leaving = *std::ranges::lower_bound(sides, entering.end, {}, &Edge::start);
    shares.add(entering.end, cross(entering.centre, leaving.centre));
  }
  return std::move(shares).normalized();
}

// Of the tetrahedra whose spheres hold q, none of whose sides is in a plane with q.
//
// What a neighbour i loses is a polyhedron. Each of its faces lies half-way between i and a point
// j, another neighbour or q, and its edges are between the centres of tetrahedra that follow each
// other around the edge from i to j. So its volume is a sum of cones with the apex i over triangles
// of two centres and the middle of i and j: those of the tetrahedra in the cavity, less those of
// the tetrahedra that would replace them.
std::vector<NaturalNeighbour> shares_of_volume(const std::vector<Tetrahedron>& cavity) {
  Shares shares;
  struct Place {
    std::uint32_t row;
    glm::dvec3 p;
  };
  const auto add_cone = [&](const Place& i, const Place& j, const glm::dvec3& from,
                            const glm::dvec3& to, double sign) {
    const glm::dvec3 middle = 0.5 * (i.p + j.p);
    shares.add(i.row, sign * glm::dot(j.p - i.p, glm::cross(from - middle, to - middle)));
  };
  // A tetrahedron of q and a side, by one of its edges.
  struct NewEdge {
    Place start, end;
    glm::dvec3 centre;
  };
  std::vector<NewEdge> edges;
  for (const Tetrahedron& t : cavity) {
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<Place, 3> facet;
      for (std::size_t i = 0; i < 3; ++i) facet[i] = {t.rows[kFacets[k][i]], t.p[kFacets[k][i]]};
      const glm::dvec3 other =
          t.is_side(k) ? circumcentre({facet[0].p, facet[1].p, facet[2].p, glm::dvec3(0)})
                       : cavity[t.beyond[k]].centre;
      for (std::size_t i = 0; i < 3; ++i) {
        const Place &start = facet[i], &end = facet[(i + 1) % 3];
        add_cone(start, end, other, t.centre, 1);
        if (!t.is_side(k)) continue;
        add_cone(end, start, t.centre, other, 1);
        edges.push_back({end, start, other});
      }
    }
  }
  const auto key = [](const NewEdge& edge) { return std::pair(edge.start.row, edge.end.row); };
  std::ranges::sort(edges, {}, key);
  const Place q = {0, glm::dvec3(0)};
  for (const NewEdge& edge : edges) {
    const NewEdge& twin =
        *std::ranges::lower_bound(edges, std::pair(edge.end.row, edge.start.row), {}, key);
    // Around its edge from `start` to `end` the tetrahedron follows its twin, and so it does from
    // `end` to q.
    add_cone(edge.start, edge.end, twin.centre, edge.centre, -1);
    add_cone(edge.end, q, twin.centre, edge.centre, -1);
  }
  return std::move(shares).normalized();
}

// The simplices whose spheres hold q, that of q first, and where each is among them.
struct Cavity {
  std::vector<std::uint32_t> simplices;
  std::unordered_map<std::uint32_t, std::size_t> places;
};

Cavity cavity_of(const Query& query, std::uint32_t first, const glm::dvec3& q) {
  const auto& vertices = query.triangulation().vertices;
  const int dim = query.triangulation().dim;
  const auto corners = static_cast<std::size_t>(dim) + 1;
  const auto holds = [&](std::uint32_t simplex) {
    std::array<glm::dvec3, 4> p{};
    for (std::size_t k = 0; k < corners; ++k) {
      p[k] = query.position(vertices[simplex * corners + k]);
    }
    return dim == 2
               ? incircle(glm::dvec2(p[0]), glm::dvec2(p[1]), glm::dvec2(p[2]), glm::dvec2(q)) > 0
               : insphere(p[0], p[1], p[2], p[3], q) > 0;
  };
  Cavity cavity{{first}, {{first, 0}}};
  for (std::size_t i = 0; i < cavity.simplices.size(); ++i) {
    for (std::size_t k = 0; k < corners; ++k) {
      const std::uint32_t next = query.adjacency().neighbours[cavity.simplices[i] * corners + k];
      if (next == Query::kNone || cavity.places.contains(next) || !holds(next)) continue;
      cavity.places.emplace(next, cavity.simplices.size());
      cavity.simplices.push_back(next);
    }
  }
  return cavity;
}

std::vector<NaturalNeighbour> neighbours_in_plane(const Query& query, const Cavity& cavity,
                                                  const glm::dvec3& q) {
  std::vector<Triangle> triangles;
  for (const std::uint32_t t : cavity.simplices) {
    Triangle& triangle = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.rows[k] = query.triangulation().vertices[3 * std::size_t{t} + k];
      triangle.p[k] = glm::dvec2(query.position(triangle.rows[k]) - q);
    }
  }
  return shares_of_area(triangles, [&](std::uint32_t a, std::uint32_t b) {
    return orient2d(glm::dvec2(query.position(a)), glm::dvec2(query.position(b)), glm::dvec2(q)) ==
           0;
  });
}

// Of q in the plane of a side, which is one of the hull: those within that plane.
std::vector<NaturalNeighbour> neighbours_on_hull(const Query& query,
                                                 const std::vector<Tetrahedron>& cavity,
                                                 const std::array<std::uint32_t, 3>& side,
                                                 const glm::dvec3& q) {
  std::array<glm::dvec3, 3> plane;
  for (std::size_t k = 0; k < 3; ++k) plane[k] = query.position(side[k]);
  const glm::dvec3 u = glm::normalize(plane[1] - plane[0]);
  const glm::dvec3 v = glm::normalize(glm::cross(glm::cross(u, plane[2] - plane[0]), u));
  std::vector<Triangle> triangles;
  for (const Tetrahedron& t : cavity) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (!t.is_side(k)) continue;
      Triangle triangle;
      bool in_plane = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t corner = kFacets[k][i];
        triangle.rows[i] = t.rows[corner];
        triangle.p[i] = {glm::dot(t.p[corner], u), glm::dot(t.p[corner], v)};
        in_plane &= orient3d(plane[0], plane[1], plane[2], query.position(t.rows[corner])) == 0;
      }
      if (in_plane) triangles.push_back(triangle);
    }
  }
  return shares_of_area(triangles, [&](std::uint32_t a, std::uint32_t b) {
    return internal::are_collinear(query.position(a), query.position(b), q);
  });
}

std::vector<NaturalNeighbour> neighbours_in_space(const Query& query, const Cavity& simplices,
                                                  const glm::dvec3& q) {
  std::vector<Tetrahedron> cavity;
  for (const std::uint32_t simplex : simplices.simplices) {
    Tetrahedron& t = cavity.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t corner = 4 * std::size_t{simplex} + k;
      t.rows[k] = query.triangulation().vertices[corner];
      t.p[k] = query.position(t.rows[k]) - q;
      const std::uint32_t next = query.adjacency().neighbours[corner];
      const auto beyond = simplices.places.find(next);
      t.beyond[k] = beyond == simplices.places.end() ? Tetrahedron::kNone : beyond->second;
    }
    t.centre = circumcentre(t.p);
  }
  for (const Tetrahedron& t : cavity) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (!t.is_side(k)) continue;
      const std::array<std::uint32_t, 3> side = {t.rows[kFacets[k][0]], t.rows[kFacets[k][1]],
                                                 t.rows[kFacets[k][2]]};
      if (orient3d(query.position(side[0]), query.position(side[1]), query.position(side[2]), q) ==
          0) {
        return neighbours_on_hull(query, cavity, side, q);
      }
    }
  }
  return shares_of_volume(cavity);
}

}  // namespace

std::vector<NaturalNeighbour> natural_neighbours(const Query& query, const glm::dvec3& q) {
  const std::uint32_t first = query.locate(q);
  if (first == Query::kNone) return {};
  const int dim = query.triangulation().dim;
  const glm::dvec3 asked(q.x, q.y, dim == 3 ? q.z : 0.0);
  const auto corners = static_cast<std::size_t>(dim) + 1;
  for (std::size_t k = 0; k < corners; ++k) {
    const std::uint32_t row = query.triangulation().vertices[first * corners + k];
    if (query.position(row) == asked) return {{row, 1.0}};
  }
  const Cavity cavity = cavity_of(query, first, asked);
  return dim == 2 ? neighbours_in_plane(query, cavity, asked)
                  : neighbours_in_space(query, cavity, asked);
}

}  // namespace delray::delaunay
