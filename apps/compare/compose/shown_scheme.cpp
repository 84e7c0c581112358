// Records several runs of one scheme and keeps the one of median time. Pictures of the ranks are
// reduced before they are gathered.
#include "apps/compare/compose/shown_scheme.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "apps/render/background.h"
#include "apps/share_layers.h"
#include "comm/collectives.h"
#include "comm/recording.h"

namespace delray::apps {
namespace {

constexpr int kReducedWidth = 320;

comm::Buffer packed(const image::Image8& image) { return comm::Buffer::of(image.colour.span()); }

image::Image8 unpacked(const comm::Buffer& buffer, int width, int height) {
  image::Image8 image(width, height);
  const auto colours = buffer.as<image::Rgba8>();
  std::copy(colours.begin(), colours.end(), image.colour.data());
  return image;
}

// Pixels that the part does not own become transparent.
void keep_owned(const std::vector<composite::PixelRange>& ranges, image::Image8& image) {
  std::vector<bool> owned(image.pixels());
  for (const composite::PixelRange& range : ranges) {
    std::fill(owned.begin() + static_cast<std::ptrdiff_t>(range.begin),
              owned.begin() + static_cast<std::ptrdiff_t>(range.end), true);
  }
  for (std::size_t i = 0; i < owned.size(); ++i)
    if (!owned[i]) image.colour[i] = {};
}

}  // namespace

image::Image8 reduced(const image::Image8& image, int side) {
  image::Image8 result((image.width + side - 1) / side, (image.height + side - 1) / side);
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x) {
      std::array<unsigned, 4> sum{};
      unsigned count = 0;
      for (int j = y * side; j < std::min((y + 1) * side, image.height); ++j) {
        for (int i = x * side; i < std::min((x + 1) * side, image.width); ++i, ++count) {
          const image::Rgba8& c = image.colour[static_cast<std::size_t>(j) * image.width + i];
          sum[0] += c.r, sum[1] += c.g, sum[2] += c.b, sum[3] += c.a;
        }
      }
      const auto mean = [&](unsigned k) {
        return static_cast<std::uint8_t>((sum[k] + count / 2) / count);
      };
      result.colour[static_cast<std::size_t>(y) * result.width + x] = {mean(0), mean(1), mean(2),
                                                                       mean(3)};
    }
  }
  return result;
}

ShownScheme show_scheme(comm::Communicator& communicator, const raster::PartialImage& share,
                        const std::string& scheme, const std::string& codec,
                        const CompareRequest& request, const Prepared& prepared) {
  const bool root = communicator.rank() == 0;
  const int side = (request.render.width + kReducedWidth - 1) / kReducedWidth;
  const scenes::View view =
      scenes::make_view(prepared.camera, request.render.width, request.render.height);
  const auto finished = [&](image::Image8&& image) {
    put_behind(image, prepared.background, prepared.shading(), view);
    return std::move(image);
  };
  const auto gather_reduced = [&](const image::Image8& image) {
    const image::Image8 small = reduced(image, side);
    std::vector<image::Image8> all;
    for (const comm::Buffer& buffer : comm::gather(communicator, 0, packed(small)))
      all.push_back(unpacked(buffer, small.width, small.height));
    return all;
  };

  ShownScheme result;
  result.scheme = scheme;
  result.codec = codec;
  ShareLayers layers(share);
  composite::OwnedPixels whole;
  whole.layer = layers.make(codec);
  image::Image8 own = layers.image_of(std::move(whole));
  for (std::size_t i = 0; i < own.pixels(); ++i)  // what nothing covers may hold anything
    if (!(own.depth[i] < image::kEmptyDepth)) own.colour[i] = {};
  result.partial = gather_reduced(own);

  std::vector<std::vector<comm::Event>> events(kShownRuns);
  std::vector<std::pair<double, int>> seconds;
  for (int run = 0; run < kShownRuns; ++run) {
    comm::Recording recording(communicator, events[static_cast<std::size_t>(run)]);
    auto layer = layers.make(codec);
    // As when times are measured: who has slept in the first one comes out late.
    for (int i = 0; i < 3; ++i) comm::barrier(communicator);
    const double begin = communicator.seconds();
    composite::OwnedPixels part =
        composite::compose(recording, std::move(layer), scheme, {.interlace = request.interlace});
    const std::vector<composite::PixelRange> owned = part.ranges;
    part = composite::gather(recording, std::move(part), 0);
    seconds.emplace_back(communicator.seconds() - begin, run);
    comm::barrier(communicator);  // what follows would slow down those who are not done
    if (run + 1 < kShownRuns) continue;
    // Only the root's image is whole: it tells the others, who show what was theirs.
    if (root) result.picture = finished(layers.image_of(std::move(part)));
    image::Image8 piece(request.render.width, request.render.height);
    const comm::Buffer whole_picture =
        comm::broadcast(communicator, 0, root ? packed(result.picture) : comm::Buffer());
    piece = unpacked(whole_picture, request.render.width, request.render.height);
    keep_owned(owned, piece);
    result.pieces = gather_reduced(piece);
  }
  // Rank 0, to which the image goes, is done last.
  std::sort(seconds.begin(), seconds.end());
  const int middle = comm::all_reduce_value(communicator, root ? seconds[kShownRuns / 2].second : 0,
                                            std::plus<>());
  result.ledger = comm::gather_ledger(communicator, events[static_cast<std::size_t>(middle)]);
  return result;
}

}  // namespace delray::apps
