// Cameras that show a whole scene.
#pragma once

#include <string>
#include <vector>

#include "scenes/camera.h"
#include "scenes/extent.h"

namespace delray::scenes {

// default, front, back, left, right, top, bottom, iso.
std::vector<std::string> view_names();

// The camera from a side, as near as it can be with all points in the frame, 5 % of its width away
// from the left and right edge and 5 % of its height from the upper and lower. The points lie in
// the middle of the frame: as far from the left edge as from the right, as far from the upper as
// from the lower.
//
// name: one of view_names. `z_up` for terrains and point data.
// Points that hardly differ give a camera that looks at them, no points one that looks at the
// origin. Asks `farthest` at most some ten times. Throws std::invalid_argument for other names.
Camera camera_around(const FarthestPoints& farthest, const char* name, bool z_up, float aspect);

// Around the corners of a box.
Camera camera_around(const geometry::Box3& box, const char* name, bool z_up, float aspect);

// Around what is drawn of a scene, or the part of it in Scene::framed.
Camera camera_around(const Scene& scene, const char* name, float aspect);

// The space that an object on a turntable takes up: the points themselves and in `turns` - 1 equal
// steps about an axis through the middle of their box, such as Camera::up. For a camera around
// that, no turn leaves the frame. Refers to `farthest`. REQUIRES: the axis has a length.
FarthestPoints turned(const FarthestPoints& farthest, const glm::dvec3& axis, int turns);

}  // namespace delray::scenes
