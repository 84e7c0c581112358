// A frame's picture, from the renderers' form to that of its channels.
#pragma once

#include "c/frame_state.h"
#include "c/object.h"
#include "raster/render.h"
#include "scenes/camera.h"

namespace delray::c {

// The committed state of a frame that is to be rendered.
struct Task {
  DelrayObject world, camera, renderer;
  int width = 0, height = 0;
  DelrayDataType colour = DELRAY_UNKNOWN, depth = DELRAY_UNKNOWN;
  bool is_raytrace = false;
  int samples = 1;
  scenes::Camera view;
};

// Keeps a picture that a renderer made as the frame's channels: over the renderer's background, of
// the types that are asked for, the lowest row first, depths as distances from the camera's
// position. An empty picture, of ranks other than 0, leaves none. Parallel in part.
void keep(raster::Picture&& picture, const Task& task, FrameState& state);

}  // namespace delray::c
