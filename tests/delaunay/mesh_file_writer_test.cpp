#include "delaunay/mesh_file_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <mutex>
#include <random>
#include <sstream>
#include <string>

#include "comm/collectives.h"
#include "comm/threads.h"
#include "delaunay/duplicates.h"
#include "delaunay/generate.h"
#include "delaunay/read_mesh.h"
#include "delaunay/write_mesh.h"
#include "files/error.h"
#include "tests/support/temporary_folder.h"

namespace delray::delaunay {
namespace {

namespace fs = std::filesystem;

// A cloud with all that it has, in parts of some rows.
class WholeParts : public PointParts {
 public:
  WholeParts(const PointCloud& cloud, std::size_t rows) : cloud_(cloud), rows_(rows) {}
  std::size_t parts() const override { return (cloud_.size() + rows_ - 1) / rows_; }
  std::uint64_t most_rows(std::size_t part) const override {
    return std::min(rows_, cloud_.size() - part * rows_);
  }
  void read(std::size_t part, PointCloud& points) const override {
    points = {};
    points.has_z = cloud_.has_z;
    const auto take = [&](const auto& from, auto& to) {
      if (from.empty()) return;
      const auto first = from.begin() + static_cast<std::ptrdiff_t>(part * rows_);
      to.assign(first, first + static_cast<std::ptrdiff_t>(most_rows(part)));
    };
    take(cloud_.positions, points.positions);
    take(cloud_.colours, points.colours);
    take(cloud_.intensity, points.intensity);
    take(cloud_.classification, points.classification);
  }

 private:
  const PointCloud& cloud_;
  std::size_t rows_;
};

struct Ways {
  int tiles = 1, ranks = 1, threads = 1;
  bool is_shared = true;  // ranks have one writer
  std::size_t part_rows = 1000;
  Duplicates duplicates = Duplicates::first;
  std::uint64_t memory = std::uint64_t{1} << 40;
  parallel::Progress* progress = nullptr;  // of writing
};

// Triangulates tile by tile into a file.
PartsResult write(const fs::path& path, const PointCloud& cloud, int dim, const Ways& ways,
                  const fs::path& scratch) {
  const WholeParts parts(cloud, ways.part_rows);
  PartsResult made;
  std::mutex mutex;
  std::unique_ptr<MeshFileWriter> shared;
  comm::run_threads(ways.ranks, ways.threads, [&](comm::Communicator& communicator) {
    std::unique_ptr<MeshFileWriter> own;
    std::unique_ptr<MeshFileWriter>& writer = ways.is_shared ? shared : own;
    PartRows rows;
    // Opened when the points are known.
    class Later : public TileSink {
     public:
      explicit Later(std::unique_ptr<MeshFileWriter>& to) : to_(to) {}
      void take(const TilePiece& piece) override { to_->take(piece); }
      void take_heights(std::span<const RowPoint> points) override { to_->take_heights(points); }

     private:
      std::unique_ptr<MeshFileWriter>& to_;
    } sink(writer);
    PartsOptions options;
    options.tiles.tiles = ways.tiles;
    options.tiles.triangulate.dim = dim;
    options.tiles.triangulate.threads = ways.threads;
    options.duplicates = ways.duplicates;
    options.on_points = [&](comm::Communicator& all, const PointsFound& found) {
      rows = found.rows;
      MeshFileOptions file;
      file.dim = dim;
      file.points = found.points;
      file.has_z = found.has_z;
      file.attributes = found.attributes;
      file.scratch = scratch;
      file.memory = ways.memory;
      file.threads = ways.threads;
      file.ranks = ways.is_shared ? ways.ranks : 1;
      file.writer = all.rank();
      file.progress = ways.progress;
      if (all.rank() == 0 || !ways.is_shared) writer = std::make_unique<MeshFileWriter>(path, file);
      comm::barrier(all);
    };
    const PartsResult result = triangulate_parts(communicator, parts, options, &sink);
    writer->write(communicator, {parts, rows, ways.is_shared});
    if (communicator.rank() != 0) return;
    writer->commit();
    const std::lock_guard lock(mutex);
    made = result;
  });
  return made;
}

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return (std::ostringstream() << file.rdbuf()).str();
}

PointCloud with_attributes(PointCloud cloud, std::uint32_t seed) {
  std::mt19937 random(seed);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.colours.emplace_back(random() % 256, random() % 256, random() % 256, 255);
    cloud.intensity.push_back(static_cast<float>(random() % 100) / 100);
    cloud.classification.push_back(static_cast<std::uint8_t>(random() % 10));
  }
  return cloud;
}

// Each way gives the same bytes, and the mesh that memory would have given.
void expect_same_file(const PointCloud& cloud, int dim, const std::string& name) {
  const tests::TemporaryFolder folder;
  Options options;
  options.dim = dim;
  const Triangulation whole = triangulate(view(cloud.positions), options).triangulation;
  write_mesh(folder / ("whole" + name), cloud, whole);
  const std::string in_memory = content(folder / ("whole" + name));
  std::string expected;
  for (const Ways& ways :
       {Ways{}, Ways{7, 1, 2}, Ways{4, 3, 1, true, 300}, Ways{4, 3, 1, false, 300},
        Ways{9, 2, 2, false, 70}, Ways{5, 1, 3, true, 50000}}) {
    SCOPED_TRACE("ranks " + std::to_string(ways.ranks) + ", shared " +
                 std::to_string(ways.is_shared));
    const fs::path path = folder / ("parts" + name);
    write(path, cloud, dim, ways, folder / ".");
    const std::string written = content(path);
    if (expected.empty()) expected = written;
    EXPECT_TRUE(written == expected);
    const PointMesh mesh = read_mesh(path);
    EXPECT_EQ(hash(mesh.triangulation), hash(whole));
    EXPECT_EQ(mesh.points.positions, cloud.positions);
    EXPECT_EQ(mesh.points.colours, read_mesh(folder / ("whole" + name)).points.colours);
    EXPECT_EQ(folder.entries(), 2U);
  }
  // But for the order of simplices it is the file of a mesh in memory.
  ASSERT_EQ(expected.size(), in_memory.size());
  std::string a = expected, b = in_memory;
  std::ranges::sort(a);
  std::ranges::sort(b);
  EXPECT_TRUE(a == b);
}

