#include "composite/scheme.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <numeric>
#include <random>
#include <string>
#include <tuple>

#include "comm/recording.h"
#include "comm/simulated.h"
#include "comm/threads.h"
#include "composite/codec.h"
#include "composite/deep.h"
#include "composite/dense.h"
#include "composite/flatten.h"

namespace delray::composite {
namespace {

using image::Image8;
using image::ImageF;
using image::Rgba8;
using image::RgbaF;

struct Size {
  int width, height;
};
constexpr Size kSizes[] = {{0, 0}, {0, 5}, {1, 1}, {2, 1}, {7, 3}, {13, 1}, {67, 41}};

Rgba8 colour_of(int rank, std::uint32_t value, Rgba8 /*type*/) {
  return {static_cast<std::uint8_t>(rank), static_cast<std::uint8_t>(value), 7, 255};
}
RgbaF colour_of(int rank, std::uint32_t value, RgbaF /*type*/) {
  return {static_cast<float>(rank), static_cast<float>(value % 1000), 0.5F, 1};
}

// What `rank` rendered: depths of few values, so that ranks tie often; some pixels are covered by
// nobody, and colours tell who drew them.
template <class Colour>
image::BasicImage<Colour> partial_image(int rank, Size size) {
  image::BasicImage<Colour> image(size.width, size.height);
  clear(image);
  std::mt19937 random(1000U + static_cast<unsigned>(rank));
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const std::uint32_t value = random();
    if (i % 5 == 0 || value % 4 == 0) continue;
    image.colour[i] = colour_of(rank, value, Colour{});
    image.depth[i] = static_cast<float>(value / 4 % 3);
  }
  return image;
}

// The plain loop that every scheme must equal: ranks in order, strictly nearer replaces.
template <class Colour>
image::BasicImage<Colour> reference(int ranks, Size size) {
  auto result = partial_image<Colour>(0, size);
  for (int rank = 1; rank < ranks; ++rank) {
    const auto other = partial_image<Colour>(rank, size);
    for (std::size_t i = 0; i < result.pixels(); ++i) {
      if (other.depth[i] < result.depth[i]) {
        result.depth[i] = other.depth[i];
        result.colour[i] = other.colour[i];
      }
    }
  }
  return result;
}

template <class Colour>
bool same(const image::BasicImage<Colour>& a, const image::BasicImage<Colour>& b) {
  return a.width == b.width && a.height == b.height &&
         std::equal(a.colour.data(), a.colour.data() + a.pixels(), b.colour.data()) &&
         std::equal(a.depth.data(), a.depth.data() + a.pixels(), b.depth.data());
}

// A way to run ranks; every test runs over all of them.
struct Runner {
  const char* name;
  std::function<void(int, const std::function<void(comm::Communicator&)>&)> run;
};

std::vector<Runner> runners() {
  return {
      {"threads", [](int ranks, const auto& body) { comm::run_threads(ranks, 1, body); }},
      {"the simulated machine",
       [](int ranks, const auto& body) { comm::run_simulated(ranks, comm::any_order(), 3, body); }},
  };
}

std::vector<int> rank_counts() {
  std::vector<int> result(17);
  std::iota(result.begin(), result.end(), 1);
  return result;
}

// Fragments of few depths, so that many tie, some opaque; primitives are the rank's own.
std::vector<Fragment> fragments(int rank, std::size_t pixel) {
  std::minstd_rand random(static_cast<unsigned>(pixel * 31 + static_cast<unsigned>(rank)));
  std::vector<Fragment> result;
  if (pixel % 7 == 0) return result;
  for (unsigned k = random() % 4; k > 0; --k) {
    const float alpha = random() % 3 == 0 ? 1.0F : static_cast<float>(random() % 64) / 64;
    const float value = static_cast<float>(random() % 256) / 256 * alpha;
    result.push_back({{value, value / 2, alpha - value, alpha},
                      static_cast<float>(random() % 3),
                      static_cast<std::uint32_t>(100 * rank) + k,
                      static_cast<std::uint32_t>(random() % 2)});
  }
  return result;
}

DeepImage<RgbaF> deep_image(int rank, Size size) {
  DeepImage<RgbaF> image(size.width, size.height);
  for (std::size_t i = 0; i < image.lists.size(); ++i) {
    std::vector<Fragment> list = fragments(rank, i);
    image.set(i, list);
  }
  return image;
}

// The plain loop of blending: all fragments of all ranks, nearest first.
ImageF blended_reference(int ranks, Size size) {
  ImageF result(size.width, size.height);
  clear(result);
  for (std::size_t i = 0; i < result.pixels(); ++i) {
    std::vector<Fragment> all;
    for (int rank = 0; rank < ranks; ++rank) {
      for (const Fragment& fragment : fragments(rank, i)) all.push_back(fragment);
    }
    std::sort(all.begin(), all.end(), [](const Fragment& a, const Fragment& b) {
      return std::tuple(a.depth, a.primitive()) < std::tuple(b.depth, b.primitive());
    });
    float through = 1;
    for (const auto& [colour, depth, low, high] : all) {
      RgbaF& sum = result.colour[i];
      sum = {sum.r + through * colour.r, sum.g + through * colour.g, sum.b + through * colour.b,
             sum.a + through * colour.a};
      through *= 1.0F - colour.a;
    }
    if (!all.empty()) result.depth[i] = all.front().depth;
  }
  return result;
}

// What is composited; every scheme runs on all of them.
struct Kind {
  std::string name;
  std::function<std::unique_ptr<Layer>(int rank, Size size)> make;
  std::function<bool(OwnedPixels&& gathered, int ranks, Size size)> equals_reference;
};

template <class Colour>
Kind opaque(const Codec& codec, const std::string& colour) {
  return {codec.name + (" " + colour),
          [&codec](int rank, Size size) { return codec.make(partial_image<Colour>(rank, size)); },
          [](OwnedPixels&& gathered, int ranks, Size size) {
            return same(take_image<Colour>(std::move(gathered)), reference<Colour>(ranks, size));
          }};
}

std::vector<Kind> kinds() {
  std::vector<Kind> result;
  for (const Codec& codec : codecs()) {
    result.push_back(opaque<Rgba8>(codec, "of 8 bits"));
    result.push_back(opaque<RgbaF>(codec, "of floats"));
  }
  result.push_back({"deep", [](int rank, Size size) { return make_deep(deep_image(rank, size)); },
                    [](OwnedPixels&& gathered, int ranks, Size size) {
                      return same(flatten<RgbaF>(take_deep<RgbaF>(std::move(gathered))),
                                  blended_reference(ranks, size));
                    }});
  return result;
}

void expect_reference(comm::Communicator& communicator, const char* scheme, const Kind& kind,
                      Size size, int root, const ComposeOptions& options = {}) {
  SCOPED_TRACE(std::string(scheme) + ", " + kind.name + ", " + std::to_string(communicator.size()) +
               " ranks, " + std::to_string(size.width) + " x " + std::to_string(size.height));
  OwnedPixels part = compose(communicator, kind.make(communicator.rank(), size), scheme, options);
  part = gather(communicator, std::move(part), root);
  if (communicator.rank() != root) {
    EXPECT_TRUE(part.ranges.empty());
    return;
  }
  const std::uint64_t pixels = part.layer->pixels();
  ASSERT_EQ(part.ranges.size(), pixels > 0 ? 1U : 0U);
  if (pixels > 0) {
    EXPECT_EQ(part.ranges[0], (PixelRange{0, pixels}));
  }
  EXPECT_TRUE(kind.equals_reference(std::move(part), communicator.size(), size));
}

bool full() { return std::getenv("DELRAY_FULL_TESTS") != nullptr; }

TEST(Schemes, EqualTheSequentialReferenceAfterGathering) {
  const std::vector<Kind> all = kinds();
  const std::size_t step = full() ? 1 : 11;
  std::size_t offset = 0;
  for (const Runner& runner : runners()) {
    for (const int ranks : rank_counts()) {
      SCOPED_TRACE(std::string("over ") + runner.name);
      ++offset;
      runner.run(ranks, [&](comm::Communicator& communicator) {
        std::size_t turn = offset;
        for (const Scheme& scheme : schemes()) {
          for (const Kind& kind : all) {
            for (const Size size : kSizes) {
              if (++turn % step != 0) continue;
              expect_reference(communicator, scheme.name, kind, size, size.width % ranks,
                               {.interlace = turn / step % 3 == 0});
            }
          }
        }
      });
    }
  }
}

// Messages of several groups of pixels, merged by several threads.
TEST(Schemes, EqualTheReferenceOnLargerImages) {
  const std::vector<Kind> all = kinds();
  const Size size = full() ? Size{1919, 1079} : Size{239, 101};
  for (const int ranks : full() ? rank_counts() : std::vector{3}) {
    const bool some = ranks > 3 && ranks % 5 != 1;
    comm::run_threads(ranks, 2, [&](comm::Communicator& communicator) {
      int turn = ranks;
      for (const Scheme& scheme : schemes()) {
        for (const Kind& kind : all) {
          if (some && ++turn % 11 != 0) continue;
          expect_reference(communicator, scheme.name, kind, size, ranks / 2);
        }
      }
    });
  }
}

// Primes, most of which are far from a product of small factors.
TEST(Schemes, EqualTheReferenceWithManyRanks) {
  const Kind kind = opaque<Rgba8>(*find_codec("dense"), "of 8 bits");
  for (const int ranks : {23, 47, 127}) {
    comm::run_simulated(ranks, comm::any_order(), 3, [&](comm::Communicator& communicator) {
      for (const Scheme& scheme : schemes()) {
        expect_reference(communicator, scheme.name, kind, {67, 41}, 1);
      }
      for (const char* radices : {"radix-k:2", "radix-k:4,3", "radix-k:100"}) {
        expect_reference(communicator, radices, kind, {67, 41}, ranks - 1);
      }
    });
  }
}

TEST(Schemes, GatherColoursAlone) {
  const Size size{67, 41};
  for (const Codec& codec : codecs()) {
    SCOPED_TRACE(codec.name);
    comm::run_threads(5, 1, [&](comm::Communicator& communicator) {
      auto layer = codec.make(partial_image<Rgba8>(communicator.rank(), size));
      OwnedPixels part = compose(communicator, std::move(layer), "direct-send");
      forget_depth<Rgba8>(part);
      part = gather(communicator, std::move(part), 3);
      if (communicator.rank() != 3) return;
      const Image8 result = take_image<Rgba8>(std::move(part)),
                   expected = reference<Rgba8>(5, size);
      EXPECT_TRUE(std::equal(result.colour.data(), result.colour.data() + result.pixels(),
                             expected.colour.data()));
    });
  }
}

TEST(Schemes, TakeRadices) {
  const Kind kind = opaque<Rgba8>(*find_codec("dense"), "of 8 bits");
  for (const int ranks : {1, 2, 6, 7, 12, 16}) {
    comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
      for (const char* scheme : {"radix-k:1", "radix-k:4", "radix-k:2,3", "radix-k:100", "mesh:1",
                                 "mesh:3x4", "mesh:100x2"}) {
        expect_reference(communicator, scheme, kind, {67, 41}, 0);
      }
    });
  }
}

