#include "delaunay/tiles/tile_store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace delray::delaunay {
namespace {

// Messages that come in any order give each tile its points by ascending rows.
void expect_points_back(TileStore& store, RecordFormat format, ScratchStore* scratch) {
  constexpr int kTiles = 5;
  std::mt19937_64 random(1);
  std::vector<std::vector<RowPoint>> expected(kTiles);
  std::vector<comm::Buffer> messages;
  std::uint64_t row = 7;
  for (int batch = 0; batch < 12; ++batch) {
    std::vector<glm::dvec3> places(random() % 50);
    std::vector<std::int32_t> tile_of;
    for (glm::dvec3& place : places) {
      place = glm::dvec3(random(), random(), format.with_z ? random() : 0);
      tile_of.push_back(static_cast<std::int32_t>(random() % (kTiles - 1)));  // the last has none
    }
    const PointRun run{places, row};
    for (std::size_t i = 0; i < places.size(); ++i) {
      expected[static_cast<std::size_t>(tile_of[i])].push_back({places[i], row + i});
    }
    row += places.size();
    for (comm::Parcel& parcel : pack_by_tile(std::span(&run, 1), tile_of, format, kTiles, 1)) {
      messages.push_back(std::move(parcel.message));
    }
  }
  std::ranges::shuffle(messages, random);
  for (comm::Buffer& message : messages) store.add(std::move(message));
  if (scratch != nullptr) {
    std::vector<std::uint64_t> sizes;
    for (const auto& points : expected) sizes.push_back(points.size());
    scratch->expect(sizes, 0);
  }
  for (std::size_t tile = 0; tile < kTiles; ++tile) {
    const std::vector<RowPoint> points = store.read(tile);
    ASSERT_EQ(points.size(), expected[tile].size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(points[i].row, expected[tile][i].row);
      EXPECT_EQ(points[i].position, expected[tile][i].position);
    }
    store.drop(tile);
  }
}

TEST(TileStore, GivesPointsBackByRows) {
  for (const bool with_z : {false, true}) {
    MemoryStore memory({with_z}, 0, 5);
    expect_points_back(memory, {with_z}, nullptr);
    const tests::TemporaryFolder folder;
    ScratchStore scratch({with_z}, folder.path());
    expect_points_back(scratch, {with_z}, &scratch);
    EXPECT_EQ(folder.entries(), 0U);
    EXPECT_GT(scratch.bytes_on_disk(), 0U);
  }
}

}  // namespace
}  // namespace delray::delaunay
