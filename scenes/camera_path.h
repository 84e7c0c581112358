// Cameras over time.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/memory_budget.h"
#include "scenes/camera.h"

namespace delray::scenes {

// "eye,at,up,fov": ten numbers between commas, the field of view vertical in degrees, between 0 and
// 180. Eye and at are relative to `origin` in the result. Nothing for any other text, and where eye
// and at are one place as floats or up is 0.
std::optional<Camera> parse_camera(std::string_view text, const glm::dvec3& origin);

// Once around the point that the camera looks at, about its `up`, counter-clockwise seen from
// above: frame i is turned by i / frames of a circle, frame 0 is the camera itself.
std::vector<Camera> turntable(const Camera& camera, int frames);
// A turntable about an axis through `pivot`, which `at` goes round as well.
std::vector<Camera> turntable(const Camera& camera, int frames, const glm::dvec3& pivot);

// A camera at a frame of an animation.
struct CameraKey {
  int frame = 0;
  Camera camera;
};

// Keys from a text file, one in a line: "FRAME: eye,at,up,fov" or, one frame after the last,
// "eye,at,up,fov"; coordinates are those of the file that `origin` was taken from (Scene::origin).
// Empty lines and what follows a # are passed over. At least one key; frames ascend from 0 on.
//
// Throws files::FileError with the line of what is wrong, or if the file takes more than `memory`.
std::vector<CameraKey> read_camera_path(const std::filesystem::path& path, const glm::dvec3& origin,
                                        const files::MemoryBudget& memory = {});
// Reads a camera path from a text; `name` is what errors call it.
std::vector<CameraKey> parse_camera_path(std::string_view text, const std::string& name,
                                         const glm::dvec3& origin);

// The cameras of all frames from the first key to the last: keys exactly, and between them a smooth
// curve through them (Catmull & Rom 1974, with the times of the keys) for every coordinate.
//
// REQUIRES: keys ascend strictly.
std::vector<Camera> interpolate(const std::vector<CameraKey>& keys);

}  // namespace delray::scenes
