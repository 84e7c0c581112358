// Options of `delray render` for rays in practice: how long to trace and how well, what to keep
// meanwhile, which part of the picture, and what is made of it in the end.
#pragma once

#include <string>

#include "geometry/rect.h"

namespace CLI {
class App;
}

namespace delray::apps {

struct RenderRequest;

struct Practice {
  double seconds = 0.0;  // 0: no limit
  double noise = 0.0;    // 0: all samples
  double preview_every = 0.0;
  std::string checkpoint;
  double checkpoint_every = 60.0;
  bool resume = false;
  std::string crop;  // x,y,width,height
  bool channels = false, denoise = false;
  std::string show = "colour", tone = "linear";
  double exposure = 0.0;
  double aperture = 0.0, focus = 0.0;
  std::uint64_t seed = 0;

  // Set by check:
  geometry::Rect window;  // of the frame
};

void add_practice_options(CLI::App& command, Practice& practice);

// Refuses all of them: the engine is no ray tracer. Throws UsageError.
void refuse_practice(const CLI::App& command);

// Completes and checks; the request's size is known. Throws UsageError.
void check_practice(const CLI::App& command, RenderRequest& request);

}  // namespace delray::apps
