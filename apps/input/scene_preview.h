// Some of a scene, to be shown while the rest is loaded.
#pragma once

#include <cstddef>
#include <functional>

#include "scenes/scene.h"

namespace delray::apps {

// Gets it.
using ScenePreview = std::function<void(scenes::Scene&& scene)>;

// Fewer triangles get their normals, which takes most of the time, in about a second. A scene that
// has its own is there almost as soon as a preview would be, which would take half as long again.
inline constexpr std::size_t kTrianglesWorthAPreview = 2'000'000;

// Gives `preview` what make() makes, where there is one. Whatever is wrong with it is wrong with
// the preview alone, which nobody depends on: it is told in the log, for who looks for it.
void offer(const ScenePreview& preview, const std::function<scenes::Scene()>& make);

// Offers a coarse form of the scene (scenes/cluster_vertices.h), which look() may change, where it
// has so many triangles without normals.
void offer_coarse(const ScenePreview& preview, const scenes::Scene& scene,
                  const std::function<void(scenes::Scene& coarse)>& look = {});

}  // namespace delray::apps
