// What comparisons on a scene have in common.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/comparison.h"
#include "apps/render_frames.h"

namespace delray::apps {

struct SceneComparison : ComparisonOptions {
  RenderRequest render;  // scene, camera, size, threads
  std::vector<int> ranks;
};

// Adds SCENE, --size, the camera, --ranks (what it says of its default and of many ranks in
// `ranks`) and --threads.
void add_scene_comparison_options(CLI::App& command, SceneComparison& options,
                                  const std::string& ranks);

// Checks the options, loads the scene, shows progress and tells what `compare` finds.
int run_scene_comparison(
    Session& session, const CLI::App& command, SceneComparison& options,
    const std::function<Found(const Prepared& prepared, parallel::Progress& progress)>& compare);

}  // namespace delray::apps
