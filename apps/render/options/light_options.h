// Light besides that of the scene itself: --light, --light-rotation and --light-strength.
#pragma once

#include <string>

#include "files/memory_budget.h"
#include "scenes/scene.h"

namespace CLI {
class App;
}

namespace delray::apps {

struct LightOptions {
  std::string light;      // "none", "default", or a picture; empty: default where nothing else is
  double rotation = 0.0;  // degrees, of the picture
  double strength = 1.0;

  bool is_picture() const { return !light.empty() && light != "none" && light != "default"; }
};

void add_light_options(CLI::App& command, LightOptions& options);

// Throws UsageError for options that have no effect with --light, or without it.
void check_light(const CLI::App& command, const LightOptions& options);

// Puts the picture in place of the scene's environment, where --light names one: as wide as two
// times its height, latitude and longitude, with linear light of any amount (or 8 bits). What is
// negative or no number becomes 0. Throws FileError.
void load_light(const LightOptions& options, const files::MemoryBudget& memory,
                scenes::Scene& scene);

// Adds the default light where the options want it, or leave it open and nothing else lights the
// scene. Returns whether it has.
bool complete_light(const LightOptions& options, const scenes::Camera& camera,
                    scenes::Scene& scene);

}  // namespace delray::apps
