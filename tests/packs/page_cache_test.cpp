#include "packs/page_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <stdexcept>

namespace delray::packs {
namespace {

struct Number final : CachedPage {
  Number(std::uint32_t n, std::atomic<int>& alive) : number(n), alive_(alive) { ++alive_; }
  ~Number() override { --alive_; }
  Number(const Number&) = delete;
  Number& operator=(const Number&) = delete;
  std::uint64_t bytes() const override { return 10; }

  const std::uint32_t number;

 private:
  std::atomic<int>& alive_;
};

// Pages are numbers of 10 bytes; those above 1000 cannot be read.
struct Numbers {
  std::atomic<int> alive{0}, made{0};
  PageCache cache;

  Numbers(std::uint64_t limit, int threads)
      : cache(
            [this](std::uint32_t page) {
              if (page > 1000) throw std::runtime_error("no page");
              ++made;
              return std::make_shared<const Number>(page, alive);
            },
            [](std::uint32_t) { return 3; }, limit, threads) {}

  std::uint32_t get(std::uint32_t page) {
    return static_cast<const Number&>(*cache.get(page)).number;
  }
};

TEST(PageCache, DropsWhatWasUsedLeastRecently) {
  Numbers numbers(30, 0);
  for (const std::uint32_t page : {1U, 2U, 3U, 1U, 4U}) EXPECT_EQ(numbers.get(page), page);
  EXPECT_EQ(numbers.made, 4);
  numbers.get(1);  // 2 is gone, 1 is not
  EXPECT_EQ(numbers.made, 4);
  numbers.get(2);
  EXPECT_EQ(numbers.made, 5);
  EXPECT_EQ(numbers.alive, 3);
  EXPECT_EQ(numbers.cache.bytes(), 30U);
  const CacheCounts counts = numbers.cache.counts();
  EXPECT_EQ(counts.hits, 2U);
  EXPECT_EQ(counts.misses, 5U);
  EXPECT_EQ(counts.pages_read, 5U);
  EXPECT_EQ(counts.bytes_read, 15U);
}

TEST(PageCache, KeepsWhatIsHeldAndNothingElseWithoutMemory) {
  Numbers numbers(0, 0);
  {
    const auto one = numbers.cache.get(1), two = numbers.cache.get(2);
    EXPECT_EQ(numbers.alive, 2);
    EXPECT_EQ(numbers.cache.get(1), one);
    EXPECT_EQ(numbers.made, 2);
  }
  numbers.get(3);
  EXPECT_LE(numbers.alive, 1);
  numbers.cache.set_limit(0);
  EXPECT_EQ(numbers.alive, 0);
  EXPECT_EQ(numbers.cache.bytes(), 0U);
}

class Empty final : public CachedPage {
 public:
  std::uint64_t bytes() const override { return 1; }
};

TEST(PageCache, ReadsAheadAndTellsFailuresToWhoAsks) {
  Numbers numbers(1000, 2);
  const std::uint32_t pages[] = {5, 6, 2000, 7};
  numbers.cache.prefetch(pages);
  while (numbers.made < 3) std::this_thread::yield();
  for (const std::uint32_t page : {5U, 6U, 7U}) EXPECT_EQ(numbers.get(page), page);
  EXPECT_EQ(numbers.made, 3);
  EXPECT_THROW(numbers.get(2000), std::runtime_error);
  EXPECT_THROW(numbers.get(2000), std::runtime_error);
  EXPECT_EQ(numbers.get(8), 8U);
}

// The one thread that reads ahead makes a page for as long as the others are not made.
TEST(PageCache, WhoWaitsMakesWhatComesNext) {
  std::atomic<int> begun{0}, others{0};
  PageCache cache(
      [&](std::uint32_t page) -> std::shared_ptr<const CachedPage> {
        ++begun;
        if (page == 1) {
          while (others < 2) std::this_thread::yield();
        } else {
          ++others;
        }
        return std::make_shared<Empty>();
      },
      [](std::uint32_t) { return 0; }, 100, 1);
  const std::uint32_t pages[] = {1, 2, 3};
  cache.prefetch(std::span(pages).first(1));
  while (begun < 1) std::this_thread::yield();
  cache.prefetch(pages);
  EXPECT_NE(cache.get(1), nullptr);
  EXPECT_EQ(begun, 3);
}

TEST(PageCache, ManyThreadsGetWhatTheyAskFor) {
  const unsigned seed = 99;
  Numbers numbers(70, 3);
  std::atomic<int> wrong{0};
  {
    std::vector<std::jthread> threads;
    for (unsigned k = 0; k < 6; ++k) {
      threads.emplace_back([&, k] {
        std::mt19937 random(seed + k);
        for (int i = 0; i < 2000; ++i) {
          std::uint32_t pages[3];
          for (std::uint32_t& page : pages) page = static_cast<std::uint32_t>(random() % 20);
          if (i % 3 == 0) numbers.cache.prefetch(pages);
          if (i % 50 == 0) numbers.cache.cancel();
          for (const std::uint32_t page : pages) wrong += numbers.get(page) == page ? 0 : 1;
        }
      });
    }
  }
  EXPECT_EQ(wrong, 0) << "seed " << seed;
  numbers.cache.set_limit(0);
  while (numbers.alive > 0) {  // a thread may still be making one
    std::this_thread::yield();
    numbers.cache.set_limit(0);
  }
  const CacheCounts counts = numbers.cache.counts();
  EXPECT_EQ(counts.hits + counts.misses, 36000U);
}

}  // namespace
}  // namespace delray::packs
