// Pixels from those who have them to those who show them.
#include "loadbalance/deliver.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "comm/recording.h"
#include "comm/threads.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

struct Colour {
  std::uint32_t x, y, salt;
};
struct Memory {
  std::vector<Colour> colour;
  std::vector<float> depth;
};

Memory memory_for(const Rect& rect, std::size_t stride) {
  const std::size_t pixels = stride * static_cast<std::size_t>(rect.height());
  return {std::vector<Colour>(pixels), std::vector<float>(pixels, -1)};
}

// A frame cut into random rectangles.
std::vector<Region> random_cut(std::mt19937& random, const Rect& frame, int ranks, int depth) {
  if (depth == 0 || frame.width() < 2 || frame.height() < 2)
    return {{frame, static_cast<int>(random() % static_cast<unsigned>(ranks))}};
  Rect low = frame, high = frame;
  if (random() % 2 == 0)
    low.x1 = high.x0 = frame.x0 + 1 + static_cast<int>(random() % (frame.width() - 1));
  else
    low.y1 = high.y0 = frame.y0 + 1 + static_cast<int>(random() % (frame.height() - 1));
  std::vector<Region> all = random_cut(random, low, ranks, depth - 1);
  for (const Region& region : random_cut(random, high, ranks, depth - 1)) all.push_back(region);
  return all;
}

TEST(Deliver, EveryPixelComesToWhereItIsShown) {
  const auto seed = static_cast<unsigned>(std::random_device{}());
  SCOPED_TRACE("seed " + std::to_string(seed));
  for (unsigned turn = 0; turn < 60; ++turn) {
    std::mt19937 random(seed + turn);
    const int ranks = static_cast<int>(turn % 5) + 1;
    const Rect frame{-3, 4, 40, 37};
    std::vector<Region> had = random_cut(random, frame, ranks, 4);
    std::vector<Region> displays = random_cut(random, frame, ranks, 3);
    // What nobody has stays, and what nobody shows does not travel.
    if (turn % 3 == 0) had.erase(had.begin());
    if (turn % 4 == 0) displays.erase(displays.begin());
    comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
      std::vector<Memory> memory;
      std::vector<Pixels> mine;
      memory.reserve(had.size() + displays.size());
      for (const Region& region : had) {
        if (region.owner != communicator.rank()) continue;
        const std::size_t stride = static_cast<std::size_t>(region.rect.width()) + turn % 2;
        Memory& m = memory.emplace_back(memory_for(region.rect, stride));
        for (int y = region.rect.y0; y < region.rect.y1; ++y) {
          for (int x = region.rect.x0; x < region.rect.x1; ++x) {
            const std::size_t i = static_cast<std::size_t>(y - region.rect.y0) * stride +
                                  static_cast<std::size_t>(x - region.rect.x0);
            m.colour[i] = {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 7};
            m.depth[i] = static_cast<float>(100 * x + y);
          }
        }
        mine.push_back({region.rect, reinterpret_cast<const std::byte*>(m.colour.data()),
                        m.depth.data(), stride});
      }
      std::vector<PixelsToSet> shown;
      std::vector<const Memory*> pictures;
      for (const Region& display : displays) {
        if (display.owner != communicator.rank()) continue;
        const auto stride = static_cast<std::size_t>(display.rect.width());
        Memory& m = memory.emplace_back(memory_for(display.rect, stride));
        shown.push_back(
            {display.rect, reinterpret_cast<std::byte*>(m.colour.data()), m.depth.data(), stride});
        pictures.push_back(&m);
      }
      deliver(communicator, mine, sizeof(Colour), displays, shown);
      for (std::size_t k = 0; k < shown.size(); ++k) {
        const Rect& rect = shown[k].rect;
        for (int y = rect.y0; y < rect.y1; ++y) {
          for (int x = rect.x0; x < rect.x1; ++x) {
            const std::size_t i = static_cast<std::size_t>(y - rect.y0) * shown[k].stride +
                                  static_cast<std::size_t>(x - rect.x0);
            const bool anybody = std::ranges::any_of(
                had, [&](const Region& region) { return region.rect.contains(x, y); });
            const Colour& c = pictures[k]->colour[i];
            EXPECT_EQ(c.salt, anybody ? 7U : 0U);
            EXPECT_EQ(static_cast<int>(c.x), anybody ? x : 0);
            EXPECT_EQ(pictures[k]->depth[i], anybody ? static_cast<float>(100 * x + y) : -1);
          }
        }
      }
    });
  }
}

// Of four quarters, each shown by the rank opposite: 16 x 16 pixels of 4 + 4 bytes, 8 bytes of a
// count and 20 of a rectangle, beside what finds out who sends to whom.
TEST(Deliver, SendsAPixelOnce) {
  std::vector<Region> had, displays;
  for (int k = 0; k < 4; ++k) {
    const Rect quarter{k % 2 * 16, k / 2 * 16, k % 2 * 16 + 16, k / 2 * 16 + 16};
    had.push_back({quarter, k});
    displays.push_back({quarter, 3 - k});
  }
  comm::run_threads(4, 1, [&](comm::Communicator& communicator) {
    std::vector<comm::Event> events;
    comm::Recording recording(communicator, events);
    std::vector<std::uint32_t> colour(256), result(256);
    std::vector<float> depth(256), result_depth(256);
    const Rect& mine = had[static_cast<std::size_t>(communicator.rank())].rect;
    const Rect& shown = displays[static_cast<std::size_t>(3 - communicator.rank())].rect;
    const Pixels pixels{mine, reinterpret_cast<const std::byte*>(colour.data()), depth.data(), 16};
    const PixelsToSet to{shown, reinterpret_cast<std::byte*>(result.data()), result_depth.data(),
                         16};
    deliver(recording, {&pixels, 1}, 4, displays, {&to, 1});
    std::uint64_t largest = 0;
    for (const comm::Event& event : events)
      if (event.kind == comm::Event::Kind::send) largest = std::max(largest, event.amount);
    EXPECT_EQ(largest, 256U * 8 + 28);
  });
}

}  // namespace
}  // namespace delray::loadbalance
