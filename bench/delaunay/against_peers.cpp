// Delray's 2D triangulation beside CGAL's, on the same points in the same run:
//
//   delaunay_against_peers [--points N] [--turns N] [--threads N,N...] [--method M] [--only KIND]
//   [--json FILE] [FILE...]
//
// Before anything is timed all must give the same simplices. Then CGAL and Delray with each number
// of threads take turns, and the table has the medians: seconds of CGAL and of Delray, their ratio,
// the time over that with the first number of threads, the ratio over that of uniform points if
// those are in the table, and what Delray's memory peaks at beyond the points, in bytes per point.
// Every FILE of points is a group of rows of its own.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "bench/peers/cgal2.h"
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

std::vector<int> numbers(const std::string& list) {
  std::vector<int> result;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');) result.push_back(std::stoi(word));
  if (result.empty()) throw std::invalid_argument("--threads needs a number");
  return result;
}

Arguments parse(int count, char** words) {
  Arguments arguments;
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
    } else if (word == "--json") {
      arguments.json = value();
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

// The ratio in the row of uniform points and so many threads; 0 if there is none.
double uniform_ratio(const nlohmann::json& rows, int threads) {
  for (const nlohmann::json& row : rows) {
    if (row["points"] == "uniform" && row["threads"] == threads) return row["ratio"];
  }
  return 0;
}

// Prints the rows of one set of points and appends them to `rows`; returns whether the simplices
// were the same.
bool compare(const std::string& name, const std::vector<glm::dvec3>& points,
             const Arguments& arguments, nlohmann::json& rows) {
  const std::size_t kinds = arguments.threads.size();
  const auto run = [&](std::size_t kind) {
    delaunay::Options options = arguments.options;
    options.threads = arguments.threads[kind];
    return delaunay::triangulate(delaunay::view(points), options);
  };
  const delaunay::Hash128 expected = delaunay::hash(bench::triangulate_with_cgal2(points));
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
  std::vector<std::vector<double>> ours(kinds);
  for (int turn = 0; turn < arguments.turns; ++turn) {
    cgal.push_back(bench::seconds_of_cgal2(points));
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      ours[kind].push_back(seconds_of([&] { return run(kind); }));
    }
  }
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    const double seconds = median(ours[kind]), ratio = seconds / median(cgal);
    const double over_first = seconds / median(ours.front());
    rows.push_back({{"points", name},
                    {"n", points.size()},
                    {"threads", arguments.threads[kind]},
                    {"cgal_seconds", median(cgal)},
                    {"seconds", seconds},
                    {"ratio", ratio},
                    {"over_first_threads", over_first},
                    {"bytes_per_point", bytes[kind]}});
    std::printf("%-20s %9zu %7d %9.4f %9.4f %8.3f %10.3f", name.c_str(), points.size(),
                arguments.threads[kind], median(cgal), seconds, ratio, over_first);
    const double uniform = uniform_ratio(rows, arguments.threads[kind]);
    if (uniform > 0) {
      rows.back()["over_uniform"] = ratio / uniform;
      std::printf(" %12.3f", ratio / uniform);
    } else {
      std::printf(" %12s", "-");
    }
    std::printf(" %11.1f\n", bytes[kind]);
  }
  std::fflush(stdout);
  return true;
}

bool compare_all(const Arguments& arguments) {
  // Not points on a line: CGAL takes minutes to insert a million of them.
  constexpr std::array<std::string_view, 8> kinds = {"uniform", "gauss",  "cluster", "grid",
                                                     "arc",     "sphere", "jitter",  "duplicates"};
  std::printf("%-20s %9s %7s %9s %9s %8s %10s %12s %11s\n", "points", "n", "threads", "CGAL s",
              "delray s", "ratio", "over first", "over uniform", "bytes/point");
  bool same = true;
  nlohmann::json rows = nlohmann::json::array();
  for (const auto& generator : delaunay::point_generators()) {
    if (arguments.only.empty() ? std::ranges::find(kinds, generator.name) == kinds.end()
                               : generator.name != arguments.only) {
      continue;
    }
    const auto cloud = generator.generate(arguments.points, 2, 1);
    same &= compare(std::string(generator.name), cloud.positions, arguments, rows);
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
  try {
    return compare_all(parse(count, words)) ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
