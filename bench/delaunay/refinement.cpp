// Refinements beside those of CGAL's Delaunay_mesher_2:
//
//   delaunay_refinement [N [ANGLE [TURNS]]]
//
// N uniform points, 10^6 if not told, and outlines of a lake and a country with N / 10 points, at a
// smallest angle of 25 degrees. Both sides take turns with one thread; lines have the numbers of
// points and the medians of seconds, and Delray's over CGAL's.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/peers/cgal_mesher.h"
#include "bench/ratio.h"
#include "delaunay/generate.h"
#include "delaunay/quality.h"
#include "delaunay/refine.h"

namespace {

using namespace delray;

struct Case {
  std::string name;
  delaunay::Outline outline;
};

void compare(const Case& of, double angle, int turns) {
  constexpr double kMostPoints = 1.2, kMostTime = 0.5;
  std::vector<double> ours, cgal;
  std::size_t our_points = 0, cgal_points = 0;
  double reached = 0;
  unsigned long long excepted = 0;
  for (int turn = 0; turn < turns; ++turn) {
    bench::warm_memory(std::size_t{500} * 2 * of.outline.points.size());
    const bench::MesherRun run = bench::refine_with_cgal(of.outline, angle);
    cgal.push_back(run.seconds);
    cgal_points = run.points;
    delaunay::Refined refined;
    bench::warm_memory(std::size_t{500} * 2 * of.outline.points.size());
    ours.push_back(bench::seconds_of([&] {
      refined = refine(of.outline, {.min_angle = angle});
      return 0;
    }));
    our_points = refined.triangulation.distinct;
    reached = quality(delaunay::view(refined.points), domain_of(refined)).min_angle;
    excepted = refined.counts.excepted;
  }
  const double points = static_cast<double>(our_points) / static_cast<double>(cgal_points);
  const double time = bench::median(ours) / bench::median(cgal);
  bench::report_ratio("points of " + of.name, points, bench::Better::lower, kMostPoints);
  bench::report_ratio("seconds of " + of.name, time, bench::Better::lower, kMostTime);
  std::printf(
      "%s at %.1f degrees: CGAL %zu points, %.3f s; delray %zu points, %.3f s, least angle %.2f, "
      "%llu triangles excepted; ratios %.3f (at most %.1f) and %.3f (at most %.1f)\n",
      of.name.c_str(), angle, cgal_points, bench::median(cgal), our_points, bench::median(ours),
      reached, excepted, points, kMostPoints, time, kMostTime);
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
  const std::size_t n = count > 1 ? std::strtoul(words[1], nullptr, 10) : 1'000'000;
  const double angle = count > 2 ? std::strtod(words[2], nullptr) : 25;
  const int turns = count > 3 ? std::atoi(words[3]) : 1;
  const std::size_t of_outlines = std::max<std::size_t>(n / 10, 100);
  Case uniform{"uniform points", {}};
  uniform.outline.points = delaunay::generate_points("uniform", n, 2, 1);
  compare(uniform, angle, turns);
  for (const char* kind : {"lake", "country"}) {
    compare({kind, delaunay::generate_outline(kind, of_outlines, 1)}, angle, turns);
  }
}
