#include "apps/composed_shares.h"

#include <algorithm>

#include "apps/background.h"
#include "comm/collectives.h"
#include "comm/recording.h"
#include "composite/scheme.h"
#include "image/hash.h"

namespace delray::apps {

void ShareShapes::add(const raster::Share& share) {
  if (const auto* image = std::get_if<image::Image8>(&share)) {
    masks_.push_back(maker_.add(image->depth.span()));
  } else {
    deep_.emplace_back(std::get<composite::DeepImage<image::RgbaF>>(share));
  }
}

composite::HollowImages ShareShapes::hollow(const std::string& codec, int width) const {
  return {masks_, *composite::hollow_of(codec), composite::kPixelBytes8,
          static_cast<std::uint64_t>(width), deep_};
}

ShareDrawer::ShareDrawer(const CompareRequest& request, const Prepared& prepared,
                         parallel::Progress* progress)
    : prepared_(prepared), progress_(progress), renderer_(prepared.scene, prepared.shader) {
  options_.width = request.render.width;
  options_.height = request.render.height;
}

raster::Share ShareDrawer::draw(int rank, int ranks) {
  return renderer_.draw_share(rank, ranks, prepared_.camera, options_, progress_);
}

ShareShapes ShareDrawer::shapes(int ranks) {
  ShareShapes result;
  for (int rank = 0; rank < ranks; ++rank) {
    raster::Share share = draw(rank, ranks);
    result.add(share);
    if (auto* image = std::get_if<image::Image8>(&share)) renderer_.recycle(std::move(*image));
  }
  return result;
}

MeasuredScheme measure_scheme(comm::Communicator& communicator, ShareLayers& layers,
                              const std::string& scheme, const std::string& codec, int repeats,
                              const CompareRequest& request, const Prepared& prepared) {
  MeasuredScheme result;
  std::vector<double> compose_seconds, gather_seconds;
  for (int repeat = 0; repeat <= repeats; ++repeat) {
    comm::Tally tally(communicator.world_rank(communicator.rank()));
    comm::Recording recording(communicator, tally);
    comm::Communicator& used = repeat == 0 ? recording : communicator;
    auto layer = layers.make(codec);
    // The first wait may be long, and who has slept comes out late; the last is over at once.
    for (int i = 0; i < 3; ++i) comm::barrier(communicator);
    const double begin = communicator.seconds();
    composite::Part part =
        composite::compose(used, std::move(layer), scheme, {.interlace = request.interlace});
    const double composed = communicator.seconds();
    comm::barrier(communicator);
    const double waited = communicator.seconds();
    part = composite::gather(used, std::move(part), 0);
    std::array times = {composed - begin, communicator.seconds() - waited};
    comm::reduce(communicator, 0, std::span<double>(times),
                 [](double a, double b) { return std::max(a, b); });
    comm::barrier(communicator);  // what follows would slow down those who are not done
    if (repeat > 0) {
      compose_seconds.push_back(times[0]);
      gather_seconds.push_back(times[1]);
    } else {
      result.compose = composite::count(communicator, tally, comm::Phase::compose);
      result.gather = composite::count(communicator, tally, comm::Phase::gather);
    }
    image::Image8 image = layers.image_of(std::move(part));
    if (repeat == 0 && communicator.rank() == 0) {
      put_behind(image, prepared.background, prepared.shading(),
                 scenes::make_view(prepared.camera, request.render.width, request.render.height));
      result.hash = image::hash(image);
    }
    layers.recycle(std::move(image));
  }
  result.compose_seconds = spread_of(std::move(compose_seconds));
  result.gather_seconds = spread_of(std::move(gather_seconds));
  return result;
}

}  // namespace delray::apps
