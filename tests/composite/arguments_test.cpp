// Layers that do not go together, and options that cannot be, are std::invalid_argument on all
// ranks.
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <stdexcept>

#include "comm/network.h"
#include "comm/simulated.h"
#include "comm/threads.h"
#include "composite/compose_images.h"
#include "composite/dense.h"
#include "composite/layers/active.h"
#include "composite/scheme.h"
#include "composite/simulate.h"

namespace delray::composite {
namespace {

using image::Image8;
using image::ImageF;

constexpr int kRanks = 3;

std::unique_ptr<Layer> layer(int width, Operator how = Operator::nearest) {
  Image8 image(width, 10);
  clear(image);
  return make_dense(std::move(image), how);
}

// How many of three ranks throw; one that does not is waited for by none.
int refusals(const std::function<void(comm::Communicator&)>& body) {
  std::atomic<int> count{0};
  comm::run_threads(kRanks, 1, [&](comm::Communicator& communicator) {
    try {
      body(communicator);
    } catch (const std::invalid_argument&) {
      ++count;
    }
  });
  return count;
}

TEST(Arguments, LayersOfAllRanksHaveOneSizeAndKind) {
  const auto compose_on_last = [](auto&& other) {
    return refusals([&](comm::Communicator& communicator) {
      const bool is_last = communicator.rank() == kRanks - 1;
      compose(communicator, is_last ? other() : layer(10), "tree");
    });
  };
  EXPECT_EQ(compose_on_last([] { return layer(10); }), 0);
  EXPECT_EQ(compose_on_last([] { return layer(11); }), kRanks);
  EXPECT_EQ(compose_on_last([] { return layer(0); }), kRanks);
  EXPECT_EQ(compose_on_last([] { return layer(10, Operator::over); }), kRanks);
  EXPECT_EQ(compose_on_last([] { return std::unique_ptr<Layer>(); }), kRanks);
  EXPECT_EQ(compose_on_last([] { return make_active(Image8(10, 10), Operator::nearest); }), kRanks);
  EXPECT_EQ(compose_on_last([] { return make_dense(ImageF(10, 10), Operator::nearest); }), kRanks);
}

TEST(Arguments, SchemesAndOptionsAreTheSameAndCanBe) {
  const auto compose_with = [](const char* scheme, const ComposeOptions& options, int ranks) {
    return refusals([&](comm::Communicator& communicator) {
      const bool differs = communicator.rank() >= kRanks - ranks;
      compose(communicator, layer(10), differs ? scheme : "tree",
              differs ? options : ComposeOptions());
    });
  };
  for (const int ranks : {1, kRanks}) {
    EXPECT_EQ(compose_with("nonsense", {}, ranks), kRanks);
    EXPECT_EQ(compose_with("", {}, ranks), kRanks);
    EXPECT_EQ(compose_with("radix-k:0", {}, ranks), kRanks);
    EXPECT_EQ(compose_with("tree", {.samples_per_pixel = 0}, ranks), kRanks);
    EXPECT_EQ(compose_with("tree", {.radices = {-2}}, ranks), kRanks);
    EXPECT_EQ(compose_with("tree", {.order = {0, 0, 1}}, ranks), kRanks);
    EXPECT_EQ(compose_with("tree", {.order = {0}}, ranks), kRanks);
  }
  EXPECT_EQ(compose_with("pipeline", {}, 1), kRanks);
  EXPECT_EQ(compose_with("tree", {.interlace = true}, 1), kRanks);
  EXPECT_EQ(compose_with("tree", {.order = {2, 1, 0}}, 1), kRanks);
  EXPECT_EQ(compose_with("tree", {.order = {2, 1, 0}}, kRanks), 0);
}

TEST(Arguments, ImagesFromElsewhere) {
  const auto images = [](const ImageOptions& options, int width) {
    return refusals([&](comm::Communicator& communicator) {
      compose_images(communicator, Image8(communicator.rank() == 0 ? width : 10, 10), options);
    });
  };
  EXPECT_EQ(images({}, 10), 0);
  EXPECT_EQ(images({}, 12), kRanks);
  EXPECT_EQ(images({.scheme = "nonsense"}, 10), kRanks);
  EXPECT_EQ(images({.codec = "nonsense"}, 10), kRanks);
  EXPECT_EQ(images({.root = kRanks}, 10), kRanks);
  EXPECT_EQ(images({.root = -1}, 10), kRanks);
  EXPECT_EQ(refusals([&](comm::Communicator& communicator) {
              const ImageBuffers<image::Rgba8> nothing{.width = 10, .height = 10};
              compose_images(communicator, nothing, 1.0F, {});
            }),
            kRanks);
}

TEST(Arguments, OfSimulations) { EXPECT_THROW(simulate("tree", {}, {}), std::invalid_argument); }

}  // namespace
}  // namespace delray::composite
