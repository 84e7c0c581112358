// Points that come and go: the triangulation is at any time that of the points which are there.
#include <delaunay/dynamic.h>
#include <delaunay/generate.h>
#include <delaunay/triangulate.h>

#include <cstdio>
#include <vector>

using namespace delray::delaunay;

int main() {
  const PointCloud cloud = generate_points("uniform", 1000, 3, 1);

  DynamicTriangulation<3> moving;
  const std::uint32_t first = moving.insert(view(cloud.positions));  // a batch: rows 0 to 999
  const std::uint32_t centre = moving.insert({0.5, 0.5, 0.5});       // one point: row 1000
  std::printf("%zu points, %zu tetrahedra\n", moving.size(), moving.triangulation().size());

  moving.remove(centre);
  for (std::uint32_t row = first; row < 500; ++row) moving.remove(row);
  const Triangulation now = moving.triangulation();  // vertices are rows of all that ever came
  std::printf("%zu points, %zu tetrahedra\n", moving.size(), now.size());

  // The same simplices as those of the points that are left, triangulated from scratch.
  const std::vector<glm::dvec3> left(cloud.positions.begin() + 500, cloud.positions.end());
  Options options;
  options.dim = 3;
  Triangulation expected = triangulate(view(left), options).triangulation;
  for (std::uint32_t& vertex : expected.vertices) vertex += 500;
  return hash(now) == hash(expected) ? 0 : 1;
}
