// Composites the layers of all ranks by a scheme, after the ranks have agreed that they can.
//
// One dissemination (Hensgen, Finkel and Manber 1988) combines a bit of every rank whose layer is
// not empty, and a hash of whatever has to be alike with its complement: a bit that is set in both
// means that ranks differ, and all throw. Schemes then run among the ranks that have something. The
// agreement takes ceil(log2 n) rounds of n / 8 + 16 bytes.
//
// Degenerate: where all layers are empty, all ranks take part; a single rank exchanges nothing.
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <utility>

#include "comm/agree_on_failure.h"
#include "composite/layers/interlaced.h"
#include "composite/scheme.h"
#include "composite/schemes/range.h"
#include "composite/schemes/sub_communicator.h"

namespace delray::composite {
namespace {

// Why a rank cannot take part; nothing where it can.
std::string objection(const comm::Communicator& communicator, const Layer* layer,
                      std::string_view scheme, const SchemeChoice& choice,
                      const ComposeOptions& options) {
  if (layer == nullptr) return "there is no layer to composite";
  if (choice.scheme == nullptr)
    return "there is no compositing scheme '" + std::string(scheme) + "'";
  if (options.samples_per_pixel < 1) return "a pixel has at least one sample";
  if (std::ranges::any_of(options.radices, [](int radix) { return radix < 1; }))
    return "a radix of a compositing scheme is at least 1";
  if (options.order.empty()) return {};
  std::vector<int> ranks = options.order;
  std::ranges::sort(ranks);
  std::vector<int> all(static_cast<std::size_t>(communicator.size()));
  std::iota(all.begin(), all.end(), 0);
  return ranks == all ? "" : "the order of compositing does not have each rank once";
}

// A value that is the same on ranks that can composite with each other. Every bit of it is set in
// one of the two halves, and in all of both on a rank that objects.
std::array<std::uint64_t, 2> agreement(const Layer* layer, std::string_view scheme,
                                       const ComposeOptions& options, bool objects) {
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  if (objects) return {kAll, kAll};
  std::string text = typeid(*layer).name();
  const auto add = [&](auto value) { text += ' ' + std::to_string(value); };
  add(layer->format());
  add(layer->pixels());
  add(options.samples_per_pixel);
  add(static_cast<int>(options.interlace));
  for (const std::vector<int>& list : {options.radices, options.order}) {
    add(list.size());
    for (const int value : list) add(value);
  }
  text += scheme;
  const std::uint64_t hash = XXH3_64bits(text.data(), text.size());
  return {hash, ~hash};
}

// A bit of every rank, combined by or. Dissemination (Hensgen, Finkel and Manber 1988): a bit may
// count twice, so ceil(log2 n) rounds do for every number of ranks.
void combine_bits(comm::Communicator& communicator, std::vector<std::uint64_t>& bits) {
  const int size = communicator.size(), rank = communicator.rank();
  for (int step = 1; step < size; step *= 2) {
    communicator.send((rank + step) % size, internal::kTagTakingPart,
                      comm::Buffer::of(std::span<const std::uint64_t>(bits)));
    const comm::Buffer message =
        communicator.receive((rank - step + size) % size, internal::kTagTakingPart);
    const std::span<const std::uint64_t> theirs = message.as<std::uint64_t>();
    std::ranges::transform(bits, theirs, bits.begin(), std::bit_or<>());
  }
}

// Ranks whose layer is not empty, all where all are; in the order that is asked for, or ascending.
// Throws on all ranks where they differ in `own`, `objection` where there is one.
std::vector<int> taking_part(comm::Communicator& communicator, bool empty, std::vector<int> order,
                             const std::array<std::uint64_t, 2>& own,
                             const std::string& objection) {
  const auto size = static_cast<std::size_t>(communicator.size());
  const auto rank = static_cast<std::size_t>(communicator.rank());
  std::vector<std::uint64_t> bits((size + 63) / 64);
  if (!empty) bits[rank / 64] |= std::uint64_t{1} << rank % 64;
  bits.insert(bits.end(), own.begin(), own.end());
  combine_bits(communicator, bits);
  if ((bits[bits.size() - 2] & bits.back()) != 0) {
    throw comm::Agreed<std::invalid_argument>(
        !objection.empty() ? objection
                           : "ranks differ in the size or kind of their layers, in the "
                             "compositing scheme or its options, or one of them has none");
  }
  if (order.empty()) {
    order.resize(size);
    std::iota(order.begin(), order.end(), 0);
  }
  std::vector<int> result;
  std::copy_if(order.begin(), order.end(), std::back_inserter(result),
               [&](int k) { return (bits[static_cast<std::size_t>(k) / 64] >> k % 64 & 1) != 0; });
  return result.empty() ? order : result;
}

}  // namespace

OwnedPixels compose(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                    std::string_view scheme, ComposeOptions options) {
  SchemeChoice choice = choose_scheme(scheme);
  const std::string why = objection(communicator, layer.get(), scheme, choice, options);
  const auto own = agreement(layer.get(), scheme, options, !why.empty());
  if (!choice.radices.empty()) options.radices = std::move(choice.radices);
  communicator.mark(comm::Phase::compose, 0);
  internal::SubCommunicator members(
      communicator,
      taking_part(communicator, layer == nullptr || layer->empty(), options.order, own, why));
  if (members.rank() < 0) return {{}, std::move(layer)};
  if (!options.interlace) return choice.scheme->compose(members, std::move(layer), options);
  layer = interlace(std::move(layer), members.size(), options.samples_per_pixel);
  return deinterlace(choice.scheme->compose(members, std::move(layer), options));
}

}  // namespace delray::composite
