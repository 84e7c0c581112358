// A program of somebody else that wants triangulations and nothing more.
#include <delaunay/generate.h>
#include <delaunay/triangulate.h>

#include <cstdio>

using namespace delray;

int main() {
  const delaunay::PointCloud points = delaunay::generate_points("uniform", 1000, 2, 1);
  const delaunay::Triangulation mesh =
      delaunay::triangulate(delaunay::view(points.positions)).triangulation;
  std::printf("%zu triangles\n", mesh.size());
  return mesh.size() == 2 * mesh.distinct - 2 - mesh.hull_facets ? 0 : 1;
}
