// How much faster than one thread without locks the methods of Kohout (2004) are that share a
// history, and the fast method beside them:
//
//   delaunay_speed_up [--dim 2|3] [--points N] [--turns N] [--threads N,N...] [--only KIND]
//   [--methods M,M...] [FILE]
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
#include <vector>

#include "bench/measure.h"
#include "bench/ratio.h"
#include "delaunay/generate.h"
#include "delaunay/methods.h"
#include "delaunay/read_points.h"
#include "delaunay/triangulate.h"
#include "parallel/arena.h"

namespace {

using namespace delray;

struct Runner {
  delaunay::Options options;
  std::string name;
  std::vector<double> seconds = {};
};

// The base first, then every other method as it is by default and, where that is another location,
// with the history.
std::vector<Runner> runners_of(int dim, const std::vector<int>& threads,
                               const std::vector<std::string>& wanted) {
  delaunay::Options base;
  base.dim = dim;
  base.method = "insertion";
  base.location = "dag";
  base.order = "brio";
  std::vector<Runner> runners = {{base, "insertion/dag"}};
  for (const delaunay::Method& method : delaunay::methods()) {
    if (std::ranges::find(method.dims, dim) == method.dims.end()) continue;
    if (method.name == base.method) continue;
    if (!wanted.empty() && std::ranges::find(wanted, method.name) == wanted.end()) continue;
    delaunay::Options options;
    options.dim = dim;
    options.method = method.name;
    const auto locations = delaunay::locations_for(method, dim);
    const auto with = [&](const std::string& location, const std::string& name) {
      options.location = location;
      for (const int count : threads) {
        options.threads = count;
        runners.push_back({options, name});
      }
    };
    const std::string name(method.name);
    with("auto", locations.empty() ? name : name + "/" + std::string(locations.front()));
    if (!locations.empty() && locations.front() != "dag") with("dag", name + "/dag");
  }
  return runners;
}

delaunay::Triangulation run(const std::vector<glm::dvec3>& points, const Runner& runner) {
  const parallel::AllowThreads allowed(runner.options.threads);
  parallel::Arena arena(runner.options.threads);
  return arena.execute(
      [&] { return delaunay::triangulate(delaunay::view(points), runner.options).triangulation; });
}

bool compare(const std::vector<glm::dvec3>& points, const std::string& kind, int dim, int turns,
             const std::vector<int>& threads, const std::vector<std::string>& wanted) {
  std::vector<Runner> runners = runners_of(dim, threads, wanted);
  const delaunay::Hash128 expected = delaunay::hash(run(points, runners.front()));
  for (const Runner& runner : runners) {
    if (delaunay::hash(run(points, runner)) == expected) continue;
    std::printf("%s with %d threads: not the simplices of the base\n", runner.name.c_str(),
                runner.options.threads);
    return false;
  }
  // Of the history above all, in which nothing is given back.
  const std::size_t bytes = (dim == 2 ? 512U : 2048U) * points.size();
  for (int turn = 0; turn < turns; ++turn) {
    for (Runner& runner : runners) {
      bench::warm_memory(bytes);
      runner.seconds.push_back(bench::seconds_of([&] { return run(points, runner); }));
    }
  }
  const double base = bench::median(runners.front().seconds);
  std::printf("%-20s %7s %9s %9s\n", "method", "threads", "seconds", "speed-up");
  for (const Runner& runner : runners) {
    const double seconds = bench::median(runner.seconds);
    std::printf("%-20s %7d %9.4f %9.2f\n", runner.name.c_str(), runner.options.threads, seconds,
                base / seconds);
    if (&runner == &runners.front()) continue;
    bench::report_ratio(kind + " " + std::to_string(points.size()) + ", " + runner.name + ", " +
                            bench::thread_count(runner.options.threads),
                        base / seconds, bench::Better::higher);
  }
  return true;
}

}  // namespace

int main(int count, char** words) {
  int dim = 2, turns = 5;
  std::size_t n = 1'000'000;
  std::vector<int> threads = {1, 2};
  std::string kind = "uniform", file;
  std::vector<std::string> methods;
  CLI::App app("Speed-ups over one thread without locks");
  app.add_option("--dim", dim)->check(CLI::IsMember({2, 3}));
  app.add_option("--points", n);
  app.add_option("--turns", turns)->check(CLI::PositiveNumber);
  app.add_option("--threads", threads)->delimiter(',')->check(CLI::PositiveNumber);
  app.add_option("--only", kind);
  app.add_option("--methods", methods)->delimiter(',');
  app.add_option("file", file);
  CLI11_PARSE(app, count, words);
  try {
    const auto cloud = file.empty() ? delaunay::generate_points(kind, n, dim, /*seed=*/1)
                                    : delaunay::read_points(file);
    const std::string name = file.empty() ? kind : file.substr(file.rfind('/') + 1);
    return compare(cloud.positions, name, dim, turns, threads, methods) ? EXIT_SUCCESS
                                                                        : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
