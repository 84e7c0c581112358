// The part of the verifier that shows that simplices cover a convex body exactly once.
#include "delaunay/verify/verified_mesh.h"

namespace delray::delaunay::internal {
namespace {

constexpr std::uint32_t kNoMate = FacetMates::kNone;

// The plane, and the plane onto which space is projected along (e, e^2, 1) for an infinitesimal e,
// so that no face of a tetrahedron is seen edge-on. Turns and the lexicographic order there are
// written for this file alone: an error in those of the triangulations must not repeat itself here.
struct Plane {
  static int turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return orient2d(a, b, c);
  }
  static bool before(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  }
};
struct Projection {
  // The sign of the normal times (e, e^2, 1). 0 only if the points are collinear.
  static int turn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    if (const int z = orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}); z != 0) return z;
    if (const int x = orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z}); x != 0) return x;
    return orient2d({a.z, a.x}, {b.z, b.x}, {c.z, c.x});
  }
  // By x - e z, then by y - e^2 z.
  static bool before(const glm::dvec3& a, const glm::dvec3& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.z != b.z) return a.z > b.z;
    return a.y < b.y;
  }
};

struct Edge {
  std::uint32_t start, end;
  std::size_t simplex;
};

// Whether edges, of which as many leave a vertex as enter it, form one convex polygon,
// counterclockwise. A polygon whose corners are all convex winds once around its inside if it has
// one lexicographic minimum, and so do several only if they are one.
template <class View, int D>
Check check_polygon(const VerifiedMesh<D>& mesh, const std::vector<Edge>& edges) {
  std::vector<std::uint32_t> leaving(mesh.points.size(), kNoMate);  // edge per vertex
  for (std::size_t i = 0; i < edges.size(); ++i) {
    std::uint32_t& known = leaving[edges[i].start];
    if (known != kNoMate) {
      return Objection{edges[i].simplex,
                       "the boundary passes " + mesh.row(edges[i].start) + " twice"};
    }
    known = static_cast<std::uint32_t>(i);
  }
  bool has_minimum = false;
  for (const Edge& edge : edges) {
    const auto a = mesh.at(edge.start), b = mesh.at(edge.end);
    const auto c = mesh.at(edges[leaving[edge.end]].end);
    const int turn = View::turn(a, b, c);
    if (turn < 0 || (turn == 0 && View::before(a, b) != View::before(b, c))) {
      return Objection{edge.simplex, "the boundary is not convex at " + mesh.row(edge.end)};
    }
    if (View::before(b, a) && View::before(b, c)) {
      if (has_minimum) {
        return Objection{edge.simplex,
                         "the boundary is more than one polygon at " + mesh.row(edge.end)};
      }
      has_minimum = true;
    }
  }
  return std::nullopt;
}

// The faces of tetrahedra that have no mate, and their edges.
struct Surface {
  std::vector<std::uint32_t> facets;     // numbers
  std::vector<std::uint32_t> triangles;  // outward, 3 vertices each
  std::vector<std::uint8_t> up;          // whether a face is seen from above
  FacetMates edges;
};

Surface surface_of(const VerifiedMesh<3>& mesh) {
  Surface surface;
  for (std::size_t facet = 0; facet < mesh.vertices.size(); ++facet) {
    if (mesh.facets.mates[facet] != kNoMate) continue;
    const auto face = mesh.outward(facet);
    surface.facets.push_back(static_cast<std::uint32_t>(facet));
    surface.triangles.insert(surface.triangles.end(), face.begin(), face.end());
  }
  surface.up.resize(surface.facets.size());
  parallel::parallel_for(0, surface.facets.size(), kVerifyGrain, [&](std::size_t i) {
    const std::uint32_t* face = surface.triangles.data() + 3 * i;
    surface.up[i] =
        Projection::turn(mesh.at(face[0]), mesh.at(face[1]), mesh.at(face[2])) > 0 ? 1 : 0;
  });
  surface.edges = match_facets(2, surface.triangles, mesh.points.size());
  return surface;
}

}  // namespace

Check check_hull(const VerifiedMesh<2>& mesh) {
  std::vector<Edge> edges;
  for (std::size_t facet = 0; facet < mesh.vertices.size(); ++facet) {
    if (mesh.facets.mates[facet] != kNoMate) continue;
    const auto edge = mesh.outward(facet);
    edges.push_back({edge[0], edge[1], facet / 3});
  }
  return check_polygon<Plane>(mesh, edges);
}

// The faces seen from above lie, projected, side by side in the polygon of the edges where they
// meet the faces seen from below. If that polygon is convex and winds once, either kind covers it
// exactly once: both are graphs of functions over it. These are concave and convex if they are at
// every edge. The number of tetrahedra over a place in general position is the number of faces
// seen from above over it less those seen from below: one between the graphs and none elsewhere.
Check check_hull(const VerifiedMesh<3>& mesh) {
  const Surface surface = surface_of(mesh);
  const auto start = [&](std::size_t e) { return surface.triangles[e - e % 3 + (e + 1) % 3]; };
  const auto end = [&](std::size_t e) { return surface.triangles[e - e % 3 + (e + 2) % 3]; };
  const auto simplex = [&](std::size_t e) -> std::size_t { return surface.facets[e / 3] / 4; };
  const auto name = [&](std::size_t e) { return mesh.row(start(e)) + " and " + mesh.row(end(e)); };
  if (const std::size_t crowded = surface.edges.crowded; crowded != kNoMate) {
    return Objection{simplex(crowded),
                     "more than two faces of the boundary meet between " + name(crowded)};
  }
  const auto is_open = [&](std::size_t e) {
    const std::uint32_t mate = surface.edges.mates[e];
    return mate == kNoMate || start(mate) != end(e);
  };
  const auto is_outline = [&](std::size_t e) {
    return surface.up[e / 3] != surface.up[surface.edges.mates[e] / 3];
  };
  const auto is_hollow = [&](std::size_t e) {
    const std::uint32_t mate = surface.edges.mates[e];
    const std::uint32_t* v = surface.triangles.data() + (e - e % 3);
    return e < mate && !is_outline(e) &&
           orient3d(mesh.at(v[0]), mesh.at(v[1]), mesh.at(v[2]), mesh.at(surface.triangles[mate])) >
               0;
  };
  const std::size_t bad = find_first(surface.triangles.size(),
                                     [&](std::size_t e) { return is_open(e) || is_hollow(e); });
  if (bad != kAll) {
    const char* what = is_open(bad) ? "closed" : "convex";
    return Objection{simplex(bad),
                     std::string("the boundary is not ") + what + " between " + name(bad)};
  }
  std::vector<Edge> outline;
  for (std::size_t e = 0; e < surface.triangles.size(); ++e) {
    if (surface.up[e / 3] && is_outline(e)) outline.push_back({start(e), end(e), simplex(e)});
  }
  return check_polygon<Projection>(mesh, outline);
}

}  // namespace delray::delaunay::internal
