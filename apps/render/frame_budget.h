// The bound of error that lets frames of a pack be done in time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>

namespace delray::apps {

// A controller with a model: a frame takes a time of its own, for pixels, and a time for each
// triangle; triangles go with a power of the bound of error. Both are fitted to the last frames, so
// that a few are enough, and the time of pixels is not taken for one that coarser levels could
// spare.
class FrameBudget {
 public:
  // REQUIRES: seconds > 0.
  explicit FrameBudget(double seconds) : aim_(kAim * seconds) {}

  // Of the next frame, in pixels; the first is coarse, since nothing is in memory yet.
  double error() const { return error_; }

  // A frame of that error took so long for so many triangles. The first is no measure, as it reads
  // all that it shows.
  void took(double seconds, std::uint64_t triangles) {
    if (!started_) {
      started_ = true;
      return;
    }
    const Frame frame{error_, std::max(seconds, 1e-6),
                      std::max(static_cast<double>(triangles), 1.0)};
    if (!frames_.empty()) fit_power(frames_.back(), frame);
    frames_.push_back(frame);
    if (frames_.size() > kFrames) frames_.pop_front();
    const auto [own, each] = fit_seconds();
    // Where pixels alone take too long, leaving out more than that spares nothing worth it.
    const double wanted = std::max(aim_ - own, kLeastShare * own) / each;
    const double step = std::pow(frame.triangles / wanted, 1 / power_);
    error_ = std::clamp(error_ * std::clamp(step, kLeastStep, kMostStep), kLeast, kMost);
  }

  static constexpr double kLeast = 1.0 / 16, kMost = 1000;  // as good as exact; as of --error

 private:
  struct Frame {
    double error, seconds, triangles;
  };
  struct Seconds {
    double own, each;
  };
  static constexpr double kAim = 0.9;  // that small changes do not exceed the budget
  static constexpr double kLeastStep = 0.25, kMostStep = 8;  // a single slow frame is no measure
  static constexpr double kLeastShare = 0.15;                // of the time of pixels
  static constexpr std::size_t kFrames = 8;

  // A line through the last frames, the latest counting most. Of frames that are much alike it
  // would be noise: pixels keep the time that they had, a
  // quarter at first.
  Seconds fit_seconds() {
    constexpr double kOlder = 0.7, kAlike = 0.04, kLeastEach = 0.05, kFirstShare = 0.25;
    double weight = 1, sum = 0, t = 0, s = 0, tt = 0, ts = 0;
    for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame, weight *= kOlder) {
      sum += weight;
      t += weight * frame->triangles;
      s += weight * frame->seconds;
      tt += weight * frame->triangles * frame->triangles;
      ts += weight * frame->triangles * frame->seconds;
    }
    const double mean_t = t / sum, mean_s = s / sum;
    const double spread = tt / sum - mean_t * mean_t;
    if (spread > kAlike * mean_t * mean_t) {
      const double slope = (ts / sum - mean_t * mean_s) / spread;
      own_ = std::max(0.0, mean_s - std::max(slope, 0.0) * mean_t);
    }
    const double own =
        own_ < 0 ? kFirstShare * mean_s : std::clamp(own_, 0.0, (1 - kLeastEach) * mean_s);
    return {own, (mean_s - own) / mean_t};
  }

  void fit_power(const Frame& a, const Frame& b) {
    const double steps = std::log(b.error / a.error);
    if (std::abs(steps) < 0.1) return;
    const double seen = -std::log(b.triangles / a.triangles) / steps;
    power_ = std::clamp((power_ + seen) / 2, 0.4, 2.5);
  }

  const double aim_;
  bool started_ = false;
  double error_ = 4, power_ = 1.2, own_ = -1;  // not known yet
  std::deque<Frame> frames_;
};

}  // namespace delray::apps
