// Pictures by ray tracing over ranks and threads; every rank has the whole scene.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "comm/communicator.h"
#include "image/image.h"
#include "parallel/progress.h"
#include "raytrace/integrator.h"
#include "raytrace/tracer.h"
#include "scenes/camera.h"
#include "scenes/scene.h"

namespace delray::raytrace {

struct RenderOptions {
  int width = 1280, height = 720;
  int samples = 1;  // per pixel; 1: in its centre
  TraceOptions trace;
  std::string integrator = "whitted";
  std::string schedule = "interlaced";
  BuildOptions build;                      // where a tracer is made
  parallel::Progress* progress = nullptr;  // steps are this rank's tiles
};

// Of one rank and frame.
struct RankStatistics {
  double busy = 0.0;  // seconds of processor time that its threads spent on tiles
  std::uint64_t tasks = 0;
  RayCounts rays;
  std::uint64_t bytes_sent = 0, bytes_received = 0, messages = 0;  // of pixels, counted as sent
};

struct Statistics {
  double build_seconds = 0.0, frame_seconds = 0.0;
  double trace_seconds = 0.0, gather_seconds = 0.0;  // of rank 0; shading is part of trace
  RayCounts rays;                                    // of all ranks
  std::uint64_t degenerate = 0;                      // triangles that can never be hit
  std::uint64_t structure_bytes = 0;                 // of the acceleration structure
  std::vector<RankStatistics> ranks;
  std::string embree_version, embree_isa;
};

// On rank 0; other ranks get an empty image and no ranks' statistics.
struct Result {
  image::ImageF image;  // linear, premultiplied; depth along the view axis
  Statistics statistics;
};

// Collective. Same bytes for every number of ranks and threads (and the same Embree instruction
// set). Works in the caller's arena; with no width or height the image is empty. Of several samples
// colours are averaged and the least depth is kept. Throws std::invalid_argument for unknown names,
// parallel::Interrupted when the progress is told to stop.
//
// REQUIRES: samples >= 1, depth >= 0; the same scene, camera and options on every rank.
Result render(comm::Communicator& communicator, const Tracer& tracer, const scenes::Camera& camera,
              const RenderOptions& options);

// Makes the tracer first, which every rank does for itself.
Result render(comm::Communicator& communicator, const scenes::Scene& scene,
              const scenes::Camera& camera, const RenderOptions& options);

}  // namespace delray::raytrace
