// Triangulations of points in four dimensions beside those of CGAL:
//
//   delaunay_dimensions [N [TURNS]]
//
// N uniform points, 10000 if not told. Both must give the same simplices; then they take turns, and
// the line has the medians of the seconds of both and Delray's over CGAL's.
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "bench/measure.h"
#include "bench/peers/cgald.h"
#include "bench/ratio.h"
#include "delaunay/dimensions.h"

int main(int count, char** words) {
  using namespace delray;
  constexpr double kBar = 3;
  const std::size_t n = count > 1 ? std::strtoul(words[1], nullptr, 10) : 10'000;
  const int turns = count > 2 ? std::atoi(words[2]) : 3;
  delaunay::PointTable points{4, {}};
  std::mt19937_64 random(1);
  for (std::size_t i = 0; i < 4 * n; ++i) {
    points.coordinates.push_back(std::uniform_real_distribution<>(0, 1)(random));
  }
  const auto run = [&] { return triangulate_dimensions(points.view(), 4); };
  if (hash(run()) != hash(bench::triangulate_with_cgal4(points.coordinates))) {
    std::printf("the simplices are not CGAL's\n");
    return EXIT_FAILURE;
  }
  std::vector<double> ours, cgal;
  for (int turn = 0; turn < turns; ++turn) {
    cgal.push_back(bench::seconds_of_cgal4(points.coordinates));
    ours.push_back(bench::seconds_of(run));
  }
  const double ratio = bench::median(ours) / bench::median(cgal);
  bench::report_ratio("4D uniform " + std::to_string(n), ratio, bench::Better::lower, kBar);
  std::printf("4D, %zu uniform points: CGAL %.3f s, delray %.3f s, ratio %.3f (at most %.0f)\n", n,
              bench::median(cgal), bench::median(ours), ratio, kBar);
}
