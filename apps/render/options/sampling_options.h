// Options of `delray render` for ray tracing: how long to trace and how well, what to keep
// meanwhile, which part of the picture, and what is made of it in the end.
#pragma once

#include <string>

#include "geometry/rect.h"

namespace CLI {
class App;
}

namespace delray::apps {

struct RenderRequest;

struct SamplingOptions {
  double reuse = 0;      // share of the pixels of a frame that are traced; 0: all of every frame
  double seconds = 0.0;  // 0: no limit
  double noise = 0.0;    // 0: all samples
  double preview_every = 0.0;
  std::string checkpoint;
  double checkpoint_every = 60.0;
  bool resume = false;
  bool channels = false, denoise = false;
  std::string show = "colour", tone = "linear";
  double exposure = 0.0;
  double aperture = 0.0, focus = 0.0;
};

// Completes options that were not given: samples by noise or time.
void complete_sampling(const CLI::App& command, RenderRequest& request);

// Throws UsageError for what is missing.
void check_sampling(const RenderRequest& request);

}  // namespace delray::apps
