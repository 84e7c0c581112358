#include "delaunay/triangulate_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <mutex>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "comm/threads.h"
#include "delaunay/generate.h"
#include "delaunay/point_parts.h"
#include "files/error.h"
#include "files/memory_budget.h"
#include "tests/support/temporary_folder.h"

namespace delray::delaunay {
namespace {

// Adds up what it is given, and fails where it is told to.
class CountingSink final : public TileSink {
 public:
  void take(const TilePiece& piece) override {
    if (fail_after != 0 && ++taken_ >= fail_after)
      throw files::FileError(files::Cause::device, "sink", "", "full");
    std::vector<std::uint64_t> rows;
    for (const std::uint32_t corner : piece.simplices) rows.push_back(piece.points[corner].row);
    const Hash128 sum = delaunay::hash(piece.dim, rows);
    const std::lock_guard lock(mutex_);
    hash = hash + sum;
    tiles.push_back(piece.tile);
  }

  std::size_t fail_after = 0;
  Hash128 hash;
  std::vector<std::uint64_t> tiles;

 private:
  std::mutex mutex_;
  std::atomic<std::size_t> taken_ = 0;
};

struct Ways {
  int tiles = 1, ranks = 1, threads = 1;
  bool to_disk = false;
};

struct Made {
  PartsResult result;
  Hash128 sunk;
};

Made run(const PointParts& parts, int dim, const Ways& ways, const std::filesystem::path& scratch) {
  Made made;
  CountingSink sink;
  std::mutex mutex;
  comm::run_threads(ways.ranks, ways.threads, [&](comm::Communicator& communicator) {
    PartsOptions options;
    options.tiles.tiles = ways.tiles;
    options.tiles.triangulate.dim = dim;
    options.tiles.triangulate.threads = ways.threads;
    options.scratch = scratch;
    options.to_disk = ways.to_disk;
    const PartsResult result = triangulate_parts(communicator, parts, options, &sink);
    const std::lock_guard lock(mutex);
    if (communicator.rank() == 0) made.result = result;
  });
  made.sunk = sink.hash;
  return made;
}

void expect_in_core(const PointCloud& cloud, int dim, const Ways& ways,
                    const std::filesystem::path& scratch) {
  SCOPED_TRACE(std::to_string(dim) + "D, " + std::to_string(ways.tiles) + " tiles, " +
               std::to_string(ways.ranks) + " ranks, " + std::to_string(ways.threads) + " threads" +
               (ways.to_disk ? ", on disk" : ""));
  Options in_core;
  in_core.dim = dim;
  const Triangulation expected = triangulate(view(cloud.positions), in_core).triangulation;
  const Made made = run(CloudParts(cloud, 97), dim, ways, scratch);
  EXPECT_EQ(to_string(made.result.hash), to_string(hash(expected)));
  EXPECT_EQ(to_string(made.sunk), to_string(hash(expected)));
  EXPECT_EQ(made.result.simplices, expected.size());
  EXPECT_EQ(made.result.distinct, expected.distinct);
  EXPECT_EQ(made.result.hull_facets, expected.hull_facets);
  EXPECT_EQ(made.result.points, cloud.size());
  EXPECT_TRUE(std::filesystem::is_empty(scratch));
}

TEST(TriangulateParts, GivesTheTriangulationOfAllPoints) {
  const tests::TemporaryFolder folder;
  for (const int dim : {2, 3}) {
    for (const PointGenerator& kind : point_generators()) {
      SCOPED_TRACE(kind.name);
      const PointCloud cloud = kind.generate(dim == 2 ? 1500 : 400, dim, 3);
      for (const Ways& ways : {Ways{1, 1, 1, true}, Ways{7, 1, 2, true}, Ways{64, 1, 1, false},
                               Ways{7, 3, 1, false}, Ways{16, 2, 2, true}}) {
        expect_in_core(cloud, dim, ways, folder.path());
      }
    }
  }
}

TEST(TriangulateParts, TakesFewPointsAndNone) {
  const tests::TemporaryFolder folder;
  for (const std::size_t n : {0, 1, 2, 3, 5}) {
    PointCloud cloud = generate_points("uniform", 5, 3, 1);
    cloud.positions.resize(n);
    for (const int dim : {2, 3}) {
      expect_in_core(cloud, dim, {3, 1, 1, true}, folder.path());
      expect_in_core(cloud, dim, {4, 2, 1, false}, folder.path());
    }
  }
}

// Rows come from how many points the parts before have had.
TEST(TriangulateParts, CountsRowsBeyondThirtyTwoBits) {
  constexpr std::uint64_t kFar = std::uint64_t{1} << 33;
  const PointCloud cloud = generate_points("uniform", 500, 2, 1);
  const CloudParts near(cloud, 100);
  CountingSink sink;
  std::vector<std::uint64_t> rows;
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    PartsOptions options;
    options.tiles.tiles = 4;
    options.first_row = kFar;
    class Rows final : public TileSink {
     public:
      explicit Rows(std::vector<std::uint64_t>& to) : to_(to) {}
      void take(const TilePiece& piece) override {
        for (const std::uint32_t corner : piece.simplices) {
          to_.push_back(piece.points[corner].row);
        }
      }

     private:
      std::vector<std::uint64_t>& to_;
    } taken(rows);
    triangulate_parts(communicator, near, options, &taken);
  });
  for (std::uint64_t& row : rows) {
    ASSERT_GE(row, kFar);
    row -= kFar;
  }
  EXPECT_EQ(to_string(hash(2, rows)),
            to_string(hash(triangulate(view(cloud.positions)).triangulation)));
}