// Before gathering: every pixel is final on exactly one rank, ranges are whole pixels.
TEST(Schemes, LeaveEveryPixelOnExactlyOneRank) {
  constexpr int kSamples = 4;
  for (const Scheme& scheme : schemes()) {
    for (const int ranks : rank_counts()) {
      for (const Size size : {Size{4, 1}, Size{28, 3}, Size{68, 41}}) {
        SCOPED_TRACE(std::string(scheme.name) + ", " + std::to_string(ranks) + " ranks");
        const Image8 expected = reference<Rgba8>(ranks, size);
        std::vector<int> owners(expected.pixels());
        std::mutex mutex;
        comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
          auto layer = make_dense(partial_image<Rgba8>(communicator.rank(), size));
          OwnedPixels part = scheme.compose(communicator, std::move(layer), {kSamples});
          const auto ranges = part.ranges;
          const Image8 image = take_image<Rgba8>(std::move(part));
          const std::scoped_lock lock(mutex);
          for (const PixelRange& range : ranges) {
            EXPECT_GT(range.size(), 0U);
            EXPECT_EQ(range.begin % kSamples, 0U);
            EXPECT_EQ(range.end % kSamples, 0U);
            for (std::uint64_t i = range.begin; i < range.end; ++i) {
              ++owners[i];
              EXPECT_EQ(image.colour[i], expected.colour[i]);
              EXPECT_EQ(image.depth[i], expected.depth[i]);
            }
          }
        });
        for (const int count : owners) ASSERT_EQ(count, 1);
      }
    }
  }
}

