// How fast files of points are read, whole and part by part:
//
//   delaunay_read_points [--threads N] [--rows N] [--seconds S] [FILE ...]
//
// Of each file it prints the median time of reading it again and again for some seconds, megabytes
// and millions of points a second, and what a thread does of them. Without files it makes a text of
// points to read (three columns of three decimals), and the same points as binary PLY.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/open_points.h"
#include "delaunay/write_points.h"
#include "files/error.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace {

using namespace delray;
namespace fs = std::filesystem;

struct Times {
  double whole = 0, parts = 0;  // medians, seconds
  std::size_t points = 0;
};

double seconds_of(const auto& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

// Both in turns.
Times measure(const fs::path& file, int threads, double seconds) {
  const std::vector<fs::path> files = {file};
  parallel::Arena arena(threads);
  Times times;
  std::vector<double> whole, parts;
  for (double spent = 0; spent < seconds || whole.size() < 3;) {
    whole.push_back(arena.execute([&] {
      return seconds_of([&] { times.points = delaunay::read_points(files, {}).size(); });
    }));
    parts.push_back(arena.execute([&] {
      return seconds_of([&] {
        const auto input = delaunay::open_points(files);
        parallel::parallel_for(0, input->parts(), 1, [&](std::size_t part) {
          delaunay::PointCloud points;
          input->read(part, points);
        });
      });
    }));
    spent += whole.back() + parts.back();
  }
  times.whole = median(whole);
  times.parts = median(parts);
  return times;
}

void report(const fs::path& file, const Times& times, int threads) {
  const double megabytes = static_cast<double>(fs::file_size(file)) / 1e6;
  const double points = static_cast<double>(times.points) / 1e6;
  std::printf("%-28s %9zu points, %7.1f MB\n", file.filename().c_str(), times.points, megabytes);
  const auto line = [&](const char* how, double seconds) {
    std::printf(
        "  %-6s %8.4f s %8.1f MB/s %7.2f million points/s, of a thread %6.2f (%6.2f of "
        "coordinates)\n",
        how, seconds, megabytes / seconds, points / seconds, points / seconds / threads,
        3 * points / seconds / threads);
  };
  line("whole", times.whole);
  line("parts", times.parts);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Times of reading files of points");
  int threads = 2;
  std::size_t rows = 4'000'000;
  double seconds = 3;
  std::vector<std::string> names;
  program.add_option("--threads", threads);
  program.add_option("--rows", rows, "of the text that is made");
  program.add_option("--seconds", seconds, "for each file");
  program.add_option("FILE", names);
  CLI11_PARSE(program, argc, argv);
  const fs::path folder = fs::temp_directory_path() / "delaunay_read_points";
  try {
    if (names.empty()) {
      fs::create_directories(folder);
      delaunay::PointCloud cloud;
      for (const auto& kind : delaunay::point_generators()) {
        if (kind.name == "uniform") cloud = kind.generate(rows, 3, 1);
      }
      cloud.has_z = true;
      for (glm::dvec3& p : cloud.positions) p = glm::round(p * 1e6) / 1e3;
      for (const char* name : {"made.xyz", "made.ply"}) {
        names.push_back((folder / name).string());
        write_points(names.back(), cloud);
      }
    }
    for (const std::string& name : names) report(name, measure(name, threads, seconds), threads);
  } catch (const files::FileError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  fs::remove_all(folder);
  return 0;
}
