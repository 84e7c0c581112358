// The bound of error that lets frames of a pack be done in time.
#pragma once

#include <algorithm>
#include <cmath>

namespace delray::apps {

// A controller: frames that took too long are followed by coarser ones. Triangles, and about so
// the time, go with the square of what a pixel of error is on the surface.
class FrameBudget {
 public:
  // REQUIRES: seconds > 0.
  explicit FrameBudget(double seconds) : seconds_(seconds) {}

  // Of the next frame, in pixels; the first is coarse, since nothing is in memory yet.
  double error() const { return error_; }
  // A frame of that error took so long.
  void took(double seconds) {
    constexpr double kAim = 0.9;  // that small changes do not exceed the budget
    constexpr double kLeastStep = 0.5, kMostStep = 4;  // a single slow frame is no measure
    error_ *= std::clamp(std::sqrt(seconds / (kAim * seconds_)), kLeastStep, kMostStep);
    error_ = std::clamp(error_, kLeast, kMost);
  }

  static constexpr double kLeast = 1.0 / 16, kMost = 1000;  // as good as exact; as of --error

 private:
  double seconds_;
  double error_ = 4;
};

}  // namespace delray::apps
