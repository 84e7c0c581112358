// What was packed comes out again; damage is noticed or harmless.
#include "delaunay/files/parts/lzf.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/delaunay/files/parts/lzf_encoder.h"

namespace delray::delaunay {
namespace {

std::string unpacked(std::string_view packed, std::size_t size) {
  std::string bytes(size, '?');
  return unpack_lzf(packed, bytes) ? bytes : "failed";
}

TEST(Lzf, UnpacksLiteralsAndCopies) {
  EXPECT_EQ(unpacked("", 0), "");
  EXPECT_EQ(unpacked(std::string("\x02", 1) + "abc", 3), "abc");
  // Three bytes from one before: a copy within itself.
  EXPECT_EQ(unpacked(std::string("\x00z\x20\x00", 4), 4), "zzzz");
  // Seven and 255 and two bytes.
  EXPECT_EQ(unpacked(std::string("\x00z\xe0\xff\x00", 5), 265), std::string(265, 'z'));
}

TEST(Lzf, UnpacksWhatWasPacked) {
  constexpr unsigned kSeed = 20043;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (int round = 0; round < 300; ++round) {
    std::string bytes;
    const unsigned letters = 1 + random() % 30;
    for (unsigned i = random() % 20000; i > 0; --i) bytes += static_cast<char>(random() % letters);
    const std::string packed = tests::pack_lzf(bytes);
    ASSERT_EQ(unpacked(packed, bytes.size()), bytes);
    EXPECT_LE(bytes.size(), most_lzf_bytes(packed.size()));
    EXPECT_EQ(unpacked(packed, bytes.size() + 1), "failed");
    std::string damaged = packed;
    if (damaged.empty()) continue;
    EXPECT_EQ(unpacked(packed, bytes.size() - 1), "failed");
    damaged[random() % damaged.size()] = static_cast<char>(random());
    unpacked(damaged, bytes.size());
    unpacked(packed.substr(0, random() % packed.size()), bytes.size());
  }
}

}  // namespace
}  // namespace delray::delaunay