PartsOptions on_disk(const std::filesystem::path& scratch, int tiles) {
  PartsOptions options;
  options.tiles.tiles = tiles;
  options.scratch = scratch;
  options.to_disk = true;
  options.identity = "these points";
  return options;
}

// What fails in the middle goes on from there: the sink gets nothing twice.
TEST(TriangulateParts, ResumesFromTheLastFinishedTile) {
  const tests::TemporaryFolder folder;
  for (const int dim : {2, 3}) {
    const PointCloud cloud = generate_points("uniform", 4000, dim, 1);
    const CloudParts parts(cloud, 500);
    Options in_core;
    in_core.dim = dim;
    const Hash128 expected = hash(triangulate(view(cloud.positions), in_core).triangulation);
    PartsOptions options = on_disk(folder.path(), 9);
    options.tiles.triangulate.dim = dim;
    Hash128 sum;
    std::set<std::uint64_t> seen;
    for (const std::size_t fail_after : {3, 4, 0}) {
      comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
        CountingSink sink;
        sink.fail_after = fail_after;
        std::set<std::uint64_t> finished;
        options.on_resume = [&](const std::function<bool(std::uint64_t)>& is_finished) {
          for (const std::uint64_t tile : seen) {
            if (is_finished(tile)) finished.insert(tile);
          }
        };
        if (fail_after != 0) {
          EXPECT_THROW(triangulate_parts(communicator, parts, options, &sink), files::FileError);
        } else {
          const PartsResult result = triangulate_parts(communicator, parts, options, &sink);
          EXPECT_EQ(to_string(result.hash), to_string(expected));
          EXPECT_EQ(result.resumed, seen.size());
          EXPECT_EQ(result.distinct, cloud.size());
        }
        EXPECT_EQ(finished, seen);
        sum = sum + sink.hash;
        for (const std::uint64_t tile : sink.tiles) EXPECT_TRUE(seen.insert(tile).second) << tile;
      });
      options.resume = true;
    }
    EXPECT_EQ(to_string(sum), to_string(expected));
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    options.resume = false;
  }
}

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder,
                                            const std::string& beginning) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().filename().string().starts_with(beginning)) found.push_back(entry.path());
  }
  std::ranges::sort(found);
  return found;
}

// A byte of any file that is changed, or the end of it cut off, is found, and a file named.
TEST(TriangulateParts, FindsDamagedFiles) {
  const PointCloud cloud = generate_points("uniform", 3000, 2, 1);
  const CloudParts parts(cloud, 500);
  for (const char* which : {"tile-", "rest-", "journal", "cut"}) {
    for (const bool cut_off : {false, true}) {
      const tests::TemporaryFolder folder;
      PartsOptions options = on_disk(folder.path(), 8);
      comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
        SCOPED_TRACE(std::string(which) + (cut_off ? " cut off" : " changed"));
        CountingSink failing;
        failing.fail_after = 4;
        EXPECT_THROW(triangulate_parts(communicator, parts, options, &failing), files::FileError);
        const auto files = files_in(folder.path(), which);
        ASSERT_FALSE(files.empty());
        const std::filesystem::path& file = files.front();
        const auto size = std::filesystem::file_size(file);
        if (cut_off) {
          std::filesystem::resize_file(file, size - 1);
        } else {
          std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
          stream.seekg(static_cast<std::streamoff>(size / 2));
          const int byte = stream.get();
          stream.seekp(static_cast<std::streamoff>(size / 2));
          stream.put(static_cast<char>(byte ^ 1));
        }
        options.resume = true;
        try {
          triangulate_parts(communicator, parts, options, nullptr);
          ADD_FAILURE();
        } catch (const files::FileError& error) {
          EXPECT_EQ(error.cause(), files::Cause::device);
          // A record that lacks its end was not finished, and its tile is missed.
          const char* const named = which == std::string("journal") && cut_off ? "tile-" : which;
          EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
        }
      });
    }
  }
}

