#include "apps/composed_shares.h"

#include <algorithm>

#include "apps/background.h"
#include "comm/collectives.h"
#include "comm/recording.h"
#include "composite/codec.h"
#include "composite/deep.h"
#include "composite/flatten.h"
#include "composite/scheme.h"
#include "image/hash.h"

namespace delray::apps {
namespace {

using Surfaces = composite::DeepImage<image::RgbaF>;

double upper_median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The layers of repeated runs, in the same memory: fresh memory takes long to write to.
class Layers {
 public:
  Layers(const raster::Share& share, const std::string& codec) : share_(share), codec_(codec) {}

  std::unique_ptr<composite::Layer> make() {
    if (const auto* surfaces = std::get_if<Surfaces>(&share_)) {
      return composite::make_deep(copy_of(*surfaces));
    }
    const auto& image = std::get<image::Image8>(share_);
    if (spare_.pixels() != image.pixels()) spare_ = image::Image8(image.width, image.height);
    std::copy_n(image.colour.data(), image.pixels(), spare_.colour.data());
    std::copy_n(image.depth.data(), image.pixels(), spare_.depth.data());
    return composite::find_codec(codec_)->make(std::move(spare_));
  }
  // The image of a part, only the part's ranges of which are final.
  image::Image8 image_of(composite::Part&& part) const {
    if (is_transparent(share_)) {
      return composite::flatten<image::Rgba8>(composite::take_deep<image::RgbaF>(std::move(part)));
    }
    return composite::take_image<image::Rgba8>(std::move(part));
  }
  void recycle(image::Image8&& image) { spare_ = std::move(image); }

 private:
  static Surfaces copy_of(const Surfaces& surfaces) {
    Surfaces copy(surfaces.width, surfaces.height);
    std::copy_n(surfaces.lists.data(), surfaces.lists.size(), copy.lists.data());
    copy.chunks = surfaces.chunks;
    return copy;
  }

  const raster::Share& share_;
  std::string codec_;
  image::Image8 spare_;
};

}  // namespace

ShareDrawer::ShareDrawer(const CompareRequest& request, const Prepared& prepared,
                         parallel::Progress* progress)
    : prepared_(prepared), progress_(progress), renderer_(prepared.scene, prepared.shader) {
  options_.width = request.render.width;
  options_.height = request.render.height;
}

raster::Share ShareDrawer::draw(int rank, int ranks) {
  return renderer_.draw_share(rank, ranks, prepared_.camera, options_, progress_);
}

std::vector<composite::ImageMasks> ShareDrawer::masks(int ranks) {
  std::vector<composite::ImageMasks> result;
  composite::MaskMaker maker;
  for (int rank = 0; rank < ranks; ++rank) {
    raster::Share share = draw(rank, ranks);
    if (is_transparent(share)) return {};
    result.push_back(maker.add(std::get<image::Image8>(share).depth.span()));
    renderer_.recycle(std::get<image::Image8>(std::move(share)));
  }
  return result;
}

bool is_transparent(const raster::Share& share) {
  return !std::holds_alternative<image::Image8>(share);
}

MeasuredScheme measure_scheme(comm::Communicator& communicator, const raster::Share& share,
                              const std::string& scheme, const std::string& codec, int repeats,
                              const CompareRequest& request, const Prepared& prepared) {
  MeasuredScheme result;
  Layers layers(share, codec);
  std::vector<double> compose_seconds, gather_seconds;
  for (int repeat = 0; repeat <= repeats; ++repeat) {
    comm::Tally tally(communicator.world_rank(communicator.rank()));
    comm::Recording recording(communicator, tally);
    comm::Communicator& used = repeat == 0 ? recording : communicator;
    auto layer = layers.make();
    comm::barrier(communicator);
    const double begin = communicator.seconds();
    composite::Part part = composite::compose(used, std::move(layer), scheme);
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
  result.compose_seconds = upper_median(std::move(compose_seconds));
  result.gather_seconds = upper_median(std::move(gather_seconds));
  return result;
}

}  // namespace delray::apps
