#include "raytrace/tracer.h"

#include <chrono>
#include <utility>

namespace delray::raytrace {

Tracer make_tracer(const scenes::Scene& scene, const BuildOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  shading::Shader shader = shading::make_shader(scene);
  std::vector<Placement> placements = place(scene, shader, options.share_meshes);
  const std::uint64_t degenerate = count_degenerate(placements);
  EmbreeScene embree(placements, options);
  LightTable lights(scene, shader);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return {std::move(shader), std::move(placements), std::move(embree), std::move(lights),
          degenerate,        seconds.count()};
}

}  // namespace delray::raytrace
