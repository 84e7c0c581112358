#include "apps/camera_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/session.h"
#include "scenes/camera_path.h"
#include "scenes/framing.h"

namespace delray::apps {

void add_camera_options(CLI::App& command, CameraOptions& options) {
  CLI::Option* camera = command.add_option(
      "--camera", options.camera,
      "eye,at,up,fov: ten numbers, in the coordinates of the file, fov vertical in degrees");
  command
      .add_option("--view", options.view, "default, front, back, left, right, top, bottom or iso")
      ->excludes(camera);
}

bool shows_all(const CameraOptions& options, const scenes::Scene& scene) {
  return options.camera.empty() && (!options.view.empty() || scene.cameras.empty());
}

scenes::Camera choose_camera(const CameraOptions& options, const scenes::Scene& scene,
                             const scenes::FarthestPoints& farthest, float aspect) {
  if (!options.camera.empty()) {
    const auto camera = scenes::parse_camera(options.camera, scene.origin);
    if (camera) return *camera;
    throw UsageError(fmt::format(
        "--camera: '{}' is not eye,at,up,fov: ten numbers separated by commas, the field of view "
        "above 0 and below 180 degrees",
        options.camera));
  }
  if (!shows_all(options, scene)) return scene.cameras.front();
  const std::string view = options.view.empty() ? "default" : options.view;
  try {
    return scenes::camera_around(farthest, view.c_str(), scene.z_up, aspect);
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("--view: {}", error.what()));
  }
}

}  // namespace delray::apps
