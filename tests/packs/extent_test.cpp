#include "packs/extent.h"

#include <gtest/gtest.h>

#include <random>

#include "packs/pack_writer.h"
#include "scenes/generate.h"
#include "tests/raster/random_scene.h"
#include "tests/support/temporary_folder.h"

namespace delray::packs {
namespace {

void expect_same_extent(const scenes::Scene& scene, unsigned seed) {
  const tests::TemporaryFolder folder;
  write_pack(folder / "a.pack", scene, {.levels = false});
  const PackReader pack(folder / "a.pack");
  const scenes::FarthestPoints expected = scenes::farthest_points(scene);
  const scenes::FarthestPoints found = farthest_points(pack);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (const int n : {0, 1, 6, 24}) {
    std::vector<glm::dvec3> directions;
    for (int i = 0; i < n; ++i)
      directions.emplace_back(normal(random), i % 3 == 0 ? 0.0 : normal(random), normal(random));
    EXPECT_EQ(found(directions), expected(directions)) << "seed " << seed << ", " << n;
  }
}

TEST(PackExtent, IsThatOfTheScene) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    scenes::Scene scene = raster::random_scene(seed, 900);
    expect_same_extent(scene, seed);
    scene.framed = {glm::vec3(-0.3F), glm::vec3(0.9F, 0.2F, 0.4F)};
    expect_same_extent(scene, seed);
  }
  expect_same_extent(scenes::generate("gen:terrain:20000"), 7);
  expect_same_extent(scenes::generate("gen:field:20000"), 8);
}

}  // namespace
}  // namespace delray::packs
