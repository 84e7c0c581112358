// Makes instances, Embree's structure and the table of lights of a scene, and adds up what they
// take. A scene counts as large when its meshes do not fit a cache, which makes tracing fetch
// ahead.
#include "raytrace/tracer.h"

#include <chrono>
#include <utility>

namespace delray::raytrace {
namespace {

// Of what meshes know of hits: the larger part of a cache that tracing fills as well.
constexpr std::uint64_t kManyBytes = 2 << 20;

template <class T>
std::size_t array_bytes(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

std::size_t array_bytes(const scenes::Mesh& mesh) {
  return array_bytes(mesh.triangles) + array_bytes(mesh.positions) + array_bytes(mesh.normals) +
         array_bytes(mesh.uvs) + array_bytes(mesh.uvs2) + array_bytes(mesh.colours) +
         array_bytes(mesh.tangents);
}

}  // namespace

bool is_large(std::uint64_t bytes) { return bytes > kManyBytes; }

Tracer make_tracer(const scenes::Scene& scene, const BuildOptions& options) {
  return make_tracer(scene, shading::make_shader(scene), options);
}

Tracer make_tracer(const scenes::Scene& scene, shading::Shader shader,
                   const BuildOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<GeometryInstance> instances = make_instances(scene, shader, options.share_meshes);
  const std::uint64_t degenerate = count_degenerate(instances);
  EmbreeScene embree(instances, options);
  LightTable lights(scene, shader);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::size_t bytes = 0;
  for (const scenes::Mesh& mesh : scene.meshes) bytes += array_bytes(mesh);
  const bool large = is_large(bytes);
  for (const GeometryInstance& instance : instances) bytes += array_bytes(instance.moved);
  bytes += embree.memory();
  return {std::move(shader),
          std::move(instances),
          std::move(embree),
          std::move(lights),
          degenerate,
          seconds.count(),
          large,
          bytes};
}

}  // namespace delray::raytrace
