// Every triangulation method with every location, split, order, deadlock strategy, kind of locks
// and time of unlocking that goes with it, on the report's six distributions (Kohout 2004, section
// 7) and with one thread and two:
//
//   delaunay_methods [--points N] [--benchmark_filter=REGEX] [options of Google Benchmark]
//
// Names are dim/method/location/split/order/deadlocks/locks/unlock/distribution/threads, as in the
// tables that the program lists, so that 2D/optimistic/dag/curve/.*/uniform/2 is a filter.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "delaunay/combinations.h"
#include "delaunay/generate.h"
#include "delaunay/triangulate.h"
#include "parallel/arena.h"

namespace {

using namespace delray;

constexpr std::size_t kDistributions = 6;  // of the report, which come first in the table
constexpr std::uint64_t kSeed = 1;

// Made when first asked for: a filter leaves most of them out.
const std::vector<glm::dvec3>& points_of(const delaunay::PointGenerator& distribution,
                                         std::size_t n, int dim) {
  static std::map<std::pair<std::string_view, int>, std::vector<glm::dvec3>> made;
  std::vector<glm::dvec3>& points = made[{distribution.name, dim}];
  if (points.empty()) points = distribution.generate(n, dim, kSeed).positions;
  return points;
}

void measure(benchmark::State& state, const delaunay::Options& options,
             const delaunay::PointGenerator& distribution, std::size_t n) {
  const std::vector<glm::dvec3>& points = points_of(distribution, n, options.dim);
  const parallel::AllowThreads allowed(options.threads);
  parallel::Arena arena(options.threads);
  for (auto _ : state) {
    const delaunay::Result result =
        arena.execute([&] { return delaunay::triangulate(delaunay::view(points), options); });
    benchmark::DoNotOptimize(result.triangulation.vertices.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}

void register_all(std::size_t n) {
  for (const int dim : {2, 3}) {
    for (const delaunay::Options& options : delaunay::combinations(dim)) {
      for (const auto& distribution : delaunay::point_generators().first(kDistributions)) {
        for (const int threads : {1, 2}) {
          delaunay::Options own = options;
          own.threads = threads;
          const std::string name = std::to_string(dim) + "D/" + delaunay::name_of(options) + "/" +
                                   std::string(distribution.name) + "/" + std::to_string(threads);
          benchmark::RegisterBenchmark(name.c_str(),
                                       [own, &distribution, n](benchmark::State& state) {
                                         measure(state, own, distribution, n);
                                       })
              ->Unit(benchmark::kMillisecond)
              ->UseRealTime();
        }
      }
    }
  }
}

}  // namespace

int main(int count, char** words) {
  std::size_t points = 100'000;
  benchmark::Initialize(&count, words);
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(words[i], "--points") == 0 && i + 1 < count) {
      points = std::strtoull(words[++i], nullptr, 10);
    } else {
      std::fprintf(stderr, "unknown option %s\n", words[i]);
      return 2;
    }
  }
  if (points == 0) {
    std::fprintf(stderr, "--points needs a number\n");
    return 2;
  }
  register_all(points);
  benchmark::RunSpecifiedBenchmarks();
  return EXIT_SUCCESS;
}
