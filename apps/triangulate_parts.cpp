// Opens the input in parts on every rank and triangulates tile by tile, within the memory that
// --memory leaves.
#include "apps/triangulate_parts.h"

#include <fmt/format.h>
#include <malloc.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <vector>

#include "apps/input/point_parts_input.h"
#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "apps/terminal/progress_bar.h"
#include "comm/agree_on_failure.h"
#include "delaunay/duplicates.h"
#include "delaunay/open_points.h"
#include "files/error.h"
#include "files/memory_budget.h"
#include "files/read_file.h"
#include "parallel/arena.h"

namespace delray::apps {
namespace {

std::vector<std::filesystem::path> input_files(const PointInput& input) {
  if (input.paths.empty()) return {input.path};
  return delaunay::expand_inputs(
      std::vector<std::filesystem::path>(input.paths.begin(), input.paths.end()));
}

// Inputs, their sizes and ages, and all options that the result depends on.
std::string identity_of(const Session& session, const PartsTask& task) {
  std::string identity;
  std::error_code none;
  for (const std::filesystem::path& input : input_files(task.input)) {
    const auto path = std::filesystem::absolute(input, none);
    const auto age = std::filesystem::last_write_time(path, none).time_since_epoch().count();
    identity +=
        fmt::format("{} {} {}\n", path.string(), std::filesystem::file_size(path, none), age);
  }
  for (const comm::Fact& option : session.options) {
    if (option.what == "--resume" || option.what == "--stats" || option.what == "--scratch")
      continue;
    identity += fmt::format("{} {}\n", option.what, option.value);
  }
  return identity;
}

// Throws FileError (memory) where ranks of this process would share its memory in parts of which
// none does for a tile.
void require_memory_of_ranks(const Session& session, const PartsTask& task) {
  // What the program has, and what the smallest tiles take.
  constexpr std::uint64_t kLeast = std::uint64_t{56} << 20;
  const auto ranks = static_cast<std::uint64_t>(std::max(1, task.launch.ranks));
  const std::uint64_t limit = task.input.limits.budget().limit();
  const std::uint64_t least = files::resident_set() + kLeast;
  if (session.under_mpi || ranks == 1 || limit / ranks >= least) return;
  throw files::FileError(
      files::Cause::memory, "--ranks", "",
      fmt::format(
          "{} ranks share the {} that are allowed (--memory), {} each, and a rank needs {}: "
          "{} of them would do",
          ranks, files::bytes_text(limit), files::bytes_text(limit / ranks),
          files::bytes_text(least), std::max<std::uint64_t>(1, limit / least)));
}

// Large blocks go back to the system at once, so that what is resident is what is used.
void return_memory_at_once() {
  constexpr int kLarge = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, kLarge);
  mallopt(M_TRIM_THRESHOLD, kLarge);
}

}  // namespace

void add_tiles_options(CLI::App& command, TilesChoice& choice) {
  command
      .add_option(
          "--tiles", choice.tiles,
          "Tiles that points are cut into, each triangulated by itself (default: one per rank, or "
          "as many as --memory asks for)")
      ->group(group::kParallel)
      ->transform(count_between(1, 1000000));
  command
      .add_option("--scratch", choice.scratch,
                  "Folder for the points of tiles, which then wait on disk (default: that of the "
                  "output or TMPDIR, where memory does not do)")
      ->group(group::kParallel)
      ->type_name("DIR");
  command
      .add_flag("--resume", choice.resume,
                "Go on from the last tile that an earlier run with the same options has finished")
      ->group(group::kParallel);
}

std::string scratch_folder(const TilesChoice& choice, const std::string& output) {
  if (!choice.scratch.empty()) return choice.scratch;
  if (output.empty() || output == "-") return std::filesystem::temp_directory_path().string();
  std::filesystem::path path = std::filesystem::absolute(output);
  if (path.filename().empty()) path = path.parent_path();
  return path.parent_path().string();
}

std::uint64_t memory_beyond_limit(const PointInput& input, int dim) {
  constexpr std::uint64_t kReserve = std::uint64_t{16} << 20;  // for what allocators keep
  const std::uint64_t all = input.limits.budget().left(), left = all - std::min(all, kReserve);
  const std::uint64_t bytes_per_point =
      kMostBytesOfPoint + (dim == 2 ? kBytesToTriangulate2D : kBytesToTriangulate3D);
  constexpr std::uint64_t kShortestRow = 4;  // of text
  const bool packed = is_picture(input);     // any number of pixels in a few bytes
  std::uint64_t most = 0;
  for (const std::filesystem::path& path : input_files(input)) {
    std::error_code error;
    if (files::is_stream(path)) return 0;
    most += std::filesystem::file_size(path, error) / kShortestRow;
    if (error) return 0;
  }
  if (most <= left / bytes_per_point && !packed) return 0;
  const auto parts = open_parts(input);
  std::uint64_t rows = 0;
  for (std::size_t part = 0; part < parts->parts(); ++part) rows += parts->most_rows(part);
  return rows > left / bytes_per_point ? rows * bytes_per_point : 0;
}

