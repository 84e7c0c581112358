#include "image/hash.h"

#include <gtest/gtest.h>

namespace delray::image {
namespace {

TEST(Hash, OfNoPixelsIsThatOfNoBytes) {
  EXPECT_EQ(hash(Image8()), "99aa06d3014798d86001c324468d497f");
}

TEST(Hash, SeesColourAndOrderButNotDepth) {
  Image8 image(3, 2);
  clear(image);
  const std::string blank = hash(image);
  EXPECT_EQ(blank.size(), 32U);
  image.depth[1] = 2;
  EXPECT_EQ(hash(image), blank);
  image.colour[1] = {1, 2, 3, 4};
  const std::string first = hash(image);
  EXPECT_NE(first, blank);
  std::swap(image.colour[1], image.colour[4]);
  EXPECT_NE(hash(image), first);
}

// Published hashes must stay comparable from version to version.
TEST(Hash, OfKnownBytes) {
  Image8 image(1, 1);
  image.colour[0] = {'a', 'b', 'c', 'd'};
  EXPECT_EQ(hash(image), "8d6b60383dfa90c21be79eecd1b1353d");
}

}  // namespace
}  // namespace delray::image
