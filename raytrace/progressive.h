// A picture pass by pass: every pass gives each pixel that is not yet good enough another chunk of
// samples. Between passes rank 0 has the whole picture so far, to show it, to keep it, and to find
// out where noise is left.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "raytrace/features.h"
#include "raytrace/film.h"
#include "raytrace/render.h"

namespace delray::raytrace {

// When a picture that grows pass by pass is done.
struct ProgressiveOptions {
  RenderOptions frame;  // its samples are the most that a pixel gets; its part is set by the passes
  geometry::Rect window;  // of the frame, as a part of it; empty: all of it

  // A cell of pixels is done when its noise (film.h) is no more than this; 0: when it has all of
  // its samples. Samples lie anywhere in their pixels then, and not on a grid, of which only the
  // whole would be even.
  float noise = 0.0F;

  // No pass begins that would not end within so many seconds of the call, but for the first.
  double seconds = std::numeric_limits<double>::infinity();

  // A pass is rendered in parts of about so many seconds (cells, row by row). Before each of them
  // `goes_on`, on rank 0, may end the call.
  double part_seconds = std::numeric_limits<double>::infinity();
  std::function<bool()> goes_on;

  bool features = false;
  bool film =
      true;  // whether the result is to have one; a call of a single pass is quicker without

  // On rank 0, where there may be a film of an earlier call with the same options and scene, which
  // is gone on from: with the same result as if nothing had happened.
  const Film* resume = nullptr;
  std::span<const std::uint8_t> resume_cells;        // cells_left of that call
  std::function<void(const Film&)> after_pass;       // on rank 0
  std::function<void(const Film&)> on_interruption;  // on rank 0, before anything is thrown
};

// On rank 0; elsewhere all but the statistics of the call is empty.
struct ProgressiveResult {
  image::ImageF image;               // of the window; of size 0 where there are displays
  std::vector<image::ImageF> shown;  // on any rank, of its displays
  Film film;              // of a window that may be larger: see grown; empty where not asked for
  Features features;      // of the window
  Statistics statistics;  // of all passes together
  int passes = 0;         // of this call
  bool out_of_time = false;
  bool stopped = false;  // by goes_on
  // Of a pass that was cut short, by cell: 1 if its part of the pass is missing; empty where
  // none was.
  std::vector<std::uint8_t> cells_left;
};

// The smallest window around `window`, a part of `frame`, that can be rendered by itself with the
// same bytes as in the whole.
geometry::Rect grown(const geometry::Rect& window, const geometry::Rect& frame);

// The pixels of `window` alone, of a picture of `of`. REQUIRES: `of` contains `window`.
image::ImageF cut(image::ImageF&& picture, const geometry::Rect& of, const geometry::Rect& window);

// Collective. The same bytes for every number of ranks and threads, and however often it was
// interrupted; not so when time runs out. Throws what Renderer::render throws.
//
// REQUIRES: as Renderer::render; the window lies within the frame.
ProgressiveResult render_progressively(comm::Communicator& communicator, Renderer& renderer,
                                       const scenes::Camera& camera,
                                       const ProgressiveOptions& options);

}  // namespace delray::raytrace
