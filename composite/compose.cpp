#include <cassert>
#include <functional>
#include <numeric>
#include <utility>

#include "comm/collectives.h"
#include "composite/interlaced.h"
#include "composite/internal/members.h"
#include "composite/scheme.h"

namespace delray::composite {
namespace {

// Ranks whose layer is not empty, ascending; all where all are.
std::vector<int> taking_part(comm::Communicator& communicator, const Layer& layer) {
  const auto size = static_cast<std::size_t>(communicator.size());
  const auto rank = static_cast<std::size_t>(communicator.rank());
  std::vector<std::uint64_t> bits((size + 63) / 64);
  if (!layer.empty()) bits[rank / 64] |= std::uint64_t{1} << rank % 64;
  comm::all_reduce(communicator, std::span(bits), std::bit_or<>());
  std::vector<int> result;
  for (std::size_t i = 0; i < size; ++i) {
    if (bits[i / 64] >> i % 64 & 1) result.push_back(static_cast<int>(i));
  }
  if (!result.empty()) return result;
  result.resize(size);
  std::iota(result.begin(), result.end(), 0);
  return result;
}

}  // namespace

Part compose(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
             std::string_view scheme, ComposeOptions options) {
  SchemeChoice choice = choose_scheme(scheme);
  assert(choice.scheme != nullptr);
  if (!choice.radices.empty()) options.radices = std::move(choice.radices);
  communicator.mark(comm::Phase::compose, 0);
  internal::Members members(communicator, taking_part(communicator, *layer));
  if (members.rank() < 0) return {{}, std::move(layer)};
  if (!options.interlace) return choice.scheme->compose(members, std::move(layer), options);
  layer = interlace(std::move(layer), members.size(), options.samples_per_pixel);
  return deinterlace(choice.scheme->compose(members, std::move(layer), options));
}

}  // namespace delray::composite
