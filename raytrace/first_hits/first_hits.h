// First hits of camera rays by rasterization, to the last bit those that Embree finds.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "raytrace/first_hits/draw_triangles.h"
#include "raytrace/first_hits/triangle_bins.h"
#include "raytrace/scene/ray_batch.h"
#include "raytrace/tracer.h"

namespace delray::raytrace {

// The triangles that one frame's camera rays may hit, by where on the picture that is. Any number
// of threads may look for hits at the same time.
class FirstHits {
 public:
  // What was tried in frames before, of one tracer.
  struct Trials {
    std::optional<bool> same;  // whether Embree's arithmetic is the one that is known here
    int rest = 0;              // frames to trace before rasterizing is tried again
  };
  // Of a window of a view whose rays go through the centres of pixels, or anywhere through them;
  // `passes`: how many rays each pixel gets from this rank, on average. Null, with the reason,
  // where rays are better traced: where that is expected to take no longer (tried with some rays
  // and some triangles; `always`: not then), or where hits cannot be told beforehand: through a
  // lens, in parallel, of points and segments, without BuildOptions::robust, or with an Embree
  // whose arithmetic is not the one that is known here, which is tried out with rays to triangles
  // all over the scene. Parallel in the caller's arena, for each rank anew. O(t + s) for t
  // triangles and the squares that each may be seen in, s together: of one that reaches behind the
  // eye all of them. Unless `always`, s is no more than what may be drawn in the time of tracing.
  struct Made;
  static Made make(const Tracer& tracer, const SeenWindow& window, double passes, bool always,
                   Trials& trials);

  // Of a thread, used again from call to call.
  struct Memory {
    std::vector<ActiveRays> left;  // element i: rays of group i that have to be traced all the same
    DrawnSquare square;
  };
  // Finds the hits of groups of camera rays, those of `pixels`, row by row, but for those `left`:
  // packets with a ray at a silhouette or an edge or where surfaces lie in each other. Returns how
  // many rays of groups that do not miss all are not left. Flush to zero is set (FlushToZero).
  std::uint64_t find(const geometry::Rect& pixels, Groups<RayGroup>& groups, Memory& memory) const;

 private:
  FirstHits() = default;
  RaySpaces spaces_;
  TriangleBins bins_;
  geometry::Rect window_;
  double packet_seconds_ = 0;  // to trace one
};

struct FirstHits::Made {
  std::unique_ptr<const FirstHits> hits;
  std::string why_not;
};

}  // namespace delray::raytrace
