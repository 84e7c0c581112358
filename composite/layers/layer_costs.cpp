// Measures what cutting and merging cost, by compositing discs of several sizes and fitting prices
// to the times.
//
// Threads composite with schemes that cut and merge in turns and with schemes that do one of both,
// all variants taking turns. Each kind of call has three prices: a call, a pixel of its range, and
// a byte or a covered pixel. They are fitted to the medians by relative least squares with prices
// >= 0, by coordinate descent.
//
// Degenerate: amounts that do not occur get the price 0.
#include "composite/layer_costs.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "comm/collectives.h"
#include "comm/threads.h"
#include "composite/deep.h"
#include "composite/image_layer.h"
#include "composite/scheme.h"

namespace delray::composite {
namespace {

constexpr int kRepeats = 9;
// More tell no more about what cores take from each other.
constexpr int kMostRanks = 4;

// A disc in the middle of a square that covers this share of it; everything from 1 on.
image::Image8 picture(int side, double share) {
  image::Image8 image(side, side);
  clear(image);
  const double radius2 = share * side * side / 3.14159265358979;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double dx = x - side / 2.0, dy = y - side / 2.0;
      if (share < 1 && dx * dx + dy * dy >= radius2) continue;
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(side) +
                     static_cast<std::size_t>(x);
      image.colour[i] = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 2, 255};
      image.depth[i] = static_cast<float>((x * 7 + y * 13) % 64);
    }
  }
  return image;
}

using Clock = std::chrono::steady_clock;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Calls that took `seconds` for so much of each of three things.
struct Line {
  std::array<double, 3> amounts{};
  double seconds = 0;
  double weight = 1;
};

// The prices >= 0 of three things that tell the seconds of all lines best: relative least squares,
// by coordinate descent.
std::array<double, 3> fit(std::span<const Line> lines) {
  constexpr int kSweeps = 2000;
  std::array<double, 3> prices{};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t k = 0; k < prices.size(); ++k) {
      double up = 0, down = 0;
      for (const Line& line : lines) {
        double rest = 1;
        for (std::size_t j = 0; j < prices.size(); ++j) {
          if (j != k) rest -= prices[j] * line.amounts[j] / line.seconds;
        }
        const double amount = line.amounts[k] / line.seconds;
        up += line.weight * amount * rest;
        down += line.weight * amount * amount;
      }
      if (down > 0) prices[k] = std::max(0.0, up / down);
    }
  }
  return prices;
}

// Time of a rank's calls: of encoding and of merging.
struct Spent {
  Line encode, merge;
  Spent& operator+=(const Spent& other) {
    for (Line Spent::*line : {&Spent::encode, &Spent::merge}) {
      (this->*line).seconds += (other.*line).seconds;
      for (std::size_t k = 0; k < 3; ++k) (this->*line).amounts[k] += (other.*line).amounts[k];
    }
    return *this;
  }
};

// A layer that takes the time of its calls.
class TimedLayer final : public Layer {
 public:
  TimedLayer(std::unique_ptr<Layer> layer, Spent& spent)
      : layer_(std::move(layer)), spent_(spent) {}

  std::unique_ptr<Layer> release() { return std::move(layer_); }
  std::uint64_t pixels() const override { return layer_->pixels(); }
  bool empty() const override { return layer_->empty(); }
  comm::Buffer encode(PixelRange range) override {
    const auto begin = Clock::now();
    comm::Buffer message = layer_->encode(range);
    add(spent_.encode, begin, range, message.size());
    return message;
  }
  std::uint64_t merge(PixelRange range, const comm::Buffer& pixels, Side from) override {
    const auto begin = Clock::now();
    const std::uint64_t composited = layer_->merge(range, pixels, from);
    add(spent_.merge, begin, range, composited);
    return composited;
  }
  void replace(PixelRange range, const comm::Buffer& pixels) override {
    layer_->replace(range, pixels);
  }

 private:
  static void add(Line& line, Clock::time_point begin, PixelRange range, std::uint64_t amount) {
    line.seconds += std::chrono::duration<double>(Clock::now() - begin).count();
    line.amounts[0] += 1;
    line.amounts[1] += static_cast<double>(range.size());
    line.amounts[2] += static_cast<double>(amount);
  }

  std::unique_ptr<Layer> layer_;
  Spent& spent_;
};

// The layers of one rank, in memory that is used again.
class Layers {
 public:
  virtual ~Layers() = default;
  virtual std::unique_ptr<Layer> make(const image::Image8& picture) = 0;
  virtual void take_back(OwnedPixels&& part) = 0;
};

class FlatLayers final : public Layers {
 public:
  explicit FlatLayers(const Codec& codec) : codec_(codec) {}

  std::unique_ptr<Layer> make(const image::Image8& picture) override {
    image::Image8& spare = spares_[picture.pixels()];
    if (spare.pixels() == 0) spare = image::Image8(picture.width, picture.height);
    std::copy_n(picture.colour.data(), picture.pixels(), spare.colour.data());
    std::copy_n(picture.depth.data(), picture.pixels(), spare.depth.data());
    return codec_.make(std::exchange(spare, {}));
  }
  void take_back(OwnedPixels&& part) override {
    image::Image8 image = take_image<image::Rgba8>(std::move(part));
    image::Image8& spare = spares_[image.pixels()];
    spare = std::move(image);
  }

