// Triangulates points in memory, asks where a place lies, and writes the mesh to a file.
//
//   example_triangulate [MESH.ply]
#include <delaunay/query.h>
#include <delaunay/triangulate.h>
#include <delaunay/write_mesh.h>

#include <cmath>
#include <cstdio>
#include <exception>

using namespace delray;

int main(int argc, char** argv) try {
  // A sunflower: seed i turns by the golden angle and lies sqrt(i) from the middle.
  delaunay::PointCloud points;
  for (int i = 0; i < 1000; ++i) {
    const double angle = 2.399963229728653 * i, radius = std::sqrt(i);
    points.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }

  delaunay::Options options;
  options.dim = 2;  // reads x and y; 3 makes tetrahedra
  options.threads = 2;
  const auto view = delaunay::view(points.positions);
  const delaunay::Triangulation mesh = delaunay::triangulate(view, options).triangulation;
  std::printf("%zu triangles, %llu edges on the hull\n", mesh.size(),
              static_cast<unsigned long long>(mesh.hull_facets));

  // Three rows of points for each triangle, counter-clockwise.
  std::printf("the first triangle: %u %u %u\n", mesh.vertices[0], mesh.vertices[1],
              mesh.vertices[2]);

  const delaunay::Query query(view, mesh);
  const std::uint32_t triangle = query.locate({10.0, 5.0, 0.0});  // exact, borders included
  const std::uint32_t nearest = query.nearest({10.0, 5.0, 0.0});
  std::printf("(10, 5) lies in triangle %u, nearest to point %u\n", triangle, nearest);

  if (argc > 1) delaunay::write_mesh(argv[1], points, mesh);  // the suffix decides the format
  // Euler: a triangulation of n points has 2 n - 2 - h triangles.
  return mesh.size() == 2 * mesh.distinct - 2 - mesh.hull_facets ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
