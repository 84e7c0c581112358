// Options and output that comparisons on a scene have in common.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/compare/comparison.h"
#include "apps/render/render_frames.h"

namespace delray::apps {

struct SceneComparison : ComparisonOptions {
  RenderRequest render;  // scene, camera, size
  std::vector<int> ranks;
};

// More ranks than this do not run: they are predicted.
inline constexpr int kMostMeasuredRanks = 64;

// Adds SCENE, --size, the camera, and --ranks, which says `ranks` of its default and of many.
void add_scene_comparison_options(CLI::App& command, SceneComparison& options,
                                  const std::string& ranks);

// Checks the options, loads the scene, shows progress and tells what `compare` finds.
int run_scene_comparison(
    Session& session, const CLI::App& command, SceneComparison& options,
    const std::function<Found(const Prepared& prepared, parallel::Progress& progress)>& compare);

// "scene" of their JSON.
Json scene_json(const SceneComparison& options, const Prepared& prepared);
// "networks": what predictions are of.
Json networks_json();

}  // namespace delray::apps
