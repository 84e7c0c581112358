#include "composite/joined.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "comm/bad_message.h"
#include "comm/threads.h"
#include "composite/codec.h"
#include "composite/scheme.h"

namespace delray::composite {
namespace {

using image::Image8;
using image::Rgba8;

// Sizes of parts; one has no pixels.
constexpr int kSizes[] = {700, 1, 0, 5000, 90000, 33};
constexpr int kParts = static_cast<int>(std::size(kSizes));

std::unique_ptr<Layer> make_empty(std::size_t part) {
  Image8 image(kSizes[part], 1);
  clear(image);
  return find_codec("active")->make(std::move(image));
}

// What a rank has of a part: nothing of some.
bool is_missing(int rank, int part) { return (rank * 5 + part * 3) % 4 == 0; }

Image8 picture(int rank, int part) {
  Image8 image(kSizes[part], 1);
  clear(image);
  std::mt19937 random(static_cast<unsigned>(rank * 100 + part));
  for (std::size_t i = 0; i < image.pixels() && !is_missing(rank, part); ++i) {
    if (random() % 3 == 0) continue;
    image.colour[i] = {static_cast<std::uint8_t>(rank + 1), static_cast<std::uint8_t>(i), 5, 255};
    image.depth[i] = static_cast<float>(random() % 4);
  }
  return image;
}

std::unique_ptr<JoinedLayer> joined(int rank) {
  std::vector<JoinedLayer::Part> parts;
  for (int part = 0; part < kParts; ++part) {
    JoinedLayer::Part& made = parts.emplace_back();
    made.pixels = static_cast<std::uint64_t>(kSizes[part]);
    if (!is_missing(rank, part)) made.layer = find_codec("active")->make(picture(rank, part));
  }
  return std::make_unique<JoinedLayer>(std::move(parts), 0, &make_empty);
}

// The plain loop over the ranks of a part.
Image8 reference(int ranks, int part) {
  Image8 result = picture(0, part);
  for (int rank = 1; rank < ranks; ++rank) {
    const Image8 other = picture(rank, part);
    for (std::size_t i = 0; i < result.pixels(); ++i) {
      if (other.depth[i] < result.depth[i]) {
        result.depth[i] = other.depth[i];
        result.colour[i] = other.colour[i];
      }
    }
  }
  return result;
}

void expect_part(const Image8& image, int ranks, int part, const char* what) {
  const Image8 expected = reference(ranks, part);
  EXPECT_TRUE(
      std::equal(image.colour.data(), image.colour.data() + image.pixels(), expected.colour.data()))
      << what << ", " << ranks << " ranks, part " << part;
  EXPECT_TRUE(
      std::equal(image.depth.data(), image.depth.data() + image.pixels(), expected.depth.data()))
      << what << ", " << ranks << " ranks, part " << part;
}

}  // namespace

TEST(Joined, EverySchemeBringsEachPartToItsOwnRank) {
  for (const int ranks : {1, 2, 3, 4, 7}) {
    for (const Scheme& scheme : schemes()) {
      for (const bool interlace : {false, true}) {
        comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
          OwnedPixels owned = compose(communicator, joined(communicator.rank()), scheme.name,
                                      {.interlace = interlace});
          std::vector<Destination> destinations;
          const auto receiver = [&](int part) { return (part * 2 + 1) % ranks; };
          for (int part = 0; part < kParts; ++part) {
            const PixelRange range =
                dynamic_cast<JoinedLayer&>(*owned.layer).range_of(static_cast<std::size_t>(part));
            destinations.push_back({range, receiver(part)});
          }
          owned = gather(communicator, std::move(owned), destinations);
          std::uint64_t pixels = 0, expected = 0;
          for (const PixelRange& range : owned.ranges) pixels += range.size();
          for (int part = 0; part < kParts; ++part) {
            if (receiver(part) != communicator.rank()) continue;
            expected += static_cast<std::uint64_t>(kSizes[part]);
            auto& layer =
                dynamic_cast<JoinedLayer&>(*owned.layer).existing(static_cast<std::size_t>(part));
            expect_part(dynamic_cast<ImageLayer<Rgba8>&>(layer).image(), ranks, part, scheme.name);
          }
          EXPECT_EQ(pixels, expected) << scheme.name;
        });
      }
    }
  }
}

TEST(Joined, IsEmptyWhereAllPartsAre) {
  std::vector<JoinedLayer::Part> parts(2);
  parts[0].pixels = 700;
  parts[1].pixels = 1;
  JoinedLayer layer(std::move(parts), 0, &make_empty);
  EXPECT_TRUE(layer.empty());
  EXPECT_EQ(layer.pixels(), 701);
  EXPECT_EQ(layer.layer(0), nullptr);
  layer.existing(0);
  EXPECT_NE(layer.layer(0), nullptr);
  EXPECT_TRUE(layer.empty());
  EXPECT_FALSE(joined(1)->empty());
}

// A part that is missing elsewhere leaves nothing of what was here.
TEST(Joined, ReplacesByNothing) {
  const auto target = joined(1);
  std::vector<JoinedLayer::Part> parts;
  for (const int size : kSizes) parts.push_back({static_cast<std::uint64_t>(size), nullptr});
  JoinedLayer nothing(std::move(parts), 0, &make_empty);
  const PixelRange all{0, target->pixels()};
  target->replace(all, nothing.encode(all));
  EXPECT_TRUE(target->empty());
  const PixelRange first{0, 100};
  const auto other = joined(1);
  other->replace(first, nothing.encode(first));
  EXPECT_FALSE(other->empty());
}

TEST(Joined, RefusesMessagesThatGoOn) {
  const auto target = joined(1), other = joined(2);
  const PixelRange all{0, target->pixels()};
  const comm::Buffer whole = other->encode(all);
  comm::Buffer more(whole.size() + 8);
  std::fill_n(more.data(), more.size(), std::byte{});
  std::copy_n(whole.data(), whole.size(), more.data());
  EXPECT_THROW(target->merge(all, more, Side::higher), comm::BadMessage);
}

TEST(Joined, RefusesMessagesThatAreCut) {
  const auto target = joined(1), other = joined(2);
  const PixelRange all{0, target->pixels()};
  const comm::Buffer whole = other->encode(all);
  for (const std::size_t size : {std::size_t{1}, whole.size() / 2, whole.size() - 8}) {
    const comm::Buffer cut = comm::Buffer::of(std::span<const std::byte>(whole.data(), size));
    EXPECT_THROW(target->merge(all, cut, Side::higher), comm::BadMessage) << size;
  }
}

TEST(Joined, GatherRefusesARankThatDoesNotExist) {
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    OwnedPixels owned = compose(communicator, joined(0), "tree");
    const Destination nowhere{{0, 1}, 1};
    EXPECT_THROW(gather(communicator, std::move(owned), std::span(&nowhere, 1)),
                 std::invalid_argument);
  });
}

}  // namespace delray::composite
