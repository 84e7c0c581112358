// Arrays keep, shrink, discard and align their values.
#include "delaunay/mesh/array.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <utility>

namespace delray::delaunay {
namespace {

// From the heap, mapped, and mapped with huge pages.
constexpr std::size_t kSizes[] = {0, 1, 1000, std::size_t{1} << 18, std::size_t{3} << 20};

TEST(Array, KeepsWhatIsWritten) {
  for (const std::size_t size : kSizes) {
    Array<std::uint64_t> array(size);
    ASSERT_EQ(array.size(), size);
    std::iota(array.data(), array.data() + size, std::uint64_t{7});
    Array<std::uint64_t> moved = std::move(array);
    ASSERT_EQ(moved.size(), size);
    for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(moved[i], 7 + i);
  }
}

TEST(Array, ValuesAreAlignedAsTheyAskFor) {
  struct alignas(64) Wide {
    std::uint64_t values[8];
  };
  for (std::size_t size = 1; size < 40; ++size) {
    const Array<Wide> array(size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(array.data()) % alignof(Wide), 0U) << size;
  }
}

TEST(Array, ShrinkKeepsTheFirstValues) {
  for (const std::size_t size : kSizes) {
    for (const std::size_t kept : {std::size_t{0}, size / 3, size}) {
      Array<std::uint64_t> array(size);
      std::iota(array.data(), array.data() + size, std::uint64_t{0});
      array.shrink(kept);
      ASSERT_EQ(array.size(), kept);
      for (std::size_t i = 0; i < kept; ++i) ASSERT_EQ(array[i], i);
      array = {};
      EXPECT_EQ(array.size(), 0U);
    }
  }
}

// Values around the discarded ones stay, and all can be written again.
TEST(Array, DiscardsAPart) {
  for (const std::size_t size : {std::size_t{100}, std::size_t{3} << 20}) {
    Array<std::uint32_t> array(size);
    for (std::size_t i = 0; i < size; ++i) array[i] = static_cast<std::uint32_t>(i);
    const std::size_t first = size / 3, last = size - size / 5;
    array.discard(first, last);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size; ++i)
      kept += array[i] == i && (i < first || i >= last) ? 1 : 0;
    EXPECT_EQ(kept, size - (last - first));
    for (std::size_t i = first; i < last; ++i) array[i] = static_cast<std::uint32_t>(i);
    EXPECT_EQ(array[first], first);
    EXPECT_EQ(array[last - 1], last - 1);
  }
}

}  // namespace
}  // namespace delray::delaunay
