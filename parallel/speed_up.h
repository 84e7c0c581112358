// Formulas of how much parallel work gains: Kohout (2004), 2.1 to 2.5, Amdahl (1967), and Karp and
// Flatt (1990).
//
// Times are seconds >= 0, k is a number of processors >= 1. Each is O(1), or O(stages).
#pragma once

#include <algorithm>
#include <numeric>
#include <span>

namespace delray::parallel {

// (2.1) `items` through all stages, one after the other: N times the sum of t_i.
inline double sequential_seconds(std::span<const double> stages, double items) {
  return items * std::accumulate(stages.begin(), stages.end(), 0.0);
}

// (2.2) The same through a pipeline with a processor for each stage: the first item passes them
// all, every other follows after the slowest. REQUIRES: stages; items >= 1.
inline double pipeline_seconds(std::span<const double> stages, double items) {
  return std::accumulate(stages.begin(), stages.end(), 0.0) +
         (items - 1) * *std::max_element(stages.begin(), stages.end());
}

// s = t_seq / t_par. REQUIRES: parallel > 0.
constexpr double speed_up(double sequential, double parallel) { return sequential / parallel; }
// s / k.
constexpr double efficiency(double speed_up, double k) { return speed_up / k; }
// t(k1) / t(k2): what k2 > k1 processors gain over k1, where nobody can do it alone. REQUIRES: more
// > 0.
constexpr double scalability(double fewer, double more) { return fewer / more; }

// (2.3) Amdahl's law: the most that k processors gain where a fraction q of the operations can be
// done in parallel, 0 <= q <= 1.
constexpr double amdahl_speed_up(double q, double k) { return 1 / (q / k + (1 - q)); }
// The same of any number of processors. REQUIRES: q < 1.
constexpr double amdahl_limit(double q) { return 1 / (1 - q); }

// The fraction 1 - q that is sequential, by the speed-up that k processors were measured to have
// (Karp and Flatt): Amdahl's law solved for it, so that it grows with k where communication costs,
// and is negative where the speed-up is super-linear. REQUIRES: k > 1; speed_up > 0.
constexpr double serial_fraction(double speed_up, double k) {
  return (1 / speed_up - 1 / k) / (1 - 1 / k);
}

// (2.4) N items by k processors, each of which has `cached` of its N / k in its cache, where one
// takes t0, and takes t1 > t0 for each of the others: x t0 + (N / k - x) t1. Of 2.5's speed-up over
// one processor, super-linear since two have twice the cache: speed_up(cached_seconds(N, x, 1, ..),
// cached_seconds(N, x, 2, ..)). REQUIRES: 0 <= cached <= N / k.
constexpr double cached_seconds(double items, double cached, double k, double t0, double t1) {
  return cached * t0 + (items / k - cached) * t1;
}

}  // namespace delray::parallel