 private:
  const Codec& codec_;
  std::map<std::size_t, image::Image8> spares_;  // by size
};

// One to three surfaces wherever the picture is covered, the same for some pixels beside each
// other, as triangles have them: for how long one lies in front, no processor can guess.
class DeepLayers final : public Layers {
 public:
  explicit DeepLayers(int rank) : rank_(rank), random_(static_cast<std::uint32_t>(rank)) {}

  std::unique_ptr<Layer> make(const image::Image8& picture) override {
    DeepImage<image::RgbaF> image(picture.width, picture.height);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
      random_ = random_ * 1664525 + 1013904223;  // (Knuth and Lewis)
      if ((random_ >> 20) % kPixelsOfRun == 0) bits = random_ >> 8;
      const float depth = picture.depth[i];
      if (depth == image::kEmptyDepth) continue;
      const std::uint32_t size = 1 + bits % 3;
      std::array<Fragment, 3> list;
      for (std::uint32_t k = 0; k < size; ++k) {
        const bool is_opaque = k + 1 == size && (bits >> 10 & 1) != 0;
        list[k] = {{0.2F, 0.3F, 0.4F, is_opaque ? 1.0F : 0.5F},
                   depth + static_cast<float>((bits >> (4 * k) & 15) + 20 * k),
                   static_cast<std::uint32_t>(rank_),
                   k};
      }
      image.set(i, std::span(list).first(size));
    }
    return make_deep(std::move(image));
  }
  void take_back(OwnedPixels&&) override {}

 private:
  // On a row, until any of the surfaces begins or ends; in the mean.
  static constexpr std::uint32_t kPixelsOfRun = 8;

  int rank_;
  std::uint32_t random_;
};

// Composites layers of `picture`, which all ranks have; the result is of all ranks together, on
// rank 0.
Spent compose_timed(comm::Communicator& communicator, Layers& layers, const char* scheme,
                    const image::Image8& picture) {
  Spent spent;
  auto layer = std::make_unique<TimedLayer>(layers.make(picture), spent);
  // The first wait may be long; the others are over at once, and all are awake.
  for (int i = 0; i < 3; ++i) comm::barrier(communicator);
  OwnedPixels part = compose(communicator, std::move(layer), scheme);
  comm::barrier(communicator);  // who goes on would slow down those who are not done
  part.layer = dynamic_cast<TimedLayer&>(*part.layer).release();
  layers.take_back(std::move(part));
  Spent all;
  for (const comm::Buffer& one : comm::gather(communicator, 0, comm::Buffer::of_value(spent))) {
    all += one.as<Spent>()[0];
  }
  return all;
}

// A scheme on a picture, several times.
struct Variant {
  const char* scheme;
  image::Image8 image;
  double weight;
  std::vector<Spent> spent;
};

std::vector<Variant> variants_of(std::uint64_t pixels) {
  int side = 1;
  while (static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side) < pixels) ++side;
  std::vector<Variant> variants;
  for (const double share : {0.0, 0.3, 0.7, 1.0}) {
    // Ranks that cut and merge in turns, and ranks that do one of both: what cores take from each
    // other is not the same.
    for (const char* scheme : {"binary-swap", "tree", "tiles"}) {
      variants.push_back({scheme, picture(side, share), 1, {}});
    }
    // Small pictures show the fixed time of a call. The pixels stay in caches, so that they are to
    // count only where large images leave a choice.
    variants.push_back({"tiles", picture(std::max(1, side / 4), share), 0.01, {}});
  }
  return variants;
}

Line median_of(const Variant& variant, Line Spent::*line) {
  std::vector<double> seconds;
  for (const Spent& spent : variant.spent) seconds.push_back((spent.*line).seconds);
  Line result = variant.spent.front().*line;
  result.seconds = median(std::move(seconds));
  result.weight = variant.weight;
  return result;
}

using MakeLayers = std::function<std::unique_ptr<Layers>(int rank)>;

LayerCosts measure(std::uint64_t pixels, const MakeLayers& make) {
  std::vector<Variant> variants = variants_of(pixels);
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const int ranks = std::clamp(cores / 2 * 2, 2, kMostRanks);
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    const std::unique_ptr<Layers> layers = make(communicator.rank());
    // All take turns; the first one is to warm up.
    for (int repeat = 0; repeat <= kRepeats; ++repeat) {
      for (Variant& variant : variants) {
        const Spent spent = compose_timed(communicator, *layers, variant.scheme, variant.image);
        if (communicator.rank() == 0 && repeat > 0) variant.spent.push_back(spent);
      }
    }
  });
  std::vector<Line> cuts, merges;
  for (const Variant& variant : variants) {
    cuts.push_back(median_of(variant, &Spent::encode));
    merges.push_back(median_of(variant, &Spent::merge));
  }
  const auto cut = fit(cuts), merge = fit(merges);
  return {cut[0], cut[1], cut[2], merge[0], merge[1], merge[2]};
}

}  // namespace

LayerCosts measure_layer_costs(const Codec& codec, std::uint64_t pixels) {
  return measure(pixels, [&](int) { return std::make_unique<FlatLayers>(codec); });
}

LayerCosts measure_deep_layer_costs(std::uint64_t pixels) {
  return measure(pixels, [](int rank) { return std::make_unique<DeepLayers>(rank); });
}

}  // namespace delray::composite
