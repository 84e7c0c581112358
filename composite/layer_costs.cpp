#include "composite/layer_costs.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "comm/collectives.h"
#include "comm/threads.h"
#include "image/image.h"

namespace delray::composite {
namespace {

constexpr int kRepeats = 7;
constexpr comm::Tag kTagPiece = 64;
// More tell no more about what cores take from each other.
constexpr int kMostRanks = 4;
constexpr std::uint64_t kPixelsAhead = std::uint64_t{1} << 18;  // cut before they are merged

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
double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double median(std::array<double, kRepeats> values) {
  std::nth_element(values.begin(), values.begin() + kRepeats / 2, values.end());
  return values[kRepeats / 2];
}

// `seconds` that a call took for so much of each of three things.
struct Line {
  std::array<double, 3> amounts;
  double seconds;
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
        up += amount * rest;
        down += amount * amount;
      }
      if (down > 0) prices[k] = std::max(0.0, up / down);
    }
  }
  return prices;
}

struct Exchanged {
  Line cut, merge;
};

image::Image8 copy(const image::Image8& image) {
  image::Image8 result(image.width, image.height);
  std::copy_n(image.colour.data(), image.pixels(), result.colour.data());
  std::copy_n(image.depth.data(), image.pixels(), result.depth.data());
  return result;
}

// Neighbours exchange halves of their images in pieces, several times, all at once and each time
// with images that nobody has looked at yet, so that memory, caches and what cores take from each
// other are as they are in schemes.
Exchanged exchange(comm::Communicator& communicator, const Codec& codec, const image::Image8& image,
                   std::uint64_t piece) {
  const std::uint64_t half = image.pixels() / 2;
  piece = std::min(piece, half);
  const std::uint64_t pieces = half / piece, ahead = std::min(kPixelsAhead / piece, pieces);
  const int me = communicator.rank(), partner = communicator.size() > 1 ? me ^ 1 : me;
  const auto range = [&](int rank, std::uint64_t i) {
    const std::uint64_t begin = (rank % 2 == 0 ? half : 0) + i * piece;
    return PixelRange{begin, begin + piece};
  };
  std::array<double, kRepeats> cut{}, merge{};
  double bytes = 0, composited = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    bytes = composited = 0;
    const auto layer = codec.make(copy(image));
    // The first wait may be long; the others are over at once, and all are awake.
    for (int i = 0; i < 3; ++i) comm::barrier(communicator);
    for (std::uint64_t first = 0; first < pieces; first += ahead) {
      const std::uint64_t last = std::min(first + ahead, pieces);
      std::vector<comm::Buffer> messages;
      auto begin = Clock::now();
      for (std::uint64_t i = first; i < last; ++i) messages.push_back(layer->cut(range(me, i)));
      cut[static_cast<std::size_t>(repeat)] += seconds_since(begin);
      for (comm::Buffer& message : messages) {
        bytes += static_cast<double>(message.size());
        communicator.send(partner, kTagPiece, std::move(message));
      }
      for (comm::Buffer& message : messages) message = communicator.receive(partner, kTagPiece);
      begin = Clock::now();
      for (std::uint64_t i = first; i < last; ++i) {
        composited += static_cast<double>(
            layer->merge(range(partner, i), std::exchange(messages[i - first], {}), Side::higher));
      }
      merge[static_cast<std::size_t>(repeat)] += seconds_since(begin);
    }
  }
  const auto calls = static_cast<double>(pieces), all = static_cast<double>(pieces * piece);
  return {{{calls, all, bytes}, median(cut)}, {{calls, all, composited}, median(merge)}};
}

}  // namespace

LayerCosts measure_layer_costs(const Codec& codec, std::uint64_t pixels) {
  std::vector<Line> cuts, merges;  // of rank 0
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const int ranks = std::clamp(cores / 2 * 2, 1, kMostRanks);
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    int side = 1;
    while (static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side) < pixels) ++side;
    for (const double share : {0.0, 0.3, 0.7, 1.0}) {
      const image::Image8 image = picture(side, share);
      for (const std::uint64_t piece : {std::uint64_t{1} << 16, std::uint64_t{1} << 12}) {
        const Exchanged times = exchange(communicator, codec, image, piece);
        if (communicator.rank() != 0) continue;
        cuts.push_back(times.cut);
        merges.push_back(times.merge);
      }
    }
  });
  const auto cut = fit(cuts), merge = fit(merges);
  return {cut[0], cut[1], cut[2], merge[0], merge[1], merge[2]};
}

}  // namespace delray::composite
