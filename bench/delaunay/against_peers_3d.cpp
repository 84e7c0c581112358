// Delray's 3D triangulation beside CGAL's, sequential and parallel, on the same points in the same
// run:
//
//   delaunay_against_peers_3d [--points N] [--turns N] [--threads N,N...] [--method M] [--only
//   KIND] [FILE...]
//
// KIND none stands for the files alone. Before anything is timed all must give the same simplices.
// Then CGAL, CGAL with several threads, and Delray with each number of threads take turns, and the
// table has the medians: seconds of all, Delray's over those of CGAL with one thread, over those of
// Delray with the first number of threads, the ratio over that of the uniform points, and what
// Delray's memory peaks at beyond the points, in bytes per point. Every FILE of points is a group
// of rows of its own.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/peers/cgal3.h"
#include "delaunay/generate.h"
#include "delaunay/read_points.h"
#include "delaunay/triangulate.h"

namespace {

using namespace delray;

struct Arguments {
  std::size_t points = 1'000'000;
  int turns = 5;
  std::vector<int> threads = {1, 2};
  std::string only;
  delaunay::Options options;
  std::vector<std::string> files;
};

std::vector<int> numbers(const std::string& list) {
  std::vector<int> result;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');) result.push_back(std::stoi(word));
  if (result.empty()) throw std::invalid_argument("--threads needs a number");
  return result;
}

Arguments parse(int count, char** words) {
  Arguments arguments;
  arguments.options.dim = 3;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const auto value = [&] {
      if (++i == count) throw std::invalid_argument(word + " needs a value");
      return std::string(words[i]);
    };
    if (word == "--points") {
      arguments.points = static_cast<std::size_t>(std::stod(value()));
    } else if (word == "--turns") {
      arguments.turns = std::max(1, std::stoi(value()));
    } else if (word == "--threads") {
      arguments.threads = numbers(value());
    } else if (word == "--method") {
      arguments.options.method = value();
    } else if (word == "--only") {
      arguments.only = value();
    } else if (word.starts_with("--")) {
      throw std::invalid_argument("unknown option " + word);
    } else {
      arguments.files.push_back(word);
    }
  }
  return arguments;
}

// Peak of the resident set in bytes since the last call with reset; 0 where Linux's /proc is
// missing.
std::size_t peak_memory(bool reset) {
  if (reset) std::ofstream("/proc/self/clear_refs") << "5";
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
  }
  return 0;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double seconds_of(auto&& work) {
  const auto start = std::chrono::steady_clock::now();
  const auto result = work();  // kept until the clock has stopped
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Prints the rows of one set of points; returns whether the simplices were the same. `uniform` has
// the ratios for uniform points, which are noted there when they come first.
bool compare(const std::string& name, const std::vector<glm::dvec3>& points,
             const Arguments& arguments, std::vector<double>& uniform) {
  const std::size_t kinds = arguments.threads.size();
  const auto run = [&](std::size_t kind) {
    delaunay::Options options = arguments.options;
    options.threads = arguments.threads[kind];
    return delaunay::triangulate(delaunay::view(points), options);
  };
  const delaunay::Hash128 expected = delaunay::hash(bench::triangulate_with_cgal3(points));
  std::vector<double> bytes(kinds);
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    const std::size_t before = peak_memory(true);
    const delaunay::Triangulation ours = run(kind);
    bytes[kind] =
        static_cast<double>(peak_memory(false) - before) / static_cast<double>(points.size());
    if (delaunay::hash(ours) == expected) continue;
    std::printf("%-20s the simplices are not CGAL's\n", name.c_str());
    return false;
  }
  std::vector<double> cgal;
  std::vector<std::vector<double>> ours(kinds), parallel_cgal(kinds);
  for (int turn = 0; turn < arguments.turns; ++turn) {
    cgal.push_back(bench::seconds_of_cgal3(points));
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      const int threads = arguments.threads[kind];
      parallel_cgal[kind].push_back(threads > 1 ? bench::seconds_of_parallel_cgal3(points, threads)
                                                : cgal.back());
      ours[kind].push_back(seconds_of([&] { return run(kind); }));
    }
  }
  const bool first = uniform.empty();
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    const double seconds = median(ours[kind]), ratio = seconds / median(cgal);
    if (first) uniform.push_back(ratio);
    std::printf("%-20s %9zu %7d %9.4f %9.4f %9.4f %8.3f %10.3f %12.3f %11.1f\n", name.c_str(),
                points.size(), arguments.threads[kind], median(cgal), median(parallel_cgal[kind]),
                seconds, ratio, seconds / median(ours.front()), ratio / uniform[kind], bytes[kind]);
  }
  std::fflush(stdout);
  return true;
}

struct Set {
  const char* kind;
  std::size_t points;
};

bool compare_all(const Arguments& arguments) {
  std::printf("%-20s %9s %7s %9s %9s %9s %8s %10s %12s %11s\n", "points", "n", "threads", "CGAL s",
              "CGAL par.", "delray s", "ratio", "over first", "over uniform", "bytes/point");
  // Uniform points first. A sphere takes every exact triangulator long.
  const std::size_t n = arguments.points;
  std::vector<Set> sets = {{"uniform", n},
                           {"gauss", n},
                           {"cluster", n},
                           {"grid", n},
                           {"grid", std::min<std::size_t>(n, 103'823)},
                           {"sphere", std::min<std::size_t>(n, 100'000)},
                           {"uniform", 1000}};
  if (!arguments.only.empty()) sets = {{arguments.only.c_str(), n}};
  if (arguments.only == "none") sets.clear();
  std::vector<double> uniform;
  bool same = true;
  for (const Set& set : sets) {
    const auto cloud = delaunay::generate_points(set.kind, set.points, 3, 1);
    same &= compare(set.kind, cloud.positions, arguments, uniform);
  }
  for (const std::string& file : arguments.files) {
    const std::string name = file.substr(file.rfind('/') + 1);
    same &= compare(name, delaunay::read_points(file).positions, arguments, uniform);
  }
  return same;
}

}  // namespace

int main(int count, char** words) {
  try {
    return compare_all(parse(count, words)) ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