TEST(MeshFileWriter, WritesWhatMemoryWouldForEveryKindOfPoints) {
  for (const std::string kind : {"uniform", "cluster", "grid", "arc"}) {
    SCOPED_TRACE(kind);
    expect_same_file(generate_points(kind, 3000, 2, 5), 2, ".ply");
    expect_same_file(generate_points(kind, 3000, 2, 6), 2, ".vtu");
    if (kind != "arc") expect_same_file(generate_points(kind, 800, 3, 7), 3, ".vtu");
  }
}

TEST(MeshFileWriter, KeepsAttributes) {
  const PointCloud cloud = with_attributes(generate_points("uniform", 900, 3, 2), 1);
  expect_same_file(cloud, 2, ".ply");
  expect_same_file(cloud, 2, ".vtu");
  expect_same_file(cloud, 3, ".vtu");
  // Points before the simplices are the same bytes.
  const tests::TemporaryFolder folder;
  const Triangulation whole = triangulate(view(cloud.positions)).triangulation;
  write_mesh(folder / "a.ply", cloud, whole);
  write(folder / "b.ply", cloud, 2, {3, 2}, folder / ".");
  const std::string a = content(folder / "a.ply"), b = content(folder / "b.ply");
  const std::size_t points = a.size() - whole.size() * 13;
  EXPECT_TRUE(a.substr(0, points) == b.substr(0, points));
}

TEST(MeshFileWriter, WritesMergedHeights) {
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    PointCloud cloud;
    cloud.has_z = true;
    for (int i = 0; i < 2000; ++i) {
      cloud.positions.emplace_back(random() % 40, random() % 40, random() % 100);
    }
    for (const Duplicates policy : {Duplicates::first, Duplicates::max, Duplicates::mean}) {
      PointCloud merged = cloud;
      merge_duplicates(merged, policy);
      const tests::TemporaryFolder folder;
      for (const bool is_shared : {true, false}) {
        for (const char* name : {"m.ply", "m.vtu"}) {
          write(folder / name, cloud, 2, {6, 2, 2, is_shared, 150, policy}, folder / ".");
          EXPECT_EQ(read_mesh(folder / name).points.positions, merged.positions);
        }
      }
    }
  }
}

TEST(MeshFileWriter, WritesPointsWithoutSimplices) {
  PointCloud line;
  for (int i = 0; i < 20; ++i) line.positions.emplace_back(i, 2 * i, 0);
  for (const char* name : {".ply", ".vtu"}) expect_same_file(line, 2, name);
}

TEST(MeshFileWriter, KnowsWhatItCanWrite) {
  EXPECT_TRUE(can_write_in_parts("a.ply", 2));
  EXPECT_TRUE(can_write_in_parts("-", 2));
  EXPECT_TRUE(can_write_in_parts("a.vtu", 3));
  EXPECT_FALSE(can_write_in_parts("a.ply", 3));
  EXPECT_FALSE(can_write_in_parts("a.obj", 2));
  EXPECT_THROW(can_write_in_parts("a.xyzw", 2), std::invalid_argument);
}

TEST(MeshFileWriter, CanBeStopped) {
  const tests::TemporaryFolder folder;
  const PointCloud cloud = generate_points("uniform", 2000, 2, 1);
  parallel::Progress progress;
  progress.request_stop();
  Ways ways{3, 2};
  ways.progress = &progress;
  EXPECT_THROW(write(folder / "m.ply", cloud, 2, ways, folder / "."), parallel::Interrupted);
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(MeshFileWriter, LeavesNothingAfterAFailure) {
  const tests::TemporaryFolder folder;
  const PointCloud cloud = generate_points("uniform", 60000, 2, 1);
  const auto cause_of = [&](const Ways& ways, const fs::path& scratch) {
    try {
      write(folder / "m.ply", cloud, 2, ways, scratch);
    } catch (const files::FileError& error) {
      return error.cause();
    }
    ADD_FAILURE() << "no error";
    return files::Cause::input;
  };
  EXPECT_EQ(cause_of({3}, folder / "missing"), files::Cause::device);
  // This process has more than a megabyte already.
  EXPECT_EQ(cause_of({3, 2, 1, true, 1000, Duplicates::first, 1 << 20}, folder / "."),
            files::Cause::memory);
  EXPECT_EQ(folder.entries(), 0U);
  fs::create_symlink("/dev/full", folder / "full.ply");
  try {
    write(folder / "full.ply", cloud, 2, {3}, folder / ".");
    ADD_FAILURE() << "no error";
  } catch (const files::FileError& error) {
    EXPECT_EQ(error.cause(), files::Cause::device) << error.what();
  }
}

}  // namespace
}  // namespace delray::delaunay
