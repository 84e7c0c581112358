// The radices of radix-k for any number of ranks.
//
// Rounds of direct-send in groups of k need a number of ranks that is a product of small factors.
// With other numbers some ranks are extra, as in 2-3-4 binary swap (Nonaka, Ono and Fujita 2018)
// and the radix-k of Moreland (2018), but they need not join in the first round: an extra rank that
// joins when P neighbours hold a P-th of their image each sends P messages and lets each of them
// merge only A / P more. Which numbers are taken is decided by an estimate in which a message costs
// its sender and its receiver 1 each, its way 3, and a whole image 220: fitted such that the times
// predicted for small and large images on the networks of comm/network.h are what they should be.
#include "composite/schemes/radices.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <functional>

namespace delray::composite::internal {
namespace {

// Few rounds, and messages large enough: the best of a range on machines with fast networks
// (Kendall, Peterka, Huang, Shen and Ross 2010).
constexpr int kRadix = 8;
constexpr int kSmallestRadix = 4;  // to try, of the largest that are taken

constexpr double kLatency = 3, kImage = 220, kPipelined = 0.45;

// The largest divisor of `size` up to `wished`; 1 where there is none.
int divisor(int size, int wished) {
  for (int k = std::min(wished, size); k > 1; --k) {
    if (size % k == 0) return k;
  }
  return 1;
}

// Radices whose product is `members`, none where they would be too large.
std::vector<int> factors(int members, std::span<const int> wished) {
  std::vector<int> result;
  while (members > 1) {
    const int k = divisor(members, std::max(2, wished[std::min(result.size(), wished.size() - 1)]));
    if (k == 1) return {};
    result.push_back(k);
    members /= k;
  }
  return result;
}

// Until the last rank is done.
double estimate(const Radices& plan) {
  double messages = 0, images = 0;
  int holders = 1;  // of pieces of the same image
  const int extra = (plan.extra() + plan.blocks() - 1) / plan.blocks();
  for (int round = 0; round < static_cast<int>(plan.radices.size()); ++round) {
    const int k = plan.radices[static_cast<std::size_t>(round)];
    holders *= k;
    // The first message is on its way while the others are sent; what it brings is merged last.
    messages += k - 1 + std::max(k - 1.0, 1 + kLatency);
    images += (k - 1 + kPipelined) / holders;
    if (round + 1 == plan.joined_rounds && extra > 0) {
      // Extra ranks begin with the first round, and may be late.
      messages = std::max(messages, kLatency + holders) + extra;
      images += static_cast<double>(extra) / holders;
    }
  }
  return messages + kImage * images;
}

}  // namespace

int Radices::block() const {
  int result = 1;
  for (int i = 0; i < joined_rounds; ++i) result *= radices[static_cast<std::size_t>(i)];
  return result;
}

int Radices::first_of(int block_number) const {
  return block_number * block() +
         static_cast<int>(static_cast<std::int64_t>(block_number) * extra() / blocks());
}

RadixPlace place_of(const Radices& radices, int rank) {
  const int blocks = radices.blocks(), block = radices.block();
  RadixPlace place;
  place.block = static_cast<int>(static_cast<std::int64_t>(rank) * blocks / radices.ranks);
  while (rank < radices.first_of(place.block)) --place.block;
  while (rank >= radices.first_of(place.block + 1)) ++place.block;
  place.first_rank = radices.first_of(place.block);
  place.extra = radices.first_of(place.block + 1) - place.first_rank - block;
  const int i = rank - place.first_rank;
  place.member = i < block ? place.block * block + i : -1;
  return place;
}

int rank_of(const Radices& radices, int member) {
  const int block = radices.block();
  return radices.first_of(member / block) + member % block;
}

Radices choose_radices(int ranks, std::span<const int> wished) {
  assert(ranks >= 1);
  Radices best{{}, 0, 1, ranks};
  if (ranks == 1) return best;
  double shortest = 0;
  // In all orders, joined after any of the rounds.
  const auto consider = [&](std::vector<int> radices, bool is_free) {
    if (radices.empty()) return;
    int members = 1;
    for (const int k : radices) members *= k;
    if (is_free) std::ranges::sort(radices);
    do {
      for (int joined = 1; joined <= static_cast<int>(radices.size()); ++joined) {
        Radices plan{radices, joined, members, ranks};
        const double time = estimate(plan);
        if (!best.radices.empty() && time >= shortest) continue;
        shortest = time;
        best = std::move(plan);
      }
    } while (is_free && std::ranges::next_permutation(radices).found);
  };
  const auto consider_members = [&](int members) {
    if (!wished.empty()) return consider(factors(members, wished), false);
    for (int most = kRadix; most >= kSmallestRadix; --most) {
      consider(factors(members, {&most, 1}), true);
    }
  };
  constexpr int kMostExtra = 256;  // while there are others to choose from
  for (int extra = 0; extra <= ranks / 8; ++extra) {
    if (extra > kMostExtra && !best.radices.empty()) break;
    consider_members(ranks - extra);
  }
  consider_members(static_cast<int>(std::bit_floor(static_cast<unsigned>(ranks))));
  return best;
}

}  // namespace delray::composite::internal