void check_scratch(const TilesChoice& choice) {
  std::error_code error;
  if (choice.scratch.empty() || std::filesystem::is_directory(choice.scratch, error)) return;
  const bool exists = std::filesystem::exists(choice.scratch, error);
  throw files::FileError(
      files::Cause::device, choice.scratch, "",
      exists ? "is no folder (--scratch)" : "there is no such folder (--scratch)");
}

void triangulate_in_parts(Session& session, const PartsTask& task,
                          const std::function<void(const PartsMade&)>& done) {
  if (task.how.dim == 3 && !task.input.duplicates.empty()) {
    throw UsageError("--duplicates: points of 3D are equal only if their z is");
  }
  require_memory_of_ranks(session, task);
  if (task.input.limits.memory > 0) return_memory_at_once();
  const std::string_view duplicates =
      task.input.duplicates.empty() ? "first" : task.input.duplicates.c_str();
  delaunay::PartsOptions options;
  options.tiles.tiles = task.tiles.tiles;
  options.tiles.triangulate = task.how;
  options.tiles.triangulate.progress = &session.progress;
  options.memory =
      task.input.limits.budget().limit() /
      static_cast<std::uint64_t>(session.under_mpi ? 1 : std::max(1, task.launch.ranks));
  options.scratch = scratch_folder(task.tiles, task.output);
  options.to_disk = !task.tiles.scratch.empty() || task.tiles.resume;
  options.resume = task.tiles.resume;
  options.identity = identity_of(session, task);
  options.duplicates =
      find_entry(delaunay::duplicates_policies(), duplicates, "--duplicates").policy;
  options.say = [](const std::string& what) { spdlog::info("{}", what); };
  if (task.to != nullptr) {
    options.sink = task.disk;
    options.memory -= std::min(options.memory / 2, task.kept_free);
    options.on_resume = [&](const auto& finished) { task.to->add_finished(finished); };
    options.on_counted = [&](const delaunay::PointsFound& found) { task.to->check(found); };
    options.on_points = [&](comm::Communicator& communicator, const delaunay::PointsFound& found) {
      task.to->open(communicator, found);
    };
    options.on_keep = [&] { task.to->keep_unfinished(); };
    options.can_resume = task.to->can_resume();
  }
  const ProgressBar bar(session, "triangulate");
  const parallel::AllowThreads allowed(std::max(1, task.launch.ranks) * task.how.threads);
  run_ranks(session, task.launch, {task.input.path}, [&](comm::Communicator& communicator) {
    Stopwatch watch;
    const auto parts = comm::all_or_none(communicator, comm::Phase::other, [&] {
      auto opened = open_parts(task.input);
      if (task.how.dim == 3 && opened->has_z() == false) refuse_without_z(task.input);
      if (task.to != nullptr && opened->has_z() == false) task.to->require_heights(false);
      return opened;
    });
    delaunay::TileSink* const sink = task.to == nullptr ? nullptr : &task.to->sink();
    PartsMade made{triangulate_parts(communicator, *parts, options, sink), communicator.size(),
                   watch.lap(), 0, nullptr};
    if (task.to != nullptr) made.output = task.to->commit(communicator, *parts, made.result);
    made.write = watch.lap();
    comm::all_or_none(communicator, comm::Phase::other, [&] {
      if (communicator.rank() != 0) return;
      const delaunay::PartsResult& result = made.result;
      if (result.duplicates.places > 0) {
        spdlog::warn("{}: {} places have several heights ({} rows): took the {}", task.input.path,
                     result.duplicates.places, result.duplicates.rows, duplicates);
      }
      done(made);
    });
  });
}

Json tiles_json(const delaunay::PartsResult& result) {
  const auto json_of = [](const delaunay::TileStatistics& tile) {
    return Json{{"points", tile.points},
                {"halo", tile.halo},
                {"sent", tile.sent},
                {"simplices", tile.simplices},
                {"own_simplices", tile.own_simplices}};
  };
  Json tiles = Json::array();
  for (const delaunay::TileStatistics& tile : result.tiles) tiles.push_back(json_of(tile));
  return {{"tiles", tiles}, {"shared", json_of(result.shared)}};
}

}  // namespace delray::apps
