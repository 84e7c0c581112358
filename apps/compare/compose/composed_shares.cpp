// Draws the share of each rank as sort-last would, keeps its shape without pixels, and times one
// run of a scheme between barriers. The first run of a scheme is recorded for its counts and not
// timed.
#include "apps/compare/compose/composed_shares.h"

#include <algorithm>

#include "apps/render/background.h"
#include "comm/collectives.h"
#include "comm/recording.h"
#include "composite/scheme.h"
#include "image/hash.h"

namespace delray::apps {

void ShareShapes::add(const raster::PartialImage& share) {
  if (const auto* image = std::get_if<image::Image8>(&share)) {
    masks_.push_back(maker_.add(image->depth.span()));
  } else {
    deep_.emplace_back(std::get<composite::DeepImage<image::RgbaF>>(share));
  }
}

composite::MetadataOnlyImages ShareShapes::metadata_only(const std::string& codec,
                                                         int width) const {
  return {masks_, *composite::metadata_only_of(codec), composite::kPixelBytes8,
          static_cast<std::uint64_t>(width), deep_};
}

ShareDrawer::ShareDrawer(const CompareRequest& request, const Prepared& prepared,
                         parallel::Progress* progress)
    : prepared_(prepared), progress_(progress), renderer_(prepared.scene, prepared.shader) {
  options_.width = request.render.width;
  options_.height = request.render.height;
}

raster::PartialImage ShareDrawer::draw(int rank, int ranks) {
  return renderer_.draw_share(rank, ranks, prepared_.camera, options_, progress_);
}

ShareShapes ShareDrawer::shapes(int ranks) {
  ShareShapes result;
  for (int rank = 0; rank < ranks; ++rank) {
    raster::PartialImage share = draw(rank, ranks);
    result.add(share);
    if (auto* image = std::get_if<image::Image8>(&share)) renderer_.recycle(std::move(*image));
  }
  return result;
}

void measure(comm::Communicator& communicator, ShareLayers& layers, const CompareRequest& request,
             const Prepared& prepared, bool is_first, MeasuredScheme& measured) {
  comm::Tally tally(communicator.world_rank(communicator.rank()));
  comm::Recording recording(communicator, tally);
  comm::Communicator& used = is_first ? recording : communicator;
  auto layer = layers.make(measured.codec);
  // The first wait may be long, and who has slept comes out late; the last is over at once.
  for (int i = 0; i < 3; ++i) comm::barrier(communicator);
  const double begin = communicator.seconds();
  composite::OwnedPixels part =
      composite::compose(used, std::move(layer), measured.scheme, {.interlace = request.interlace});
  const double composed = communicator.seconds();
  comm::barrier(communicator);
  const double waited = communicator.seconds();
  part = composite::gather(used, std::move(part), 0);
  std::array times = {composed - begin, communicator.seconds() - waited};
  comm::reduce(communicator, 0, std::span<double>(times),
               [](double a, double b) { return std::max(a, b); });
  comm::barrier(communicator);  // what follows would slow down those who are not done
  if (is_first) {
    measured.compose = composite::count(communicator, tally, comm::Phase::compose);
    measured.gather = composite::count(communicator, tally, comm::Phase::gather);
  } else {
    measured.compose_seconds.push_back(times[0]);
    measured.gather_seconds.push_back(times[1]);
  }
  image::Image8 image = layers.image_of(std::move(part));
  if (is_first && communicator.rank() == 0) {
    put_behind(image, prepared.background, prepared.shading(),
               scenes::make_view(prepared.camera, request.render.width, request.render.height));
    measured.hash = image::hash(image);
  }
  layers.recycle(std::move(image));
}

}  // namespace delray::apps
