// The clock of one thread that inserts points, and its share of the progress.
#pragma once

#include <cstdint>

#include "delaunay/mesh/stopwatch.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Sums the seconds of each phase, and adds them to `statistics` at the end, if the options want it.
class InsertionPhases {
 public:
  InsertionPhases(const Options& options, Statistics& statistics)
      : progress_(options.progress), statistics_(options.statistics ? &statistics : nullptr) {}

  bool timed() const { return statistics_ != nullptr; }
  // Throws parallel::Interrupted.
  void next_point() {
    // Threads share the counter, so they seldom touch it.
    constexpr std::uint64_t kPointsPerStep = 64;
    if (progress_ != nullptr && ++points_ == kPointsPerStep) report();
    if (timed()) watch_.lap();
  }
  // The time up to here belongs to no phase.
  void resume() {
    if (timed()) watch_.lap();
  }
  void located() {
    if (timed()) seconds_.locate += watch_.lap();
  }
  void subdivided() {
    if (timed()) seconds_.subdivide += watch_.lap();
  }
  void legalized() {
    if (timed()) seconds_.legalize += watch_.lap();
  }
  // At the end. One thread at a time.
  void finish() {
    if (progress_ != nullptr) report();
    if (!timed()) return;
    statistics_->locate += seconds_.locate;
    statistics_->subdivide += seconds_.subdivide;
    statistics_->legalize += seconds_.legalize;
  }

 private:
  void report() {
    const std::uint64_t points = points_;
    points_ = 0;
    progress_->advance(points);
  }

  parallel::Progress* progress_;
  Statistics* statistics_;  // null: not timed
  Stopwatch watch_;
  Statistics seconds_;
  std::uint64_t points_ = 0;  // not yet reported
};

}  // namespace delray::delaunay::internal
