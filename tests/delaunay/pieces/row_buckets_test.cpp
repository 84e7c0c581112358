#include "delaunay/pieces/row_buckets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>

#include "files/error.h"
#include "tests/support/temporary_folder.h"

namespace delray::delaunay::internal {
namespace {

std::vector<std::uint32_t> content(const RowBuckets& buckets, std::size_t bucket) {
  std::vector<std::uint32_t> numbers(buckets.bytes(bucket) / sizeof(std::uint32_t));
  buckets.read(bucket, std::as_writable_bytes(std::span(numbers)));
  return numbers;
}

TEST(RowBuckets, GiveBackWhatThreadsAdd) {
  const tests::TemporaryFolder folder;
  constexpr std::size_t kBuckets = 5, kThreads = 4;
  RowBuckets buckets(kBuckets, folder / ".");
  std::vector<std::vector<std::uint32_t>> added(kThreads * kBuckets);
  {
    std::vector<std::jthread> threads;
    for (std::size_t thread = 0; thread < kThreads; ++thread) {
      threads.emplace_back([&, thread] {
        std::mt19937 random(static_cast<std::uint32_t>(thread));
        for (int i = 0; i < 60; ++i) {
          // Some larger than a block, some empty; the last bucket stays empty.
          std::vector<std::uint32_t> numbers(random() % (i % 20 == 0 ? 20000 : 700));
          std::ranges::generate(numbers, [&] { return static_cast<std::uint32_t>(random()); });
          const std::size_t bucket = random() % (kBuckets - 1);
          buckets.add(bucket, std::as_bytes(std::span(numbers)));
          auto& mine = added[thread * kBuckets + bucket];
          mine.insert(mine.end(), numbers.begin(), numbers.end());
        }
      });
    }
  }
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    std::vector<std::uint32_t> expected, found = content(buckets, bucket);
    for (std::size_t thread = 0; thread < kThreads; ++thread) {
      const auto& some = added[thread * kBuckets + bucket];
      expected.insert(expected.end(), some.begin(), some.end());
    }
    std::ranges::sort(expected);
    std::ranges::sort(found);
    EXPECT_EQ(found, expected) << bucket;
  }
  EXPECT_EQ(buckets.bytes(kBuckets - 1), 0U);
}

TEST(RowBuckets, NeedNoFileForLittle) {
  RowBuckets buckets(1, "/there/is/no/such/folder");
  const std::vector<std::byte> some(100, std::byte{7}), much(RowBuckets::kBlockBytes);
  buckets.add(0, some);
  std::vector<std::byte> found(100);
  buckets.read(0, found);
  EXPECT_EQ(found, some);
  try {
    buckets.add(0, much);
    FAIL();
  } catch (const files::FileError& error) {
    EXPECT_EQ(error.cause(), files::Cause::device);
    EXPECT_EQ(error.file(), "/there/is/no/such/folder");
  }
}

}  // namespace
}  // namespace delray::delaunay::internal
