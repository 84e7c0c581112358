#include "apps/camera_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cmath>

#include "apps/session.h"

namespace delray::apps {
namespace {

// Ten numbers between commas. Throws UsageError.
std::array<double, 10> parse_numbers(const std::string& text) {
  std::array<double, 10> numbers{};
  const char* next = text.data();
  const char* const end = text.data() + text.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto [stop, error] = std::from_chars(next, end, numbers[i]);
    const bool last = i + 1 == numbers.size();
    if (error != std::errc() || !std::isfinite(numbers[i]) ||
        (last ? stop != end : stop == end || *stop != ',')) {
      throw UsageError(fmt::format(
          "--camera: '{}' is not eye,at,up,fov: ten numbers separated by commas", text));
    }
    next = stop + 1;
  }
  return numbers;
}

scenes::Camera parse_camera(const std::string& text, const glm::dvec3& origin) {
  const std::array<double, 10> n = parse_numbers(text);
  if (!(n[9] > 0 && n[9] < 180)) {
    throw UsageError("--camera: the field of view is not between 0 and 180 degrees");
  }
  scenes::Camera camera;
  camera.eye = glm::vec3(glm::dvec3(n[0], n[1], n[2]) - origin);
  camera.at = glm::vec3(glm::dvec3(n[3], n[4], n[5]) - origin);
  camera.up = glm::vec3(n[6], n[7], n[8]);
  camera.vertical_fov = static_cast<float>(n[9]);
  return camera;
}

}  // namespace

void add_camera_options(CLI::App& command, CameraOptions& options) {
  CLI::Option* camera = command.add_option(
      "--camera", options.camera,
      "eye,at,up,fov: ten numbers, in the coordinates of the file, fov vertical in degrees");
  command
      .add_option("--view", options.view, "default, front, back, left, right, top, bottom or iso")
      ->excludes(camera);
}

scenes::Camera choose_camera(const CameraOptions& options, const scenes::Scene& scene,
                             float aspect) {
  if (!options.camera.empty()) return parse_camera(options.camera, scene.origin);
  if (options.view.empty() && !scene.cameras.empty()) return scene.cameras.front();
  const std::string view = options.view.empty() ? "default" : options.view;
  try {
    return scenes::camera_around(scenes::bounds(scene), view.c_str(), scene.z_up, aspect);
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("--view: {}", error.what()));
  }
}

}  // namespace delray::apps
