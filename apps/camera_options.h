// --camera and --view: where the scene is seen from.
#pragma once

#include <string>

#include "scenes/scene.h"

namespace CLI {
class App;
}

namespace delray::apps {

struct CameraOptions {
  std::string camera;  // "eye,at,up,fov": ten numbers
  std::string view;    // a name that camera_around knows
};

void add_camera_options(CLI::App& command, CameraOptions& options);

// What --camera or --view say, else the scene's own first camera, else one that shows all of it.
// Throws UsageError.
scenes::Camera choose_camera(const CameraOptions& options, const scenes::Scene& scene,
                             float aspect);

}  // namespace delray::apps
