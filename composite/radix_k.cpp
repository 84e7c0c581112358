#include "composite/internal/exchange.h"
#include "composite/internal/schemes.h"

namespace delray::composite::internal {
namespace {

// Few rounds, and messages large enough: the best of a range on machines with fast networks
// (Kendall, Peterka, Huang, Shen and Ross 2010).
constexpr int kRadix = 8;

// The largest divisor of `size` up to `radix`, or else its smallest factor.
int radix_for(int size, int radix) {
  for (int k = std::min(radix, size); k > 1; --k) {
    if (size % k == 0) return k;
  }
  for (int k = 2; k < size; ++k) {
    if (size % k == 0) return k;
  }
  return size;
}

}  // namespace

Part radix_k(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
             const ComposeOptions& options) {
  PixelRange range{0, layer->pixels()};
  const int rank = communicator.rank(), size = communicator.size();
  int round = 0;
  // Ranks that differ only in the digits of earlier rounds are neighbours; `stride` of them have
  // been merged and hold the range's pieces.
  for (int stride = 1; stride < size; ++round) {
    const std::vector<int>& wished = options.radices;
    const int radix =
        wished.empty()
            ? kRadix
            : wished[std::min<std::size_t>(static_cast<std::size_t>(round), wished.size() - 1)];
    const int k = radix_for(size / stride, radix);
    const Group group{rank / (stride * k) * (stride * k) + rank % stride, stride, k};
    communicator.mark(comm::Phase::compose, round);
    range = exchange(communicator, *layer, range, group, options.samples_per_pixel);
    stride *= k;
  }
  return part_of(range, std::move(layer));
}

}  // namespace delray::composite::internal
