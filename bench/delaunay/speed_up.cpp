// How much faster than one thread without locks the methods of Kohout (2004) are that share a
// history, and the fast method beside them:
//
//   delaunay_speed_up [--dim 2|3] [--points N] [--turns N] [--threads N,N...] [--only KIND] [FILE]
//
// The base is `insertion` with the history and in biased random order. All must give its simplices
// before anything is timed; then they take turns, each with warm memory. The table has medians of
// seconds and the base's over them, which the report calls the speed-up.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "bench/measure.h"
#include "delaunay/generate.h"
#include "delaunay/methods.h"
#include "delaunay/read_points.h"
#include "delaunay/triangulate.h"
#include "parallel/arena.h"

namespace {

using namespace delray;

constexpr std::string_view kBase = "insertion";

struct Runner {
  const delaunay::Method* method;
  int threads;
  std::vector<double> seconds = {};
};

delaunay::Triangulation run(const std::vector<glm::dvec3>& points, int dim, const Runner& runner) {
  delaunay::Options options;
  options.dim = dim;
  options.method = runner.method->name;
  options.threads = runner.threads;
  if (!delaunay::locations_for(*runner.method, dim).empty()) {
    options.location = "dag";
    options.order = "brio";
  }
  const parallel::AllowThreads allowed(runner.threads);
  parallel::Arena arena(runner.threads);
  return arena.execute([&] { return delaunay::triangulate(delaunay::view(points), options); });
}

bool compare(const std::vector<glm::dvec3>& points, int dim, int turns,
             const std::vector<int>& threads) {
  std::vector<Runner> runners;
  for (const delaunay::Method& method : delaunay::methods()) {
    if (std::ranges::find(method.dims, dim) == method.dims.end()) continue;
    if (method.name == kBase) {
      runners.insert(runners.begin(), {&method, 1});
    } else {
      for (const int count : threads) runners.push_back({&method, count});
    }
  }
  const delaunay::Hash128 expected = delaunay::hash(run(points, dim, runners.front()));
  for (const Runner& runner : runners) {
    if (delaunay::hash(run(points, dim, runner)) == expected) continue;
    std::printf("%s with %d threads: not the simplices of the base\n",
                std::string(runner.method->name).c_str(), runner.threads);
    return false;
  }
  // Of the history above all, in which nothing is given back.
  const std::size_t bytes = (dim == 2 ? 640U : 3600U) * points.size();
  for (int turn = 0; turn < turns; ++turn) {
    for (Runner& runner : runners) {
      bench::warm_memory(bytes);
      runner.seconds.push_back(bench::seconds_of([&] { return run(points, dim, runner); }));
    }
  }
  const double base = bench::median(runners.front().seconds);
  std::printf("%-20s %7s %9s %9s\n", "method", "threads", "seconds", "speed-up");
  for (const Runner& runner : runners) {
    const double seconds = bench::median(runner.seconds);
    std::printf("%-20s %7d %9.4f %9.2f\n", std::string(runner.method->name).c_str(), runner.threads,
                seconds, base / seconds);
  }
  return true;
}

}  // namespace

int main(int count, char** words) {
  int dim = 2, turns = 5;
  std::size_t n = 1'000'000;
  std::vector<int> threads = {1, 2};
  std::string kind = "uniform", file;
  CLI::App app("Speed-ups over one thread without locks");
  app.add_option("--dim", dim)->check(CLI::IsMember({2, 3}));
  app.add_option("--points", n);
  app.add_option("--turns", turns)->check(CLI::PositiveNumber);
  app.add_option("--threads", threads)->delimiter(',')->check(CLI::PositiveNumber);
  app.add_option("--only", kind);
  app.add_option("file", file);
  CLI11_PARSE(app, count, words);
  try {
    const auto cloud = file.empty() ? delaunay::generate_points(kind, n, dim, /*seed=*/1)
                                    : delaunay::read_points(file);
    return compare(cloud.positions, dim, turns, threads) ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
