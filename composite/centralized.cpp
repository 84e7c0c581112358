#include "composite/internal/range.h"
#include "composite/internal/schemes.h"

namespace delray::composite::internal {

Part centralized(comm::Communicator& communicator, std::unique_ptr<Layer> layer,
                 const ComposeOptions& /*options*/) {
  const PixelRange all{0, layer->pixels()};
  if (all.size() == 0) return {{}, std::move(layer)};
  communicator.mark(comm::Phase::compose, 0);
  if (communicator.rank() != 0) {
    communicator.send(0, kTagCompose, layer->cut(all));
    return {{}, std::move(layer)};
  }
  for (int from = 1; from < communicator.size(); ++from) {
    const comm::Buffer pixels = communicator.receive(from, kTagCompose);
    communicator.work(comm::Work::pixels_composited, layer->merge(all, pixels, Side::higher));
  }
  return {{all}, std::move(layer)};
}

}  // namespace delray::composite::internal
