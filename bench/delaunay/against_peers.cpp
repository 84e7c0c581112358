// Delray's triangulation beside CGAL's, sequential and in space also parallel, and beside HXT's
// where Gmsh is installed, on the same points in the same run:
//
//   delaunay_against_peers [--dim 2|3] [--points N] [--turns N] [--threads N,N...] [--method M]
//   [--only KIND | --only none] [--json FILE] [FILE...]
//
// Before anything is timed all must give the same simplices. Then they take turns, each with warm
// memory, and the table has the medians: seconds of CGAL, of parallel CGAL, of HXT with as many
// threads and of Delray, Delray's over those of CGAL with one thread, over those of Delray with the
// first number of threads, the ratio over that of uniform points if those are in the table, and
// what Delray's memory peaks at beyond the points, in bytes per point. Every FILE of points is a
// group of rows of its own.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/peers/cgal2.h"
#include "bench/peers/cgal3.h"
#ifdef DELRAY_HXT
#include "bench/peers/hxt.h"
#endif
#include "bench/ratio.h"
#include "delaunay/generate.h"
#include "delaunay/read_points.h"
#include "delaunay/triangulate.h"

namespace {

using namespace delray;

struct Arguments {
  std::size_t points = 1'000'000;
  int turns = 5;
  std::vector<int> threads = {1, 2};
  std::string only, json;
  delaunay::Options options;
  std::vector<std::string> files;
};

struct Set {
  std::string kind;
  std::size_t points;
};

// Of all that is compared in one dimension.
struct Peer {
  delaunay::Triangulation (*triangulate)(std::span<const glm::dvec3>);
  double (*seconds)(std::span<const glm::dvec3>);
  double (*parallel_seconds)(std::span<const glm::dvec3>, int);  // or nullptr
  std::size_t bytes_per_point;                                   // more than either side takes
};

constexpr Peer kPeers[] = {{bench::triangulate_with_cgal2, bench::seconds_of_cgal2, nullptr, 256},
                           {bench::triangulate_with_cgal3, bench::seconds_of_cgal3,
                            bench::seconds_of_parallel_cgal3, 768}};

// What is compared where nothing else is asked for; uniform points come first. Not points on a
// line: CGAL takes minutes to insert a million of them. In space a sphere takes every exact
// triangulator long.
std::vector<Set> default_sets(int dim, std::size_t n) {
  if (dim == 2) {
    return {{"uniform", n}, {"gauss", n},  {"cluster", n},    {"grid", n},      {"arc", n},
            {"sphere", n},  {"jitter", n}, {"duplicates", n}, {"uniform", 1000}};
  }
  return {{"uniform", n},
          {"gauss", n},
          {"cluster", n},
          {"grid", n},
          {"grid", std::min<std::size_t>(n, 103'823)},
          {"sphere", std::min<std::size_t>(n, 100'000)},
          {"uniform", 1000}};
}

// Whether HXT is there, has the dimension, and makes as many simplices: it breaks ties otherwise.
bool goes_with_hxt([[maybe_unused]] const std::vector<glm::dvec3>& points, [[maybe_unused]] int dim,
                   [[maybe_unused]] std::size_t simplices) {
#ifdef DELRAY_HXT
  if (dim == 3) return bench::triangulate_with_hxt(points, 1).tetrahedra == simplices;
#endif
  return false;
}

double seconds_of_hxt([[maybe_unused]] const std::vector<glm::dvec3>& points,
                      [[maybe_unused]] int threads) {
#ifdef DELRAY_HXT
  return bench::triangulate_with_hxt(points, threads).seconds;
#else
  return 0;
#endif
}

// The ratio in the first row of uniform points and so many threads; 0 if there is none.
double uniform_ratio(const nlohmann::json& rows, int threads) {
  for (const nlohmann::json& row : rows) {
    if (row["points"] == "uniform" && row["threads"] == threads) return row["ratio"];
  }
  return 0;
}

// A dash for what was not measured.
void print(const char* format, int width, double value) {
  if (value > 0) {
    std::printf(format, value);
  } else {
    std::printf("%*s", width, "-");
  }
}

// Prints the rows of one set of points and appends them to `rows`; returns whether the simplices
// were the same.
bool compare(const std::string& name, const std::vector<glm::dvec3>& points,
             const Arguments& arguments, nlohmann::json& rows) {
  const Peer& peer = kPeers[arguments.options.dim - 2];
  const std::size_t kinds = arguments.threads.size();
  const auto run = [&](std::size_t kind) {
    delaunay::Options options = arguments.options;
    options.threads = arguments.threads[kind];
    return delaunay::triangulate(delaunay::view(points), options).triangulation;
  };
  const delaunay::Triangulation reference = peer.triangulate(points);
  const delaunay::Hash128 expected = delaunay::hash(reference);
  const bool with_hxt = goes_with_hxt(points, arguments.options.dim, reference.size());
  std::vector<double> bytes(kinds);
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    const std::size_t before = bench::peak_memory(true);
    const delaunay::Triangulation ours = run(kind);
    bytes[kind] = static_cast<double>(bench::peak_memory(false) - before) /
                  static_cast<double>(points.size());
    if (delaunay::hash(ours) == expected) continue;
    std::printf("%-20s the simplices are not CGAL's\n", name.c_str());
    return false;
  }
  std::vector<double> cgal;
  std::vector<std::vector<double>> ours(kinds), parallel(kinds), hxt(kinds);
  const bench::KeepMemory kept;
  const auto warm = [&] { bench::warm_memory(peer.bytes_per_point * points.size()); };
  for (int turn = 0; turn < arguments.turns; ++turn) {
    warm();
    cgal.push_back(peer.seconds(points));
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      const int threads = arguments.threads[kind];
      if (peer.parallel_seconds != nullptr && threads > 1) {
        warm();
        parallel[kind].push_back(peer.parallel_seconds(points, threads));
      }
      if (with_hxt) {
        warm();
        hxt[kind].push_back(seconds_of_hxt(points, threads));
      }
      warm();
      ours[kind].push_back(bench::seconds_of([&] { return run(kind); }));
    }
  }
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    const int threads = arguments.threads[kind];
    const double seconds = bench::median(ours[kind]), ratio = seconds / bench::median(cgal);
    const double over_first = seconds / bench::median(ours.front());
    const double beside = parallel[kind].empty() ? 0 : bench::median(parallel[kind]);
    rows.push_back({{"points", name},
                    {"dim", arguments.options.dim},
                    {"n", points.size()},
                    {"threads", threads},
                    {"cgal_seconds", bench::median(cgal)},
                    {"seconds", seconds},
                    {"ratio", ratio},
                    {"over_first_threads", over_first},
                    {"bytes_per_point", bytes[kind]}});
    nlohmann::json& row = rows.back();
    const double hxt_seconds = with_hxt ? bench::median(hxt[kind]) : 0;
    if (beside > 0) row["parallel_cgal_seconds"] = beside;
    if (hxt_seconds > 0) row["hxt_seconds"] = hxt_seconds;
    const std::string label =
        name + " " + std::to_string(points.size()) + ", " + bench::thread_count(threads);
    bench::report_ratio(label, ratio);
    if (hxt_seconds > 0) bench::report_ratio(label + ", over HXT", seconds / hxt_seconds);
    const double uniform = uniform_ratio(rows, threads);
    if (uniform > 0) row["over_uniform"] = ratio / uniform;
    std::printf("%-20s %9zu %7d %9.4f ", name.c_str(), points.size(), threads, bench::median(cgal));
    print("%9.4f ", 9, beside);
    print("%9.4f", 9, hxt_seconds);
    std::printf(" %9.4f %8.3f %10.3f ", seconds, ratio, over_first);
    print("%12.3f", 12, uniform > 0 ? ratio / uniform : 0);
    std::printf(" %11.1f\n", bytes[kind]);
  }
  std::fflush(stdout);
  return true;
}

bool compare_all(const Arguments& arguments) {
  std::printf("%-20s %9s %7s %9s %9s %9s %9s %8s %10s %12s %11s\n", "points", "n", "threads",
              "CGAL s", "CGAL par.", "HXT s", "delray s", "ratio", "over first", "over uniform",
              "bytes/point");
  std::vector<Set> sets = default_sets(arguments.options.dim, arguments.points);
  if (!arguments.only.empty()) sets = {{arguments.only, arguments.points}};
  if (arguments.only == "none") sets.clear();
  bool same = true;
  nlohmann::json rows = nlohmann::json::array();
  for (const Set& set : sets) {
    const auto cloud =
        delaunay::generate_points(set.kind, set.points, arguments.options.dim, /*seed=*/1);
    same &= compare(set.kind, cloud.positions, arguments, rows);
  }
  for (const std::string& file : arguments.files) {
    const std::string name = file.substr(file.rfind('/') + 1);
    same &= compare(name, delaunay::read_points(file).positions, arguments, rows);
  }
  if (!arguments.json.empty()) {
    std::ofstream output(arguments.json);
    output << rows.dump(2) << '\n';
    if (!output) throw std::runtime_error("cannot write " + arguments.json);
  }
  return same;
}

}  // namespace

int main(int count, char** words) {
  Arguments arguments;
  CLI::App app("Delray's triangulation beside CGAL's");
  app.add_option("--dim", arguments.options.dim)->check(CLI::IsMember({2, 3}));
  app.add_option("--points", arguments.points);
  app.add_option("--turns", arguments.turns)->check(CLI::PositiveNumber);
  app.add_option("--threads", arguments.threads)->delimiter(',')->check(CLI::PositiveNumber);
  app.add_option("--method", arguments.options.method);
  app.add_option("--only", arguments.only);
  app.add_option("--json", arguments.json);
  app.add_option("files", arguments.files);
  CLI11_PARSE(app, count, words);
  try {
    return compare_all(arguments) ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
