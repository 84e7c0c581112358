// Any triangulation becomes the Delaunay triangulation.
#include "delaunay/construction/flip_edges.h"

#include <gtest/gtest.h>

#include <random>

#include "delaunay/flip/flip_2d.h"
#include "delaunay/mesh/build_mesh.h"
#include "delaunay/mesh/extract.h"
#include "tests/delaunay/same_simplices.h"

namespace delray::delaunay {
namespace {

// Random flips of diagonals of strictly convex quadrilaterals.
std::uint64_t shuffle(Mesh<2>& mesh, const Points& points, std::mt19937_64& random) {
  std::uint64_t flips = 0;
  for (std::size_t i = 0; i < 20 * mesh.size(); ++i) {
    const CornerNumber corner =
        corner_of(static_cast<SimplexNumber>(random() % mesh.size()), random() % 3);
    const CornerNumber beyond = mesh.neighbour(corner);
    if (mesh.is_ghost(simplex_of(corner)) || mesh.is_ghost(simplex_of(beyond))) continue;
    const auto at = [&](CornerNumber c) { return points[mesh.vertex(c)]; };
    const glm::dvec2 near = at(corner), far = at(beyond);
    if (orient2d(near, at(next_corner(corner)), far) <= 0) continue;
    if (orient2d(near, far, at(previous_corner(corner))) <= 0) continue;
    internal::flip(mesh, corner);
    ++flips;
  }
  return flips;
}

TEST(FlipEdges, MakesAnyTriangulationDelaunay) {
  std::uint64_t seed = 0, shuffled = 0;
  for (const HardPoints& kind : hard_points()) {
    std::mt19937_64 random(++seed);
    const Points points = kind.make(80, seed);
    const Triangulation expected = expected_of(points, 2);
    if (expected.size() == 0) continue;
    BuiltMesh<2> built = mesh_of<2>(expected, points.size());
    shuffled += shuffle(built.mesh, points, random);
    internal::flip_to_delaunay(built.mesh, points);
    const Result result =
        internal::extract(std::move(built.mesh), {built.rows.data(), built.rows.size()});
    EXPECT_EQ(hash(result.triangulation), hash(expected)) << kind.name << ", seed " << seed;
  }
  EXPECT_GT(shuffled, 1000U);
}

}  // namespace
}  // namespace delray::delaunay
