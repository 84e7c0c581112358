// Delray's 3D triangulation beside CGAL's, on the same points in the same run:
//
//   delaunay_against_peers_3d [--points N] [--turns N] [--threads N] [--method M] [--only KIND]
//   [FILE...]
//
// Before anything is timed both must give the same simplices. Then they take turns; the table has
// medians, their ratio, and what Delray's memory peaks at beyond the points, in bytes per point.
// Every FILE of points is a row of its own.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
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
  std::string only;
  delaunay::Options options;
  std::vector<std::string> files;
};

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
      arguments.options.threads = std::stoi(value());
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

// Prints one row; returns whether the simplices were the same.
bool compare(const std::string& name, const std::vector<glm::dvec3>& points,
             const Arguments& arguments) {
  const auto run = [&] { return delaunay::triangulate(delaunay::view(points), arguments.options); };
  delaunay::Hash128 hash;
  std::size_t memory = 0;
  {
    const std::size_t before = peak_memory(true);
    const delaunay::Triangulation ours = run();
    memory = peak_memory(false) - before;
    hash = delaunay::hash(ours);
  }
  if (hash != delaunay::hash(bench::triangulate_with_cgal3(points))) {
    std::printf("%-24s the simplices are not CGAL's\n", name.c_str());
    return false;
  }
  std::vector<double> ours, cgal;
  for (int turn = 0; turn < arguments.turns; ++turn) {
    cgal.push_back(bench::seconds_of_cgal3(points));
    const auto start = std::chrono::steady_clock::now();
    const delaunay::Triangulation triangulation = run();
    ours.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::printf("%-24s %10zu %10.4f %10.4f %8.3f %10.1f\n", name.c_str(), points.size(), median(ours),
              median(cgal), median(ours) / median(cgal),
              static_cast<double>(memory) / static_cast<double>(points.size()));
  std::fflush(stdout);
  return true;
}

bool compare_all(const Arguments& arguments) {
  std::printf("%-24s %10s %10s %10s %8s %10s\n", "points", "n", "delray s", "CGAL s", "ratio",
              "bytes/point");
  bool same = true;
  for (const auto& generator : delaunay::point_generators()) {
    if (!arguments.only.empty() && generator.name != arguments.only) continue;
    const auto cloud = generator.generate(arguments.points, 3, 1);
    same &= compare(std::string(generator.name), cloud.positions, arguments);
  }
  for (const std::string& file : arguments.files) {
    const std::string name = file.substr(file.rfind('/') + 1);
    same &= compare(name, delaunay::read_points(file).positions, arguments);
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
