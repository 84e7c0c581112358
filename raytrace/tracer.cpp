#include "raytrace/tracer.h"

#include <chrono>
#include <utility>

namespace delray::raytrace {
namespace {

// With normals some 3 MB.
constexpr std::size_t kManyTriangles = 1 << 17;

}  // namespace

Tracer make_tracer(const scenes::Scene& scene, const BuildOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  shading::Shader shader = shading::make_shader(scene);
  std::vector<Placement> placements = place(scene, shader, options.share_meshes);
  const std::uint64_t degenerate = count_degenerate(placements);
  EmbreeScene embree(placements, options);
  LightTable lights(scene, shader);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::size_t triangles = 0;
  for (const scenes::Mesh& mesh : scene.meshes) triangles += mesh.triangles.size();
  return {std::move(shader), std::move(placements), std::move(embree),         std::move(lights),
          degenerate,        seconds.count(),       triangles > kManyTriangles};
}

}  // namespace delray::raytrace
