// Collects the pieces that ranks own where they are wanted: each tells its ranges and sends their
// pixels, destination after destination. Receivers replace their pixels by them, rank after rank.
// One round. Degenerate: ranks that own nothing of a destination send an empty list.
#include <stdexcept>
#include <string>

#include "composite/scheme.h"
#include "composite/schemes/exchange.h"

namespace delray::composite {
namespace {

// Messages that were read: ranks of a machine that wait for what they have lent go on when all are
// given back. Those that went on before others would take the core from who still gathers.
class Kept {
 public:
  void keep(comm::Buffer&& message) {
    constexpr std::size_t kMost = std::size_t{1} << 24;  // bytes; what is more goes back at once
    if (bytes_ + message.size() > kMost) return;
    bytes_ += message.size();
    messages_.push_back(std::move(message));
  }

 private:
  std::vector<comm::Buffer> messages_;
  std::size_t bytes_ = 0;
};

}  // namespace

OwnedPixels gather(comm::Communicator& communicator, OwnedPixels&& part, int root) {
  const std::uint64_t pixels = part.layer == nullptr ? 0 : part.layer->pixels();
  const Destination all{{0, pixels}, root};
  return gather(communicator, std::move(part), std::span(&all, 1));
}

OwnedPixels gather(comm::Communicator& communicator, OwnedPixels&& part,
                   std::span<const Destination> destinations) {
  using namespace internal;
  for (const Destination& to : destinations) {
    if (to.rank < 0 || to.rank >= communicator.size())
      throw std::invalid_argument("rank " + std::to_string(to.rank) + " does not exist");
  }
  if (part.layer == nullptr) throw std::invalid_argument("there is no layer to gather");
  communicator.mark(comm::Phase::gather, 0);
  for (const Destination& to : destinations) {
    if (to.rank == communicator.rank()) continue;
    std::vector<PixelRange> ranges;
    for (const PixelRange& range : part.ranges) {
      if (const PixelRange wanted = overlap(range, to.range); wanted.size() > 0)
        ranges.push_back(wanted);
    }
    communicator.send(to.rank, kTagGatherRanges,
                      comm::Buffer::of(std::span<const PixelRange>(ranges)));
    for (const PixelRange& range : ranges) {
      for_each_message(range, 1, [&](PixelRange piece) {
        communicator.send(to.rank, kTagGatherPixels, part.layer->encode(piece));
      });
    }
  }
  std::vector<PixelRange> own;
  Kept kept;
  for (const Destination& to : destinations) {
    if (to.rank != communicator.rank()) continue;
    for (int from = 0; from < communicator.size(); ++from) {
      if (from == to.rank) continue;
      const comm::Buffer ranges = communicator.receive(from, kTagGatherRanges);
      for (const PixelRange& range : ranges.as<PixelRange>()) {
        for_each_message(range, 1, [&](PixelRange piece) {
          comm::Buffer pixels = communicator.receive(from, kTagGatherPixels);
          part.layer->replace(piece, pixels);
          kept.keep(std::move(pixels));
        });
      }
    }
    if (to.range.size() > 0) own.push_back(to.range);
  }
  part.ranges = std::move(own);
  return std::move(part);
}

}  // namespace delray::composite
