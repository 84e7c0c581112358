// Parses cameras, turns them about an axis (Rodrigues' rotation) and interpolates them between
// keys.
//
// Between keys each number follows a cubic Hermite curve whose slopes are differences of the
// neighbouring keys over their times (Catmull and Rom 1974). Degenerate: beyond the first and last
// key the curve goes on straight; an `up` without length turns nothing; fields of view are kept
// between 0 and 180 degrees.
#include "scenes/camera_path.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>

#include "files/error.h"
#include "files/read_file.h"

namespace delray::scenes {
namespace {

// A camera is so many numbers: eye, at, up, field of view.
constexpr std::size_t kNumbers = 10;
using Numbers = std::array<double, kNumbers>;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::optional<Numbers> parse_numbers(std::string_view text) {
  Numbers numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == numbers.size())) return std::nullopt;
    const std::string_view word = trimmed(text.substr(0, comma));
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), numbers[i]);
    const bool whole = error == std::errc() && stop == word.data() + word.size();
    if (!whole || !std::isfinite(numbers[i])) return std::nullopt;
    if (comma != std::string_view::npos) text.remove_prefix(comma + 1);
  }
  return numbers;
}

Camera camera_of(const Numbers& n, const glm::dvec3& origin) {
  Camera camera;
  camera.eye = glm::vec3(glm::dvec3(n[0], n[1], n[2]) - origin);
  camera.at = glm::vec3(glm::dvec3(n[3], n[4], n[5]) - origin);
  camera.up = glm::vec3(n[6], n[7], n[8]);
  camera.vertical_fov = static_cast<float>(n[9]);
  return camera;
}

Numbers numbers_of(const Camera& camera) {
  const glm::vec3 &e = camera.eye, &a = camera.at, &u = camera.up;
  return {e.x, e.y, e.z, a.x, a.y, a.z, u.x, u.y, u.z, camera.vertical_fov};
}

// Where the curve through four values goes between the two in the middle, at times t[0] < .. <
// t[3]; x from 0 to 1.
double between(const std::array<double, 4>& value, const std::array<double, 4>& t, double x) {
  const double span = t[2] - t[1];
  const double slope1 = (value[2] - value[0]) / (t[2] - t[0]) * span;
  const double slope2 = (value[3] - value[1]) / (t[3] - t[1]) * span;
  const double x2 = x * x, x3 = x2 * x;
  return value[1] * (2 * x3 - 3 * x2 + 1) + slope1 * (x3 - 2 * x2 + x) +
         value[2] * (3 * x2 - 2 * x3) + slope2 * (x3 - x2);
}

}  // namespace

std::optional<Camera> parse_camera(std::string_view text, const glm::dvec3& origin) {
  const std::optional<Numbers> numbers = parse_numbers(text);
  if (!numbers || !(numbers->back() > 0 && numbers->back() < 180)) return std::nullopt;
  const Camera camera = camera_of(*numbers, origin);
  if (camera.eye == camera.at || camera.up == glm::vec3(0)) return std::nullopt;
  return camera;
}

std::vector<Camera> turntable(const Camera& camera, int frames) {
  return turntable(camera, frames, camera.at);
}

std::vector<Camera> turntable(const Camera& camera, int frames, const glm::dvec3& pivot) {
  std::vector<Camera> result(static_cast<std::size_t>(frames), camera);
  const glm::dvec3 up(camera.up);
  const double length = glm::length(up);
  if (!(length > 0)) return result;
  const glm::dvec3 axis = up / length;
  for (int i = 1; i < frames; ++i) {
    const double angle = 2 * std::numbers::pi * i / frames;
    const auto turned = [&](const glm::vec3& p) {  // Rodrigues' rotation
      const glm::dvec3 arm = glm::dvec3(p) - pivot;
      return glm::vec3(pivot + arm * std::cos(angle) + glm::cross(axis, arm) * std::sin(angle) +
                       axis * (glm::dot(axis, arm) * (1 - std::cos(angle))));
    };
    Camera& at_frame = result[static_cast<std::size_t>(i)];
    at_frame.eye = turned(camera.eye);
    if (pivot != glm::dvec3(camera.at)) at_frame.at = turned(camera.at);
  }
  return result;
}