TEST(TriangulateParts, RefusesAFolderThatAnotherRunHas) {
  const tests::TemporaryFolder folder;
  const PointCloud cloud = generate_points("uniform", 300, 2, 1);
  const CloudParts parts(cloud, 100);
  const PartsOptions options = on_disk(folder.path(), 3);
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    class Nested final : public TileSink {
     public:
      std::function<void()> then;
      void take(const TilePiece&) override {
        std::exchange(then, [] {})();
      }
    } nested;
    nested.then = [&] {
      EXPECT_THROW(triangulate_parts(communicator, parts, options, nullptr), files::FileError);
    };
    triangulate_parts(communicator, parts, options, &nested);
  });
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Points on one circle cannot be settled tile by tile.
TEST(TriangulateParts, SaysWhereMemoryDoesNotDo) {
  const tests::TemporaryFolder folder;
  PointCloud cloud;
  for (int i = 0; i < 500000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 500000;
    cloud.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  const CloudParts parts(cloud);
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    PartsOptions options = on_disk(folder.path(), 0);
    options.memory = files::resident_set() + (std::uint64_t{64} << 20);
    try {
      triangulate_parts(communicator, parts, options, nullptr);
      ADD_FAILURE();
    } catch (const files::FileError& error) {
      EXPECT_EQ(error.cause(), files::Cause::memory);
      EXPECT_NE(std::string(error.what()).find("circle"), std::string::npos) << error.what();
    }
  });
}

// Before points go to disk, and for what the sink is going to write, too.
TEST(TriangulateParts, LooksForRoomOnTheDisk) {
  const tests::TemporaryFolder folder;
  const PointCloud cloud = generate_points("uniform", 300, 2, 1);
  const CloudParts parts(cloud);
  for (const bool is_result : {true, false}) {
    comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
      PartsOptions options;
      options.scratch = folder.path();
      options.to_disk = true;
      options.sink = {folder.path(), 1, 1};
      (is_result ? options.sink.result_bytes : options.sink.scratch_bytes) = std::uint64_t{1} << 50;
      CountingSink sink;
      try {
        triangulate_parts(communicator, parts, options, &sink);
        ADD_FAILURE() << "no error";
      } catch (const files::FileError& error) {
        EXPECT_EQ(error.cause(), files::Cause::device);
        EXPECT_NE(std::string(error.what()).find("are needed"), std::string::npos) << error.what();
      }
      EXPECT_TRUE(sink.tiles.empty());
    });
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(TriangulateParts, RefusesWhatCannotBe) {
  PointCloud cloud = generate_points("uniform", 300, 2, 1);
  cloud.positions[217].y = std::nan("");
  const CloudParts parts(cloud, 100);
  for (const int ranks : {1, 2}) {
    comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
      const auto complaint = [&](const PartsOptions& options) {
        try {
          triangulate_parts(communicator, parts, options, nullptr);
        } catch (const std::invalid_argument& error) {
          return std::string(error.what());
        }
        return std::string();
      };
      EXPECT_NE(complaint({}).find("row 217"), std::string::npos);
      PartsOptions options;
      options.tiles.tiles = -1;
      EXPECT_NE(complaint(options).find("-1 tiles"), std::string::npos);
      options = {};
      options.tiles.partition = "no";
      EXPECT_NE(complaint(options).find("'no' is no partition"), std::string::npos);
    });
  }
}

TEST(TriangulateParts, GivesPlacesTheHeightThatWasAskedFor) {
  PointCloud cloud = generate_points("uniform", 600, 3, 1);
  for (std::size_t i = 0; i < 100; ++i) {
    cloud.positions[i + 300] = cloud.positions[i];
    cloud.positions[i + 300].z += 1;
  }
  const CloudParts parts(cloud, 100);
  class Heights final : public TileSink {
   public:
    void take(const TilePiece& piece) override {
      const std::lock_guard lock(mutex);
      for (const std::uint32_t corner : piece.simplices) {
        const RowPoint& point = piece.points[corner];
        heights[point.row] = point.position.z;
      }
    }
    std::mutex mutex;
    std::map<std::uint64_t, double> heights;
  };
  for (const int ranks : {1, 3}) {
    Heights heights;
    comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
      PartsOptions options;
      options.tiles.tiles = 5;
      options.duplicates = Duplicates::max;
      const PartsResult result = triangulate_parts(communicator, parts, options, &heights);
      // Counted once, though tiles of several ranks are settled more than once.
      EXPECT_EQ(result.duplicates.places, 100U);
      EXPECT_EQ(result.duplicates.rows, 200U);
    });
    EXPECT_EQ(heights.heights.size(), 500U);
    for (std::size_t i = 0; i < 100; ++i) {
      EXPECT_EQ(heights.heights.at(i), cloud.positions[i].z + 1) << i;
    }
  }
}

}  // namespace
}  // namespace delray::delaunay
