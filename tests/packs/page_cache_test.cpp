#include "packs/page_cache.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

namespace delray::packs {
namespace {

class Empty final : public CachedPage {
 public:
  std::uint64_t bytes() const override { return 1; }
};

struct Number final : CachedPage {
  Number(std::uint32_t n, std::atomic<int>& alive) : number(n), alive_(alive) { ++alive_; }
  ~Number() override { --alive_; }
  Number(const Number&) = delete;
  Number& operator=(const Number&) = delete;
  std::uint64_t bytes() const override { return 10; }

  std::uint32_t number;

 private:
  std::atomic<int>& alive_;
};

// Pages are numbers of 10 bytes; those above 1000 cannot be read.
struct Numbers {
  std::atomic<int> alive{0}, made{0}, made_of_old{0};
  PageCache cache;

  explicit Numbers(std::uint64_t limit)
      : cache(
            3000,
            [this](std::uint32_t page, std::unique_ptr<CachedPage> old) {
              if (page > 1000) throw std::runtime_error("no page");
              ++made;
              if (old == nullptr) return PageCache::Made{std::make_unique<Number>(page, alive)};
              ++made_of_old;
              static_cast<Number&>(*old).number = page;
              return PageCache::Made{std::move(old), 0.5};
            },
            [](std::uint32_t) { return 3; }, limit) {}

  std::uint32_t get(std::uint32_t page) {
    return static_cast<const Number&>(*cache.get(page)).number;
  }
  // Whether it need not be made.
  bool has(std::uint32_t page) { return cache.missing(std::array{page}).empty(); }
};

TEST(PageCache, DropsWhatWasUsedLeastRecentlyBeforeThisFrame) {
  Numbers numbers(30);
  for (const std::uint32_t page : {1U, 2U, 3U, 1U}) EXPECT_EQ(numbers.get(page), page);
  numbers.cache.begin_frame();
  EXPECT_EQ(numbers.get(4), 4U);
  EXPECT_TRUE(numbers.has(1) && !numbers.has(2) && numbers.has(3) && numbers.has(4));
  numbers.get(1);
  numbers.get(5);
  EXPECT_TRUE(numbers.has(1) && !numbers.has(3) && numbers.has(4) && numbers.has(5));
  EXPECT_EQ(numbers.cache.bytes(), 30U);
  const CacheCounts counts = numbers.cache.counts();
  EXPECT_EQ(counts.hits, 2U);
  EXPECT_EQ(counts.misses, 5U);
  EXPECT_EQ(counts.pages_read, 5U);
  EXPECT_EQ(counts.bytes_read, 15U);
}

// Of a loop over more pages than there is memory for, as many are there in the next round as fit.
TEST(PageCache, KeepsAsMuchOfALoopAsFits) {
  Numbers numbers(200);
  for (int round = 0; round < 3; ++round) {
    numbers.cache.begin_frame();
    const int made = numbers.made;
    for (std::uint32_t page = 0; page < 50; ++page) EXPECT_EQ(numbers.get(page), page);
    EXPECT_LE(numbers.made - made, round == 0 ? 50 : 50 - 18) << "round " << round;
    EXPECT_LE(numbers.cache.bytes(), 200U);
  }
}

TEST(PageCache, KeepsWhatIsHeldAndNothingElseWithoutMemory) {
  Numbers numbers(0);
  {
    const auto one = numbers.cache.get(1), two = numbers.cache.get(2);
    EXPECT_EQ(numbers.alive, 2);
    EXPECT_EQ(&*numbers.cache.get(1), &*one);
    EXPECT_EQ(numbers.made, 2);
    EXPECT_EQ(numbers.get(3), 3U);
    EXPECT_EQ(static_cast<const Number&>(*one).number, 1U);
  }
  numbers.cache.set_limit(0);
  EXPECT_EQ(numbers.cache.bytes(), 0U);
  EXPECT_TRUE(!numbers.has(1) && !numbers.has(2) && !numbers.has(3));
}

TEST(PageCache, DropsTheOneThatNobodyHolds) {
  Numbers numbers(1000);
  std::vector<PageCache::Held> held;
  numbers.get(0);
  for (std::uint32_t page = 1; page <= 500; ++page) held.push_back(numbers.cache.get(page));
  EXPECT_FALSE(numbers.has(0));
  EXPECT_EQ(numbers.cache.bytes(), 5000U);
}

TEST(PageCache, UsesTheMemoryOfWhatGoes) {
  Numbers numbers(50);
  for (std::uint32_t page = 0; page < 100; ++page) EXPECT_EQ(numbers.get(page), page);
  EXPECT_LE(numbers.alive, 7);
  EXPECT_GE(numbers.made_of_old, 93);
  EXPECT_EQ(numbers.cache.counts().stalls, static_cast<std::uint64_t>(numbers.made_of_old));
  EXPECT_EQ(numbers.cache.counts().stall_seconds, 0.5 * numbers.made_of_old);
}

TEST(PageCache, TellsFailuresToWhoAsks) {
  Numbers numbers(1000);
  EXPECT_THROW(numbers.get(2000), std::runtime_error);
  EXPECT_THROW(numbers.get(2000), std::runtime_error);
  EXPECT_FALSE(numbers.has(2000));
  EXPECT_EQ(numbers.get(8), 8U);
}

// While one thread makes a page, others wait for it rather than make it, too; if it cannot be made,
// each of them is told.
TEST(PageCache, MakesAPageOnceForAll) {
  std::atomic<int> begun{0}, failures{0};
  std::atomic<bool> go{false};
  PageCache cache(
      2,
      [&](std::uint32_t page, const std::unique_ptr<CachedPage>&) {
        ++begun;
        while (!go) std::this_thread::yield();
        if (page == 1) throw std::runtime_error("no page");
        return PageCache::Made{std::make_unique<Empty>()};
      },
      [](std::uint32_t) { return 0; }, 100);
  for (const std::uint32_t page : {0U, 1U}) {
    begun = 0;
    go = false;
    std::vector<std::jthread> threads(4);
    for (std::jthread& thread : threads) {
      thread = std::jthread([&] {
        try {
          EXPECT_EQ((*cache.get(page)).bytes(), 1U);
        } catch (const std::runtime_error&) {
          ++failures;
        }
      });
    }
    while (begun < 1) std::this_thread::yield();
    EXPECT_TRUE(cache.missing(std::array{page}).empty());
    go = true;
    threads.clear();
    EXPECT_EQ(begun, page == 0 ? 1 : 4);
    EXPECT_EQ(failures, page == 0 ? 0 : 4);
  }
}

TEST(PageCache, ManyThreadsGetWhatTheyAskFor) {
  const unsigned seed = 99;
  Numbers numbers(70);
  std::atomic<int> wrong{0};
  {
    std::vector<std::jthread> threads;
    for (unsigned k = 0; k < 6; ++k) {
      threads.emplace_back([&, k] {
        std::mt19937 random(seed + k);
        for (int i = 0; i < 2000; ++i) {
          if (i % 50 == 0) numbers.cache.begin_frame();
          for (int j = 0; j < 3; ++j) {
            const auto page = static_cast<std::uint32_t>(random() % 20);
            wrong += numbers.get(page) == page ? 0 : 1;
          }
        }
      });
    }
  }
  EXPECT_EQ(wrong, 0) << "seed " << seed;
  EXPECT_LE(numbers.cache.bytes(), 70U);
  const CacheCounts counts = numbers.cache.counts();
  EXPECT_EQ(counts.hits + counts.misses, 36000U);
}

}  // namespace
}  // namespace delray::packs
