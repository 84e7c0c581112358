// Previews of scenes have few triangles: they are to be made and drawn in a small part of the time
// that loading takes, on the threads that load.
#include "apps/input/scene_preview.h"

#include <spdlog/spdlog.h>

#include <exception>
#include <optional>
#include <stdexcept>
#include <utility>

#include "scenes/cluster_vertices.h"

namespace delray::apps {

void offer(const ScenePreview& preview, const std::function<scenes::Scene()>& make) {
  if (!preview) return;
  try {
    preview(make());
  } catch (const std::exception& error) {
    spdlog::debug("no preview: {}", error.what());
  } catch (...) {
    spdlog::debug("no preview");
  }
}

void offer_coarse(const ScenePreview& preview, const scenes::Scene& scene,
                  const std::function<void(scenes::Scene& coarse)>& look) {
  constexpr std::size_t kMostTriangles = 200'000;
  std::size_t triangles = 0;
  for (const scenes::Mesh& mesh : scene.meshes)
    if (mesh.has_triangles() && mesh.normals.empty()) triangles += mesh.triangles.size();
  if (!preview || triangles < kTrianglesWorthAPreview) return;
  offer(preview, [&] {
    std::optional<scenes::Scene> coarse = scenes::cluster_vertices(scene, kMostTriangles);
    if (!coarse) throw std::runtime_error("nothing is left of the scene");
    if (look) look(*coarse);
    return *std::move(coarse);
  });
}

}  // namespace delray::apps
