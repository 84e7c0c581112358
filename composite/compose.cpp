#include <algorithm>
#include <cassert>
#include <functional>
#include <iterator>
#include <numeric>
#include <utility>

#include "comm/collectives.h"
#include "composite/interlaced.h"
#include "composite/internal/members.h"
#include "composite/scheme.h"

namespace delray::composite {
namespace {

// Ranks whose layer is not empty, all where all are; in the order that is asked for, or ascending.
std::vector<int> taking_part(comm::Communicator& communicator, const Layer& layer,
                             std::vector<int> order) {
  const auto size = static_cast<std::size_t>(communicator.size());
  const auto rank = static_cast<std::size_t>(communicator.rank());
  std::vector<std::uint64_t> bits((size + 63) / 64);
  if (!layer.empty()) bits[rank / 64] |= std::uint64_t{1} << rank % 64;
  comm::all_reduce(communicator, std::span(bits), std::bit_or<>());
  if (order.empty()) {
    order.resize(size);
    std::iota(order.begin(), order.end(), 0);
  }
  assert(order.size() == size);
  std::vector<int> result;
  std::copy_if(order.begin(), order.end(), std::back_inserter(result),
               [&](int k) { return (bits[static_cast<std::size_t>(k) / 64] >> k % 64 & 1) != 0; });
  return result.empty() ? order : result;
}

}  // namespace

Part compose(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
             std::string_view scheme, ComposeOptions options) {
  SchemeChoice choice = choose_scheme(scheme);
  assert(choice.scheme != nullptr);
  if (!choice.radices.empty()) options.radices = std::move(choice.radices);
  communicator.mark(comm::Phase::compose, 0);
  internal::Members members(communicator, taking_part(communicator, *layer, options.order));
  if (members.rank() < 0) return {{}, std::move(layer)};
  if (!options.interlace) return choice.scheme->compose(members, std::move(layer), options);
  layer = interlace(std::move(layer), members.size(), options.samples_per_pixel);
  return deinterlace(choice.scheme->compose(members, std::move(layer), options));
}

}  // namespace delray::composite
