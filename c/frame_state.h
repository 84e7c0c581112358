// What a frame has of its own: the scene as it was last built, the ranks, the picture.
#pragma once

#include <memory>
#include <vector>

#include "comm/communicator.h"
#include "image/image.h"
#include "raster/render.h"
#include "raytrace/render.h"
#include "raytrace/tracer.h"
#include "scenes/scene.h"

struct DelrayObject_;

namespace delray::c {

// A scene with what an engine has built of it. Made anew when a commit changed the scene.
struct Built {
  const DelrayObject_* world = nullptr;
  std::uint64_t scene_changes = 0;
  bool is_raytrace = false;
  scenes::Scene scene;
  bool is_transparent = false;  // some material lets through
  std::unique_ptr<raster::Renderer> raster;
  std::unique_ptr<const raytrace::Tracer> tracer;
};

// What a frame keeps between renderings.
struct FrameState {
  std::unique_ptr<Built> built;
  const void* mpi_communicator = nullptr;  // whose duplicate `ranks` is
  std::unique_ptr<comm::Communicator> ranks;

  // The picture, its lowest row first; no pixels before the first.
  int width = 0, height = 0;
  image::Plane<image::Rgba8> codes;
  image::Plane<image::RgbaF> light;
  image::Plane<float> depth;
  double seconds = 0;
  int samples = 0;
};

}  // namespace delray::c
