// --camera, --view and --clip: where the scene is seen from.
#pragma once

#include <string>

#include "scenes/extent.h"
#include "scenes/scene.h"

namespace CLI {
class App;
}

namespace delray::apps {

struct CameraOptions {
  std::string camera;  // "eye,at,up,fov": ten numbers; or one of the scene's
  std::string view;    // a name that camera_around knows
  double clip = 0;     // distance of the near plane, in units of the scene; 0: the camera's own
};

void add_camera_options(CLI::App& command, CameraOptions& options);

// Moves the near plane to where --clip wants it. Of an orthographic camera whose `far` is no
// farther than that, scenes::make_view moves that one, too.
void set_clip(const CameraOptions& options, scenes::Camera& camera);

// Whether the camera is one that shows all of the scene, not one that somebody placed.
bool shows_all(const CameraOptions& options, const scenes::Scene& scene);

// The number of the scene's own camera that choose_camera gives; kNone where it gives another.
std::uint32_t own_camera(const CameraOptions& options, const scenes::Scene& scene);

// The camera of --camera or --view, else the scene's own first camera, else one that shows all of
// it. `farthest` knows all points of the scene, and is asked for the cameras that show it only.
// Clipped by --clip. Throws UsageError.
scenes::Camera choose_camera(const CameraOptions& options, const scenes::Scene& scene,
                             const scenes::FarthestPoints& farthest, float aspect);

}  // namespace delray::apps
