#include "composite/layer_costs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "composite/dense.h"

namespace delray::composite {
namespace {

constexpr std::uint64_t kPixels = 1 << 14;

std::atomic<std::uint64_t> cut_pixels, merged_pixels;
bool cuts_take_long, merges_take_long;  // not written while ranks run

// As a dense layer, and some calls take a hundred times as long.
class SlowLayer final : public ImageLayer<image::Rgba8> {
 public:
  using ImageLayer<image::Rgba8>::ImageLayer;

  comm::Buffer encode(PixelRange range) override {
    cut_pixels += range.size();
    comm::Buffer message(range.size() * bytes_per_pixel());
    for (int i = 0; i < (cuts_take_long ? 100 : 1); ++i) {
      std::copy_n(image().colour.data() + range.begin, range.size(),
                  reinterpret_cast<image::Rgba8*>(message.data()));
      std::copy_n(image().depth.data() + range.begin, range.size(),
                  reinterpret_cast<float*>(message.data() + range.size() * sizeof(image::Rgba8)));
      std::atomic_signal_fence(std::memory_order_seq_cst);  // as if somebody looked at them
    }
    return message;
  }

 private:
  std::uint64_t apply(PixelRange range, const comm::Buffer& pixels, Action action) override {
    merged_pixels += range.size();
    const auto* const colour = reinterpret_cast<const image::Rgba8*>(pixels.data());
    const auto* const depth = reinterpret_cast<const float*>(colour + range.size());
    for (int i = 0; i < (merges_take_long ? 100 : 1); ++i) {
      apply_to_all(action, range.begin, range.size(), {colour, depth, range.size()});
    }
    return range.size();
  }
};

LayerCosts measure(bool slow_cuts, bool slow_merges) {
  cuts_take_long = slow_cuts;
  merges_take_long = slow_merges;
  const Codec slow{"slow", "",
                   [](image::Image8&& image, Operator how) -> std::unique_ptr<Layer> {
                     return std::make_unique<SlowLayer>(std::move(image), how);
                   },
                   nullptr};
  return measure_layer_costs(slow, kPixels);
}

// Of an image of kPixels in one dense message.
double cut_seconds(const LayerCosts& costs) {
  return costs.encode + kPixels * (costs.encode_pixel + 8 * costs.encode_byte);
}
double merge_seconds(const LayerCosts& costs) {
  return costs.merge + kPixels * (costs.merge_pixel + costs.merge_covered);
}

TEST(LayerCosts, AreOfEveryCodecAndNeverNegative) {
  for (const Codec& codec : codecs()) {
    const LayerCosts costs = measure_layer_costs(codec, kPixels);
    for (const double cost : {costs.encode, costs.encode_pixel, costs.encode_byte, costs.merge,
                              costs.merge_pixel, costs.merge_covered}) {
      EXPECT_GE(cost, 0) << codec.name;
      EXPECT_TRUE(std::isfinite(cost)) << codec.name;
    }
    EXPECT_GT(cut_seconds(costs), 0) << codec.name;
    EXPECT_GT(merge_seconds(costs), 0) << codec.name;
  }
}

TEST(LayerCosts, AreOfDeepLayersToo) {
  const LayerCosts costs = measure_deep_layer_costs(kPixels);
  for (const double cost : {costs.encode, costs.encode_pixel, costs.encode_byte, costs.merge,
                            costs.merge_pixel, costs.merge_covered}) {
    EXPECT_GE(cost, 0);
    EXPECT_TRUE(std::isfinite(cost));
  }
  EXPECT_GT(cut_seconds(costs), 0);
  EXPECT_GT(merge_seconds(costs), 0);
}

// Nothing here is about how fast a machine is: what takes a hundred times as long is to cost more,
// and what does not is not to be charged for it.
TEST(LayerCosts, TellCuttingFromMerging) {
  const LayerCosts slow_cuts = measure(true, false), slow_merges = measure(false, true);
  EXPECT_GT(cut_seconds(slow_cuts), cut_seconds(slow_merges));
  EXPECT_GT(merge_seconds(slow_merges), merge_seconds(slow_cuts));
  EXPECT_GT(cut_seconds(slow_cuts), merge_seconds(slow_cuts));
  EXPECT_GT(merge_seconds(slow_merges), cut_seconds(slow_merges));
}

// Every call that is timed is one that a scheme makes: what all ranks cut they also merge.
TEST(LayerCosts, ComeFromWholeCompositions) {
  cut_pixels = merged_pixels = 0;
  measure(false, false);
  EXPECT_GT(cut_pixels, 0U);
  EXPECT_EQ(cut_pixels, merged_pixels);
}

}  // namespace
}  // namespace delray::composite
