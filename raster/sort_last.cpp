// Sort-last: every rank draws an equal, ascending part of the primitives over the whole frame, and
// a compositing scheme merges the images. On equal depths the lower rank wins, which has the lower
// primitive numbers.
#include "composite/dense.h"
#include "composite/scheme.h"
#include "raster/internal/rank.h"

namespace delray::raster {
namespace {

template <class Colour>
Picture render(Rank& rank) {
  const auto [begin, end] = rank.own_primitives();
  const DrawList list =
      make_draw_list(pieces_of(rank.scene, rank.first_primitives, begin, end), &rank.clusters);
  image::BasicImage<Colour> image = take_image<Colour>(rank.screen, rank.scratch);
  const geometry::Rect frame = rank.screen.frame();
  rank.render(list, {&frame, 1}, image);
  if (rank.ranks() == 1) return image;

  comm::Communicator& communicator = rank.communicator;
  composite::Part part = timed(communicator, rank.counts.phases.compose, [&] {
    return composite::find_scheme(rank.options.scheme)
        ->compose(communicator, composite::make_dense(std::move(image)), {});
  });
  part = timed(communicator, rank.counts.phases.gather,
               [&] { return composite::gather(communicator, std::move(part), 0); });
  if (rank.number() != 0) return image::BasicImage<Colour>();
  return composite::take_image<Colour>(std::move(part));
}

}  // namespace

Picture sort_last(Rank& rank) {
  return rank.options.float_pixels ? render<image::RgbaF>(rank) : render<image::Rgba8>(rank);
}

}  // namespace delray::raster
