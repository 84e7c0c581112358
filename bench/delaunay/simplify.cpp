// Simplifying terrains with two threads beside one:
//
//   delaunay_simplify [TURNS [FILE...]]
//
// Of each file of points with heights, and of four million generated ones, at bounds of error that
// keep about all, some and few points. Both take turns; lines have the numbers of points that are
// kept, medians of seconds, and one thread's over those of two.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/ratio.h"
#include "delaunay/generate.h"
#include "delaunay/read_points.h"
#include "delaunay/simplify_terrain.h"

namespace {

using namespace delray;

void compare(const std::string& name, const delaunay::PointCloud& cloud, int turns) {
  constexpr double kLeastGain = 1.5;
  const auto [low, high] = std::ranges::minmax(cloud.positions, {}, &glm::dvec3::z);
  for (const double share : {0.0003, 0.001, 0.005}) {
    const double bound = share * (high.z - low.z);
    std::vector<double> seconds[2];
    std::size_t kept[2] = {};
    for (int turn = 0; turn < turns; ++turn) {
      for (const int threads : {1, 2}) {
        bench::warm_memory(std::size_t{200} * cloud.size());
        seconds[threads - 1].push_back(bench::seconds_of([&] {
          auto result =
              delaunay::simplify_terrain(delaunay::view(cloud.positions), bound, nullptr, threads);
          kept[threads - 1] = result.kept.size();
          return result;
        }));
      }
    }
    const double one = bench::median(seconds[0]), two = bench::median(seconds[1]);
    const std::string what = name + " within " + std::to_string(bound);
    bench::report_ratio("simplify " + what, one / two, bench::Better::higher, kLeastGain);
    std::printf(
        "%s of %zu points: 1 thread %.3f s, %zu kept; 2 threads %.3f s, %zu; %.2f times as fast "
        "(at least %.1f)\n",
        what.c_str(), cloud.size(), one, kept[0], two, kept[1], one / two, kLeastGain);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int count, char** words) {
  const int turns = count > 1 ? std::atoi(words[1]) : 5;
  for (int i = 2; i < count; ++i) compare(words[i], delaunay::read_points(words[i]), turns);
  constexpr std::size_t kPoints = 4'000'000;
  compare("terrain", delaunay::generate_points("terrain", kPoints, 3, 1), turns);
}
