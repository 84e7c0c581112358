// Options and output that comparisons on a scene have in common.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/compare/comparison.h"
#include "apps/options/network_option.h"
#include "apps/render/render_frames.h"

namespace delray::apps {

struct SceneComparison : ComparisonOptions {
  RenderRequest render;  // scene, camera, size
  std::vector<int> ranks;
  NetworkChoice network;
  // Those by default; those chosen when run_scene_comparison() compares.
  std::vector<comm::NamedNetwork> networks{comm::default_networks().begin(),
                                           comm::default_networks().end()};
};

// More ranks than this do not run: they are predicted.
inline constexpr int kMostMeasuredRanks = 64;

// Adds SCENE, --size, the camera, --network, and --ranks, which says `ranks` of its default and of
// many.
void add_scene_comparison_options(CLI::App& command, SceneComparison& options,
                                  const std::string& ranks);

// Checks the options, loads the scene, shows progress and tells what `compare` finds.
int run_scene_comparison(
    Session& session, const CLI::App& command, SceneComparison& options,
    const std::function<Found(const Prepared& prepared, parallel::Progress& progress)>& compare);

// "scene" of their JSON.
Json scene_json(const SceneComparison& options, const Prepared& prepared);
// "networks": what predictions are of, each as a file that --network reads.
Json networks_json(std::span<const comm::NamedNetwork> networks);

}  // namespace delray::apps
