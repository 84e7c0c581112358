// Buffers: ownership, moves, copies, and memory that is used again.
#include "comm/buffer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <thread>
#include <vector>

namespace delray::comm {
namespace {

void fill(Buffer& buffer, int value) {
  for (std::size_t i = 0; i < buffer.size(); i += 1 + i / 8) {
    buffer.data()[i] = static_cast<std::byte>(value + static_cast<int>(i % 7));
  }
}

bool is_filled(const Buffer& buffer, int value) {
  for (std::size_t i = 0; i < buffer.size(); i += 1 + i / 8) {
    if (buffer.data()[i] != static_cast<std::byte>(value + static_cast<int>(i % 7))) return false;
  }
  return true;
}

TEST(Buffer, OwnsItsBytesWhateverTheSize) {
  for (const unsigned seed : {1U, 2U}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::vector<std::pair<Buffer, int>> held;
    for (int step = 0; step < 300; ++step) {
      if (held.size() > 20 || (!held.empty() && random() % 3 == 0)) {
        const std::size_t i = random() % held.size();
        ASSERT_TRUE(is_filled(held[i].first, held[i].second));
        if (random() % 2 == 0) held[i] = std::move(held.back());
        held.pop_back();
        continue;
      }
      // Around the sizes at which memory is handled in another way.
      const std::size_t power = random() % 22;
      const std::size_t size = (std::size_t{1} << power) + random() % 5 - (power > 1 ? 2 : 0);
      Buffer buffer(size);
      EXPECT_EQ(buffer.size(), size);
      EXPECT_EQ(buffer.counted_bytes(), size);
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.data()) % alignof(std::max_align_t), 0U);
      fill(buffer, step);
      held.emplace_back(std::move(buffer), step);
    }
    for (const auto& [buffer, value] : held) EXPECT_TRUE(is_filled(buffer, value));
  }
}

TEST(Buffer, MovesAndCopies) {
  Buffer a(100'000);
  fill(a, 3);
  Buffer b = std::move(a);
  EXPECT_TRUE(a.empty());
  EXPECT_EQ(a.data(), nullptr);
  EXPECT_TRUE(is_filled(b, 3));
  Buffer& same = b;
  b = std::move(same);
  EXPECT_TRUE(is_filled(b, 3));
  const Buffer c = b.copy();
  EXPECT_NE(c.data(), b.data());
  EXPECT_TRUE(is_filled(c, 3));
  EXPECT_EQ(Buffer(0).size(), 0U);
}

TEST(Buffer, MayBeDestroyedByAnotherThread) {
  std::vector<std::jthread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([thread] {
      for (int step = 0; step < 50; ++step) {
        Buffer buffer(std::size_t{1} << (14 + (step + thread) % 6));
        fill(buffer, thread);
        std::jthread(
            [moved = std::move(buffer), thread] { EXPECT_TRUE(is_filled(moved, thread)); });
      }
    });
  }
}

#ifndef DELRAY_ASAN
TEST(Buffer, TakesLargeMemoryAgainThatWasGivenBack) {
  const std::byte* before = nullptr;
  {
    const Buffer buffer(3'000'000);
    before = buffer.data();
  }
  EXPECT_EQ(Buffer(2'900'000).data(), before);
}
#endif

}  // namespace
}  // namespace delray::comm
