// What pages stand for: lists on disk, surfaces of them, and shares of coarser pages.
#include "packs/build/references.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "packs/build/cut_pages.h"
#include "packs/build/reference_surface.h"
#include "scenes/generate.h"

namespace delray::packs::internal {
namespace {

bool operator==(const Reference& a, const Reference& b) {
  return a.page == b.page && a.triangle == b.triangle && a.corners == b.corners;
}

TEST(References, AreReadAsTheyWereWritten) {
  std::mt19937 random(20261128);
  ReferenceLists lists(std::filesystem::temp_directory_path());
  std::vector<std::vector<Reference>> written;
  for (const std::size_t size : {5U, 0U, 700U, 1U}) {
    std::vector<Reference>& list = written.emplace_back();
    std::uint32_t page = 0;
    for (std::size_t i = 0; i < size; ++i) {
      page += random() % 3 == 0 ? static_cast<std::uint32_t>(random()) % 5000000 : 0;
      list.push_back({page, static_cast<std::uint16_t>(random() % 8192),
                      static_cast<std::uint8_t>(random() % 8)});
    }
    lists.append(encode(list));
  }
  for (const std::size_t i : {2U, 0U, 1U, 3U}) {
    std::vector<Reference> read = {{9, 9, 1}};
    lists.read(i, read);
    ASSERT_EQ(read.size(), 1 + written[i].size());
    for (std::size_t k = 0; k < written[i].size(); ++k) EXPECT_TRUE(read[k + 1] == written[i][k]);
  }
}

TEST(References, OfSeveralPagesMakeOneSurfaceAgain) {
  const scenes::Mesh mesh = scenes::generate("gen:terrain:3000").meshes[0];
  const std::vector<Page> pages =
      cut_pages(mesh, 0, static_cast<std::uint32_t>(mesh.triangles.size()));
  ASSERT_GE(pages.size(), 4U);
  std::vector<std::uint32_t> numbers(pages.size());
  for (std::uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = 100 + i;
  const ReferenceSurface whole = whole_pages(numbers, pages, scenes::Mesh(mesh));
  // Some vertices belong to each of three runs, some to none.
  SurfaceErrors errors;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
    errors.nearest.push_back(v % 7 == 0 ? scenes::kNone : v % 30);
  const std::vector<std::uint32_t> ends = {10, 20, 30};
  const std::vector<std::vector<Reference>> shares = share_out(whole, errors, ends);
  ASSERT_EQ(shares.size(), 3U);
  std::vector<Reference> all;
  for (const std::vector<Reference>& share : shares)
    all.insert(all.end(), share.begin(), share.end());
  const ReferenceSurface again =
      surface_of(std::move(all), [&](std::uint32_t page) { return pages[page - 100]; });
  std::size_t expected = 0, measured = 0;
  for (const glm::uvec3& t : mesh.triangles)
    expected += t.x % 7 == 0 && t.y % 7 == 0 && t.z % 7 == 0 ? 0 : 1;
  EXPECT_EQ(again.triangles.size(), expected);
  EXPECT_EQ(again.mesh.triangles.size(), expected);
  for (std::size_t i = 0; i < expected; ++i) {
    const Reference& reference = again.triangles[i];
    const glm::uvec3& corners = pages[reference.page - 100].mesh.triangles[reference.triangle];
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(again.mesh.positions[again.mesh.triangles[i][k]],
                pages[reference.page - 100].mesh.positions[corners[k]]);
      measured += again.measured[again.mesh.triangles[i][k]];
    }
  }
  std::size_t corners = 0;
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) corners += t[k] % 7 == 0 ? 0 : 1;
  EXPECT_EQ(measured, corners);
}

}  // namespace
}  // namespace delray::packs::internal
