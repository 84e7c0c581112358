// A program of somebody else: triangulates, renders with both engines, and checks that it worked.
#include <comm/threads.h>
#include <delaunay/generate.h>
#include <delaunay/triangulate.h>
#include <image/compare.h>
#include <image/io.h>
#include <raster/render.h>
#include <raytrace/render.h>
#include <scenes/generate.h>

#include <cstdio>

using namespace delray;

int main() {
  const delaunay::PointCloud points = delaunay::generate_points("uniform", 1000, 2, 1);
  const delaunay::Triangulation mesh =
      delaunay::triangulate(delaunay::view(points.positions)).triangulation;
  if (mesh.size() != 2 * mesh.distinct - 2 - mesh.hull_facets) return 1;

  const scenes::Scene scene = scenes::generate("gen:cornell:1000");
  std::uint64_t covered = 0;
  comm::run_threads(2, 1, [&](comm::Communicator& communicator) {
    raster::RenderOptions raster_options;
    raster_options.width = 64;
    raster_options.height = 48;
    raster_options.float_pixels = true;
    raytrace::RenderOptions raytrace_options;
    raytrace_options.width = 64;
    raytrace_options.height = 48;
    const auto drawn = raster::render(communicator, scene, scene.cameras.front(), raster_options);
    const auto traced =
        raytrace::render(communicator, scene, scene.cameras.front(), raytrace_options);
    if (communicator.rank() != 0) return;
    const auto& picture = std::get<image::ImageF>(drawn.picture);
    for (const float depth : picture.depth.span()) covered += depth < image::kEmptyDepth ? 1 : 0;
    if (image::compare(picture, traced.image).coverage_differs > 10) covered = 0;
  });
  // Through the library that is loaded on first use.
  if (image::encode_png(1, 1, std::vector<image::Rgba8>(1)).empty()) return 3;
  std::printf("%zu triangles, %llu pixels\n", mesh.size(),
              static_cast<unsigned long long>(covered));
  return covered > 1000 ? 0 : 2;
}