TEST(Schemes, MayFollowEachOtherOnOneCommunicator) {
  const Size size{31, 9};
  comm::run_threads(6, 1, [&](comm::Communicator& communicator) {
    for (int frame = 0; frame < 5; ++frame) {
      for (const Scheme& scheme : schemes()) {
        auto layer = make_dense(partial_image<Rgba8>(communicator.rank(), size));
        OwnedPixels part = scheme.compose(communicator, std::move(layer), {});
        part = gather(communicator, std::move(part), 2);
        if (communicator.rank() != 2) continue;
        EXPECT_TRUE(same(take_image<Rgba8>(std::move(part)), reference<Rgba8>(6, size)));
      }
    }
  });
}

TEST(Schemes, AreFoundByName) {
  for (const Scheme& scheme : schemes()) EXPECT_EQ(find_scheme(scheme.name), &scheme);
  EXPECT_NE(find_scheme("binary-swap"), nullptr);
  EXPECT_NE(find_scheme("centralized"), nullptr);
  EXPECT_EQ(find_scheme("binary-swap:folded"), find_scheme("binary-swap"));
  EXPECT_EQ(choose_scheme("radix-k:4,2").scheme, find_scheme("radix-k"));
  EXPECT_EQ(choose_scheme("radix-k:4,2").radices, (std::vector{4, 2}));
  EXPECT_EQ(choose_scheme("mesh:3x5").radices, (std::vector{3, 5}));
  for (const char* wrong : {"", "nonsense", "tree:2", "radix-k:", "radix-k:0", "radix-k:4,",
                            "radix-k:4;2", "radix-k:-1", "binary-swap:235", ":"}) {
    EXPECT_EQ(find_scheme(wrong), nullptr) << wrong;
  }
}