std::vector<CameraKey> read_camera_path(const std::filesystem::path& path, const glm::dvec3& origin,
                                        const files::MemoryBudget& memory) {
  constexpr std::size_t kStart = 4096;
  // A file that is no text may have no end.
  if (files::read_start(path, kStart, memory).find('\0') != std::string::npos) {
    throw files::FileError(files::Cause::input, path.string(), "line 1", "is not text");
  }
  return parse_camera_path(files::read_file(path, memory), path.string(), origin);
}

std::vector<CameraKey> parse_camera_path(std::string_view text, const std::string& name,
                                         const glm::dvec3& origin) {
  constexpr int kLastFrame = 1'000'000;
  std::vector<CameraKey> keys;
  std::size_t line = 0;
  const auto fail = [&](const std::string& what) {
    throw files::FileError(files::Cause::input, name, "line " + std::to_string(line), what);
  };
  for (std::string_view rest = text; !rest.empty();) {
    ++line;
    const std::size_t end = rest.find('\n');
    std::string_view content = trimmed(rest.substr(0, end).substr(0, rest.find('#')));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (content.empty()) continue;
    CameraKey key{keys.empty() ? 0 : keys.back().frame + 1, {}};
    if (const std::size_t colon = content.find(':'); colon != std::string_view::npos) {
      const std::string_view word = trimmed(content.substr(0, colon));
      const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), key.frame);
      if (error != std::errc() || stop != word.data() + word.size() || key.frame < 0) {
        fail("'" + std::string(word) + "' is not the number of a frame");
      }
      if (!keys.empty() && key.frame <= keys.back().frame) fail("frames do not ascend");
      content = content.substr(colon + 1);
    }
    if (key.frame > kLastFrame) fail("more than a million frames");
    const std::optional<Camera> camera = parse_camera(trimmed(content), origin);
    if (!camera) {
      fail("'" + std::string(trimmed(content)) +
           "' is not eye,at,up,fov: ten numbers separated by commas, at another place than eye, up "
           "other than 0,0,0, the last above 0 and below 180");
    }
    key.camera = *camera;
    keys.push_back(key);
  }
  if (keys.empty()) fail("there is no camera");
  return keys;
}

std::vector<Camera> interpolate(const std::vector<CameraKey>& keys) {
  std::vector<Camera> result;
  if (keys.empty()) return result;
  for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
    // Beyond the ends the curve goes on straight.
    const Numbers from = numbers_of(keys[i].camera), to = numbers_of(keys[i + 1].camera);
    const double t1 = keys[i].frame, t2 = keys[i + 1].frame;
    const bool first = i == 0, last = i + 2 == keys.size();
    const double t0 = first ? t1 - (t2 - t1) : keys[i - 1].frame;
    const double t3 = last ? t2 + (t2 - t1) : keys[i + 2].frame;
    const Numbers before = first ? from : numbers_of(keys[i - 1].camera);
    const Numbers after = last ? to : numbers_of(keys[i + 2].camera);
    result.push_back(keys[i].camera);
    for (int frame = keys[i].frame + 1; frame < keys[i + 1].frame; ++frame) {
      Numbers now{};
      for (std::size_t k = 0; k < now.size(); ++k) {
        const double v0 = first ? 2 * from[k] - to[k] : before[k];
        const double v3 = last ? 2 * to[k] - from[k] : after[k];
        now[k] = between({v0, from[k], to[k], v3}, {t0, t1, t2, t3}, (frame - t1) / (t2 - t1));
      }
      Camera camera = camera_of(now, glm::dvec3(0));
      camera.near = keys[i].camera.near;
      constexpr float kNarrowest = 1e-3F, kWidest = 179.0F;
      camera.vertical_fov = std::clamp(camera.vertical_fov, kNarrowest, kWidest);
      result.push_back(camera);
    }
  }
  result.push_back(keys.back().camera);
  return result;
}

}  // namespace delray::scenes
