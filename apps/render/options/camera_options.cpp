// Parses the camera that an option gives, or finds it among the scene's own by name or number;
// messages list those that there are.
#include "apps/render/options/camera_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>

#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "apps/session.h"
#include "scenes/camera_path.h"
#include "scenes/framing.h"

namespace delray::apps {

void add_camera_options(CLI::App& command, CameraOptions& options) {
  CLI::Option* camera =
      command
          .add_option(
              "--camera", options.camera,
              "Camera: name or number (from 1) of one in the scene, or eye,at,up,fov, ten numbers "
              "in the file's coordinates with the vertical field of view in degrees")
          ->type_name("CAMERA")
          ->group(group::kCamera);
  command
      .add_option("--view", options.view,
                  "View that shows everything: default (from the front, right and above), front, "
                  "back, left, right, top, bottom or iso (isometric)")
      ->group(group::kCamera)
      ->excludes(camera);
  choose_from(command, "--view", scenes::view_names());
  command
      .add_option("--clip", options.clip,
                  "Cut through the scene: hide what is nearer to the camera than this distance "
                  "along the view, in units of the scene (default: the camera's near plane)")
      ->type_name("DISTANCE")
      ->group(group::kCamera)
      ->check(number_between(1e-18, 1e18));
}

void set_clip(const CameraOptions& options, scenes::Camera& camera) {
  if (options.clip > 0) camera.near = static_cast<float>(options.clip);
}

namespace {

// The scene's camera of this name or else number, from 1; null if it has none.
const scenes::Camera* find_camera(const scenes::Scene& scene, const std::string& name) {
  for (const scenes::Camera& camera : scene.cameras) {
    if (camera.name == name) return &camera;
  }
  std::size_t number = 0;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data(), end, number);
  const bool known = error == std::errc() && stop == end && number >= 1;
  return known && number <= scene.cameras.size() ? &scene.cameras[number - 1] : nullptr;
}

// For a message.
std::string cameras_of(const scenes::Scene& scene) {
  if (scene.cameras.empty()) return "the scene has no cameras of its own";
  std::string list = "cameras of the scene:";
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    list += fmt::format("{} {} '{}'", i > 0 ? "," : "", i + 1, scene.cameras[i].name);
  }
  return list;
}

scenes::Camera unclipped_camera(const CameraOptions& options, const scenes::Scene& scene,
                                const scenes::FarthestPoints& farthest, float aspect) {
  if (!options.camera.empty()) {
    const auto camera = scenes::parse_camera(options.camera, scene.origin);
    if (camera) return *camera;
    if (const scenes::Camera* own = find_camera(scene, options.camera)) return *own;
    throw UsageError(fmt::format(
        "--camera: '{}' is no camera of the scene, nor eye,at,up,fov: ten numbers separated by "
        "commas, at another place than eye, up other than 0,0,0, the field of view above 0 and "
        "below 180 degrees; {}",
        options.camera, cameras_of(scene)));
  }
  if (!shows_all(options, scene)) return scene.cameras.front();
  const std::string view = options.view.empty() ? "default" : options.view;
  try {
    return scenes::camera_around(farthest, view.c_str(), scene.z_up, aspect);
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("--view: {}", error.what()));
  }
}

}  // namespace

bool shows_all(const CameraOptions& options, const scenes::Scene& scene) {
  return options.camera.empty() && (!options.view.empty() || scene.cameras.empty());
}

std::uint32_t own_camera(const CameraOptions& options, const scenes::Scene& scene) {
  if (shows_all(options, scene)) return scenes::kNone;
  if (options.camera.empty()) return 0;
  if (scenes::parse_camera(options.camera, scene.origin)) return scenes::kNone;
  const scenes::Camera* const own = find_camera(scene, options.camera);
  return own == nullptr ? scenes::kNone : static_cast<std::uint32_t>(own - scene.cameras.data());
}

scenes::Camera choose_camera(const CameraOptions& options, const scenes::Scene& scene,
                             const scenes::FarthestPoints& farthest, float aspect) {
  scenes::Camera camera = unclipped_camera(options, scene, farthest, aspect);
  set_clip(options, camera);
  return camera;
}

}  // namespace delray::apps
