// Walls of displays, and the pixels that travel to them.
#include "loadbalance/wall.h"

#include <gtest/gtest.h>

#include <random>

namespace delray::loadbalance {
namespace {

using geometry::Rect;

Wall random_wall(std::mt19937& random) {
  const auto up_to = [&](int n) {
    return static_cast<int>(random() % static_cast<unsigned>(n)) + 1;
  };
  Wall wall{up_to(5), up_to(4), up_to(30), up_to(20)};
  wall.bezel_x = up_to(6) - 1;
  wall.bezel_y = up_to(6) - 1;
  return wall;
}

// By pixel of the frame: who has it, or -1.
std::vector<int> owners(const Rect& frame, std::span<const Region> regions) {
  std::vector<int> result(static_cast<std::size_t>(frame.area()), -1);
  for (const Region& region : regions) {
    for (int y = region.rect.y0; y < region.rect.y1; ++y) {
      for (int x = region.rect.x0; x < region.rect.x1; ++x) {
        int& owner = result[static_cast<std::size_t>(y * frame.width() + x)];
        EXPECT_EQ(owner, -1);
        owner = region.owner;
      }
    }
  }
  return result;
}

TEST(Wall, OfFullHdDisplaysWithBezels) {
  const Wall wall{4, 3, 1920, 1080, 60, 40};
  EXPECT_EQ(wall.displays(), 12);
  EXPECT_EQ(wall.frame(), (Rect{0, 0, 4 * 1920 + 3 * 60, 3 * 1080 + 2 * 40}));
  EXPECT_EQ(wall.display(0), (Rect{0, 0, 1920, 1080}));
  EXPECT_EQ(wall.display(3), (Rect{5940, 0, 7860, 1080}));
  EXPECT_EQ(wall.display(11), (Rect{5940, 2240, 7860, 3320}));
}

TEST(Wall, DisplaysAreDealtEvenly) {
  const Wall wall{4, 3, 10, 10};
  for (int ranks = 1; ranks <= 40; ++ranks) {
    std::vector<int> shown(static_cast<std::size_t>(ranks));
    int last = 0;
    for (const Region& display : displays_of(wall, ranks)) {
      EXPECT_GE(display.owner, last);
      last = display.owner;
      ++shown[static_cast<std::size_t>(display.owner)];
    }
    const int most = (12 + ranks - 1) / ranks;
    EXPECT_EQ(*std::ranges::max_element(shown), most) << ranks;
    if (ranks <= 12) {
      EXPECT_GE(*std::ranges::min_element(shown), 12 / ranks) << ranks;
    }
  }
}

TEST(Wall, IsCutAlongItsBezels) {
  std::mt19937 random(5);
  for (int turn = 0; turn < 200; ++turn) {
    const Wall wall = random_wall(random);
    const std::vector<Region> displays = displays_of(wall, 7);
    const Partition partition = cut_by_displays(wall.frame(), displays);
    const std::vector<int> drawn = owners(wall.frame(), partition.regions);
    EXPECT_EQ(std::ranges::count(drawn, -1), 0);
    const std::vector<int> shown = owners(wall.frame(), displays);
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      if (shown[i] >= 0) {
        EXPECT_EQ(drawn[i], shown[i]);
      }
    }
    EXPECT_EQ(pixel_traffic(partition, displays, 7).pixels, 0U);
  }
}

TEST(Wall, TrafficIsThatOfItsPixels) {
  std::mt19937 random(6);
  for (int turn = 0; turn < 200; ++turn) {
    const Wall wall = random_wall(random);
    const int ranks = static_cast<int>(random() % 6) + 1;
    const Rect frame = wall.frame();
    Costs costs = make_costs(frame, frame.width(), frame.height(), {});
    const char* const name = turn % 2 == 0 ? "kd-split" : "strips";
    const Partitioner* partitioner = find_partitioner(name);
    if (partitioner == nullptr) partitioner = &partitioners()[0];
    const Partition partition = partitioner->partition(costs, frame, ranks);
    const std::vector<Region> displays = displays_of(wall, ranks);
    const std::vector<int> drawn = owners(frame, partition.regions),
                           shown = owners(frame, displays);
    std::vector<std::uint64_t> moved(static_cast<std::size_t>(ranks));
    std::uint64_t pixels = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      if (shown[i] < 0 || shown[i] == drawn[i]) continue;
      ++pixels;
      ++moved[static_cast<std::size_t>(shown[i])];
      ++moved[static_cast<std::size_t>(drawn[i])];
    }
    const PixelTraffic traffic = pixel_traffic(partition, displays, ranks);
    EXPECT_EQ(traffic.pixels, pixels);
    EXPECT_EQ(traffic.busiest, *std::ranges::max_element(moved));
  }
}

}  // namespace
}  // namespace delray::loadbalance
