// Collects the pieces that ranks own on one rank: each tells its ranges and sends their pixels,
// rank after rank. The root replaces its pixels by them. One round. Degenerate: ranks that own
// nothing send an empty list.
#include <stdexcept>
#include <string>

#include "composite/scheme.h"
#include "composite/schemes/exchange.h"

namespace delray::composite {

OwnedPixels gather(comm::Communicator& communicator, OwnedPixels&& part, int root) {
  using namespace internal;
  if (root < 0 || root >= communicator.size())
    throw std::invalid_argument("rank " + std::to_string(root) + " does not exist");
  if (part.layer == nullptr) throw std::invalid_argument("there is no layer to gather");
  communicator.mark(comm::Phase::gather, 0);
  if (communicator.rank() != root) {
    communicator.send(root, kTagGatherRanges,
                      comm::Buffer::of(std::span<const PixelRange>(part.ranges)));
    for (const PixelRange& range : part.ranges) {
      for_each_message(range, 1, [&](PixelRange piece) {
        communicator.send(root, kTagGatherPixels, part.layer->encode(piece));
      });
    }
    return {{}, std::move(part.layer)};
  }
  for (int from = 0; from < communicator.size(); ++from) {
    if (from == root) continue;
    const comm::Buffer ranges = communicator.receive(from, kTagGatherRanges);
    for (const PixelRange& range : ranges.as<PixelRange>()) {
      for_each_message(range, 1, [&](PixelRange piece) {
        part.layer->replace(piece, communicator.receive(from, kTagGatherPixels));
      });
    }
  }
  const PixelRange all{0, part.layer->pixels()};
  part.ranges.clear();
  if (all.size() > 0) part.ranges.push_back(all);
  return std::move(part);
}

}  // namespace delray::composite
