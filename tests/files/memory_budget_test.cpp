// Memory is refused before it is taken; sizes as text.
#include "files/memory_budget.h"

#include <gtest/gtest.h>

#include <vector>

#include "files/error.h"

namespace delray::files {
namespace {

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

TEST(MemoryBudget, IsHalfOfTheMachineByDefault) {
  EXPECT_GT(machine_memory(), 64 * kMebibyte);
  EXPECT_EQ(MemoryBudget().limit(), machine_memory() / 2);
}

TEST(MemoryBudget, CountsWhatIsResident) {
  const std::uint64_t before = resident_set();
  const std::vector<char> block(64 * kMebibyte, 1);
  EXPECT_GE(resident_set(), before + 60 * kMebibyte);
  EXPECT_EQ(MemoryBudget(before).left(), 0U);
  EXPECT_GT(MemoryBudget(before + 512 * kMebibyte).left(), 256 * kMebibyte);
}

TEST(MemoryBudget, RefusesBeforeAnythingIsAllocated) {
  const MemoryBudget budget(resident_set() + 100 * kMebibyte);
  EXPECT_NO_THROW(budget.require(20 * kMebibyte, "a.obj"));
  try {
    budget.require(900 * kMebibyte, "a.obj", "line 3");
    FAIL() << "granted";
  } catch (const FileError& error) {
    EXPECT_EQ(error.cause(), Cause::memory);
    EXPECT_EQ(error.file(), "a.obj");
    EXPECT_EQ(error.place(), "line 3");
    EXPECT_NE(std::string(error.what()).find("takes 900 MiB of memory"), std::string::npos)
        << error.what();
  }
  EXPECT_NO_THROW(MemoryBudget::unlimited().require(~std::uint64_t{0} / 2, "a"));
}

TEST(MemoryBudget, AddsUpWhatIsSmall) {
  const MemoryBudget nothing(0);
  EXPECT_THROW(for (int i = 0; i < 100; ++i) nothing.require(kMebibyte / 50, "a"), FileError);
}

#ifndef DELRAY_ASAN
// What was freed counts as free although the allocator has not given it back.
TEST(MemoryBudget, TakesBackWhatTheAllocatorKeeps) {
  constexpr std::size_t kBlock = 100000, kBlocks = 400;
  std::vector<std::vector<char>> blocks;
  for (std::size_t i = 0; i < kBlocks; ++i) blocks.emplace_back(kBlock, 'x');
  const std::vector<char> above(kBlock, 'x');  // keeps the heap from shrinking by itself
  const MemoryBudget budget(resident_set() + (std::uint64_t{2} << 20));
  EXPECT_THROW(budget.require(kBlock * kBlocks, "points"), FileError);
  blocks.clear();
  EXPECT_NO_THROW(budget.require(kBlock * kBlocks, "points"));
  EXPECT_EQ(above[0], 'x');
}
#endif

TEST(MemoryBudget, TellsBytes) {
  EXPECT_EQ(bytes_text(0), "0 bytes");
  EXPECT_EQ(bytes_text(1023), "1023 bytes");
  EXPECT_EQ(bytes_text(1536), "1.50 KiB");
  EXPECT_EQ(bytes_text(20 * kMebibyte), "20.0 MiB");
  EXPECT_EQ(bytes_text(1024 * kMebibyte), "1.00 GiB");
  EXPECT_EQ(bytes_text(~std::uint64_t{0}), "16.0 EiB");
}

TEST(MemoryBudget, ParsesBytes) {
  EXPECT_EQ(parse_bytes("1"), 1U);
  EXPECT_EQ(parse_bytes("1e6"), 1'000'000U);
  EXPECT_EQ(parse_bytes("500MB"), 500'000'000U);
  EXPECT_EQ(parse_bytes("500M"), 500U << 20);
  EXPECT_EQ(parse_bytes("1.5GiB"), 3U << 29);
  EXPECT_EQ(parse_bytes("2gib"), std::uint64_t{2} << 30);
  EXPECT_EQ(parse_bytes("1TB"), 1'000'000'000'000U);
  for (const char* text : {"", "0", "-1", "12x", "GB", "nan", "inf", "1e40", "1 GB", "2GiBs"}) {
    EXPECT_EQ(parse_bytes(text), 0U) << text;
  }
}

}  // namespace
}  // namespace delray::files
