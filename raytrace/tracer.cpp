// Makes instances, Embree's structure and the table of lights of a scene, and adds up what they
// take. A scene counts as large when its meshes do not fit a cache, which makes tracing fetch
// ahead.
#include "raytrace/tracer.h"

#include <algorithm>
#include <chrono>
#include <span>
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

using BuildClock = std::chrono::steady_clock;

double elapsed_since(BuildClock::time_point start) {
  return std::chrono::duration<double>(BuildClock::now() - start).count();
}

bool any_mesh_moves(const scenes::Scene& scene) {
  if (scene.animations.empty()) return false;  // a pack says how meshes are held, and never moves
  return std::ranges::any_of(scenes::mesh_motions(scene), [](scenes::MeshMotion motion) {
    return motion != scenes::MeshMotion::still;
  });
}

// Whether its structure can be refitted.
bool is_refittable(const GeometryInstance& instance) {
  return instance.deforming && instance.mesh != nullptr && instance.mesh->has_triangles() &&
         !instance.mesh->triangles.empty();
}

std::span<const glm::vec3> positions_of(const GeometryInstance& instance) {
  return {instance.positions, instance.mesh->positions.size()};
}

RefitCost refit_cost_of(const GeometryInstance& instance) {
  return {instance.mesh->triangles, positions_of(instance)};
}

// Instances that changed, by what has to be done.
struct Moved {
  std::vector<std::uint32_t> all;            // ascending
  std::vector<std::uint32_t> instanced;      // by a transform
  std::vector<std::uint32_t> bent;           // by vertices in their places
  std::vector<std::uint32_t> attached_anew;  // any other: splats, and meshes that are not shared
};

Moved what_moved(const scenes::Scene& scene, const scenes::Movement& movement,
                 std::span<const GeometryInstance> instances) {
  std::vector<std::uint8_t> changed(instances.size(), 0), bent(scene.meshes.size(), 0);
  for (const std::uint32_t i : movement.instances) changed[i] = 1;
  for (const std::uint32_t m : movement.meshes) bent[m] = 1;
  Moved moved;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (changed[i] == 0 && bent[scene.instances[i].mesh] == 0) continue;
    if (instances[i].mesh == nullptr) continue;
    moved.all.push_back(i);
    if (instances[i].instanced) {
      moved.instanced.push_back(i);
    } else if (is_refittable(instances[i])) {
      moved.bent.push_back(i);
    } else {
      moved.attached_anew.push_back(i);
    }
  }
  return moved;
}

bool moved_glows(const Tracer& tracer, std::span<const std::uint32_t> moved) {
  return std::ranges::any_of(moved, [&](std::uint32_t i) {
    return tracer.shader.materials[tracer.instances[i].material].emission != glm::vec3(0.0F);
  });
}

}  // namespace

bool is_large(std::uint64_t bytes) { return bytes > kManyBytes; }

Tracer make_tracer(const scenes::Scene& scene, const BuildOptions& options) {
  return make_tracer(scene, shading::make_shader(scene), options);
}

Tracer make_tracer(const scenes::Scene& scene, shading::Shader shader,
                   const BuildOptions& options) {
  const BuildClock::time_point start = BuildClock::now();
  std::vector<GeometryInstance> instances = make_instances(scene, shader, options.share_meshes);
  const std::uint64_t degenerate = count_degenerate(instances);
  BuildOptions build = options;
  build.changing = options.changing || any_mesh_moves(scene);
  EmbreeScene embree(instances, build);
  LightTable lights(scene, shader);
  std::unordered_map<std::uint32_t, RefitCost> costs;
  for (std::uint32_t i = 0; i < instances.size(); ++i)
    if (is_refittable(instances[i])) costs.try_emplace(i, refit_cost_of(instances[i]));
  const double seconds = elapsed_since(start);
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
          seconds,
          large,
          bytes,
          options.refit_limit,
          std::move(costs)};
}

FollowCounts follow(Tracer& tracer, const scenes::Scene& scene, const scenes::Movement& movement) {
  const BuildClock::time_point start = BuildClock::now();
  FollowCounts counts;
  const Moved moved = what_moved(scene, movement, tracer.instances);
  counts.moved = static_cast<std::uint32_t>(movement.instances.size());
  for (const std::uint32_t i : moved.all) follow(scene, i, tracer.instances[i]);

  std::vector<std::uint32_t> refitted, built;
  for (const std::uint32_t i : moved.bent) {
    const GeometryInstance& instance = tracer.instances[i];
    RefitCost& cost = tracer.refit_costs.at(i);
    const bool is_good =
        cost.growth(instance.mesh->triangles, positions_of(instance)) <= tracer.refit_limit;
    (is_good ? refitted : built).push_back(i);
    if (!is_good) cost = refit_cost_of(instance);
  }
  counts.refitted = static_cast<std::uint32_t>(refitted.size());
  counts.built = static_cast<std::uint32_t>(built.size());
  BuildClock::time_point before = BuildClock::now();
  const auto take = [&](double& seconds) {
    seconds += elapsed_since(before);
    before = BuildClock::now();
  };
  if (!moved.attached_anew.empty()) {
    tracer.embree.change(moved.attached_anew, tracer.instances, {});
    take(counts.build_seconds);
  }
  if (!built.empty()) {
    tracer.embree.move(moved.instanced, built, true, tracer.instances);
    take(counts.build_seconds);
  }
  if (!refitted.empty()) {
    tracer.embree.move(built.empty() ? moved.instanced : std::vector<std::uint32_t>(), refitted,
                       false, tracer.instances);
    take(counts.refit_seconds);
  }
  if (built.empty() && refitted.empty() && !moved.instanced.empty()) {
    tracer.embree.move(moved.instanced, {}, false, tracer.instances);
    take(counts.top_seconds);
  }
  if (movement.lights) tracer.shader.lights = scene.lights;
  if (movement.lights || moved_glows(tracer, moved.all))
    tracer.lights = LightTable(scene, tracer.shader);
  counts.seconds = elapsed_since(start);
  return counts;
}

}  // namespace delray::raytrace
