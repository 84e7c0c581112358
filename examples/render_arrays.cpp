// Renders arrays of vertices and triangles, as a simulation may have them, with both engines.
//
//   example_render_arrays [RASTERIZED.png [RAY_TRACED.png]]
#include <comm/threads.h>
#include <image/compare.h>
#include <image/io.h>
#include <raster/render.h>
#include <raytrace/render.h>
#include <scenes/framing.h>
#include <scenes/scene.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <variant>

using namespace delray;

namespace {

// A ripple on a square of n x n quads, coloured by height.
scenes::Mesh ripple(std::uint32_t n) {
  scenes::Mesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      const glm::vec2 at = glm::vec2(i, j) / static_cast<float>(n) * 2.0F - 1.0F;
      const float z = 0.15F * std::cos(14.0F * glm::length(at)) * std::exp(-2.0F * dot(at, at));
      mesh.positions.emplace_back(at.x, at.y, z);
      mesh.colours.emplace_back(0.5F + 3.0F * z, 0.5F, 0.5F - 3.0F * z, 1.0F);
    }
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t corner = j * (n + 1) + i, above = corner + n + 1;
      mesh.triangles.emplace_back(corner, corner + 1, above + 1);
      mesh.triangles.emplace_back(corner, above + 1, above);
    }
  }
  return mesh;
}

}  // namespace

int main(int argc, char** argv) try {
  scenes::Scene scene;
  scene.meshes.push_back(ripple(200));
  scene.instances.push_back({});  // mesh 0, where it is
  scene.z_up = true;
  const scenes::Camera camera = scenes::camera_around(scene, "iso", 4.0F / 3.0F);
  scenes::complete(scene, camera);  // a material, normals and a light

  raster::RenderOptions rasterized;
  raytrace::RenderOptions traced;
  rasterized.width = traced.width = 320;
  rasterized.height = traced.height = 240;
  rasterized.float_pixels = true;
  rasterized.strategy = "sort-first";
  traced.integrator = "direct";

  std::uint64_t different = 1;
  comm::run_threads(2, 1, [&](comm::Communicator& rank) {  // two ranks of one thread each
    const raster::Result first = raster::render(rank, scene, camera, rasterized);
    const raytrace::Result second = raytrace::render(rank, scene, camera, traced);
    if (rank.rank() != 0) return;  // the pictures are on rank 0
    const auto& picture = std::get<image::ImageF>(first.picture);
    different = image::compare(picture, second.image).coverage_differs;
    if (argc > 1) image::write_image(argv[1], picture);
    if (argc > 2) image::write_image(argv[2], second.image);
  });
  std::printf("%llu pixels are covered in one picture only\n",
              static_cast<unsigned long long>(different));
  return different < 50 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