// What each rank sent and composited.
std::vector<comm::Totals> counts_of(const char* scheme, int ranks, Size size) {
  std::vector<comm::Totals> result(static_cast<std::size_t>(ranks));
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    std::vector<comm::Event> events;
    comm::Recording recording(communicator, events);
    const int rank = communicator.rank();
    find_scheme(scheme)->compose(recording, make_dense(partial_image<Rgba8>(rank, size)), {});
    result[static_cast<std::size_t>(rank)] = comm::totals(events, rank, comm::Phase::compose);
  });
  return result;
}

std::uint64_t composited(const comm::Totals& totals) {
  return totals.work[static_cast<std::size_t>(comm::Work::pixels_composited)];
}

constexpr std::uint64_t kBytes = sizeof(Rgba8) + sizeof(float);

TEST(BinarySwap, MovesWhatTheClosedFormSaysForPowersOfTwo) {
  const Size size{64, 3};  // divisible by every rank count
  const std::uint64_t pixels = 192;
  for (int rounds = 0; rounds <= 6; ++rounds) {
    const int ranks = 1 << rounds;
    for (const comm::Totals& counts : counts_of("binary-swap", ranks, size)) {
      const std::uint64_t moved = pixels - pixels / static_cast<std::uint64_t>(ranks);
      EXPECT_EQ(counts.bytes_sent, kBytes * moved);
      EXPECT_EQ(counts.bytes_received, kBytes * moved);
      EXPECT_EQ(composited(counts), moved);
      EXPECT_EQ(counts.messages_sent, static_cast<std::uint64_t>(rounds));
      EXPECT_EQ(counts.rounds, static_cast<std::uint64_t>(rounds));
    }
  }
}

TEST(BinarySwap, MovesThePixelsOfAllButOneImageForAnyRankCount) {
  const Size size{61, 7};
  const std::uint64_t pixels = 427;
  for (int ranks = 1; ranks <= 17; ++ranks) {
    std::uint64_t bytes = 0, merged = 0, rounds = 0;
    for (const comm::Totals& counts : counts_of("binary-swap", ranks, size)) {
      bytes += counts.bytes_sent;
      merged += composited(counts);
      rounds = std::max(rounds, counts.rounds);
    }
    EXPECT_EQ(bytes, kBytes * pixels * static_cast<std::uint64_t>(ranks - 1));
    EXPECT_EQ(merged, pixels * static_cast<std::uint64_t>(ranks - 1));
    EXPECT_EQ(rounds, static_cast<std::uint64_t>(std::bit_width(static_cast<unsigned>(ranks - 1))));
  }
}

TEST(Centralized, SendsEveryImageToRankZero) {
  const auto counts = counts_of("centralized", 5, {7, 3});
  EXPECT_EQ(counts[0].bytes_sent, 0U);
  EXPECT_EQ(composited(counts[0]), 4U * 21);
  for (std::size_t rank = 1; rank < 5; ++rank) {
    EXPECT_EQ(counts[rank].bytes_sent, kBytes * 21);
    EXPECT_EQ(counts[rank].messages_sent, 1U);
    EXPECT_EQ(composited(counts[rank]), 0U);
  }
}

}  // namespace
}  // namespace delray::composite
