// Renders windows of the whole width from top to bottom, of which rank 0 hands each to the file as
// soon as it is there. What bezels hide is cut out on the way.
#include "apps/render/bands.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>

#include "apps/render/write_picture.h"
#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "image/hash.h"
#include "image/io.h"
#include "image/picture_rows.h"
#include "image/srgb.h"

namespace delray::apps {
namespace {

using geometry::Rect;

// The columns of the frame that are written.
std::vector<Rect> columns_of(const RenderRequest& request, const Rect& band) {
  if (!request.layout.wall) return {band};
  const loadbalance::Wall& wall = *request.layout.wall;
  std::vector<Rect> columns;
  for (int i = 0; i < wall.columns; ++i) {
    const Rect display = wall.display(i);
    columns.push_back({display.x0, band.y0, display.x1, band.y1});
  }
  return columns;
}

// What is seen at a sample of the band, and a copy of a pixel.
constexpr std::uint64_t kSampleBytes = 8, kCopyBytes = 4;

std::uint64_t bytes_in_the_making(const RenderRequest& request, int ranks) {
  const auto n = static_cast<std::uint64_t>(request.raster.supersampling);
  // What others draw is theirs, too, until rank 0 has it.
  const std::uint64_t elsewhere = ranks > 1 ? picture_bytes_per_pixel(request, 1) : 0;
  return elsewhere + kCopyBytes + (request.engine == Engine::raster ? kSampleBytes * n * n : 0);
}

template <class Image>
Image cut(Image&& picture, const Rect& band, const std::vector<Rect>& columns, int width) {
  if (columns.size() == 1) return std::move(picture);
  Image result(width, band.height());
  std::size_t to = 0;
  for (int y = 0; y < band.height(); ++y) {
    for (const Rect& column : columns) {
      const auto from = static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                        static_cast<std::size_t>(column.x0 - band.x0);
      const auto count = static_cast<std::size_t>(column.width());
      std::copy_n(picture.colour.data() + from, count, result.colour.data() + to);
      std::copy_n(picture.depth.data() + from, count, result.depth.data() + to);
      to += count;
    }
  }
  return result;
}

image::Image8 as_codes(const image::ImageF& picture) { return image::to_8bit(picture); }
const image::Image8& as_codes(const image::Image8& picture) { return picture; }

// Parts of a picture below each other, all of the same kind.
Picture stacked(const std::vector<Picture>& parts, int width, int height) {
  return std::visit(
      [&](const auto& first) -> Picture {
        using Image = std::decay_t<decltype(first)>;
        Image all(width, height);
        std::size_t to = 0;
        for (const Picture& part : parts) {
          const Image& rows = std::get<Image>(part);
          std::copy_n(rows.colour.data(), rows.pixels(), all.colour.data() + to);
          std::copy_n(rows.depth.data(), rows.pixels(), all.depth.data() + to);
          to += rows.pixels();
        }
        return all;
      },
      parts.front());
}

// The windows whose rows are shown: the frame, or rows of displays.
std::vector<Rect> shown_rows(const RenderRequest& request) {
  if (!request.layout.wall) return {request.window};
  std::vector<Rect> rows;
  for (int row = 0; row < request.layout.wall->rows; ++row) {
    const Rect display = request.layout.wall->display(row * request.layout.wall->columns);
    rows.push_back({request.window.x0, display.y0, request.window.x1, display.y1});
  }
  return rows;
}

void add(EngineStatistics&& more, EngineStatistics& all) {
  if (all.index() != more.index()) {
    all = std::move(more);
    return;
  }
  std::visit([&](auto& sum) { sum += std::get<std::decay_t<decltype(sum)>>(std::move(more)); },
             all);
}

}  // namespace

std::uint64_t writer_bytes(const std::string& output) {
  constexpr std::uint64_t kOpenImageIO = 128 << 20;  // measured of TIFF and EXR
  return image::is_picture_suffix(output) && image::picture_suffix(output) != ".png" ? kOpenImageIO
                                                                                     : 0;
}

bool comes_in_bands(const RenderRequest& request) {
  if (request.legend || request.shading == SurfaceLighting::eye_dome) return false;
  const SamplingOptions& sampling = request.sampling;
  return !request.layout.has_displays() && image::is_written_in_rows(request.output) &&
         !request.is_animation() && request.frames == 1 && sampling.noise == 0.0 &&
         sampling.seconds == 0.0 && sampling.checkpoint.empty() && !sampling.channels &&
         !sampling.denoise && sampling.show == "colour" && sampling.preview_every == 0.0;
}

std::vector<Rect> choose_bands(comm::Communicator& communicator, const RenderRequest& request) {
  std::vector<Rect> bands;
  if (communicator.rank() == 0) {
    const int ranks = std::max(1, request.launch.ranks);
    const std::uint64_t row =
        static_cast<std::uint64_t>(request.window.width()) *
        (picture_bytes_per_pixel(request, ranks) + bytes_in_the_making(request, ranks));
    const std::uint64_t left = request.scene.file.limits.budget().left();
    // Half of it: what was freed is not all given back at once.
    const std::uint64_t fit = (left - std::min(left, writer_bytes(request.output))) / 2 / row;
    const auto rows = static_cast<int>(
        std::clamp<std::uint64_t>(fit / kLeastBand * kLeastBand, kLeastBand, 1 << 30));
    const bool in_bands = comes_in_bands(request);
    for (const Rect& shown : shown_rows(request)) {
      const int height = in_bands && fit < static_cast<std::uint64_t>(shown.height())
                             ? rows
                             : std::max(1, shown.height());
      for (int y = shown.y0; y < shown.y1; y += height)
        bands.push_back({shown.x0, y, shown.x1, std::min(y + height, shown.y1)});
    }
  }
  const comm::Buffer all =
      comm::broadcast(communicator, 0, comm::Buffer::of(std::span<const Rect>(bands)));
  return {all.as<Rect>().begin(), all.as<Rect>().end()};
}

BandedPicture render_bands(comm::Communicator& communicator, const Prepared& prepared,
                           const RenderRequest& request, const Session& session,
                           parallel::Progress* progress, const std::vector<Rect>& bands) {
  const bool root = communicator.rank() == 0;
  const int width = request.picture_width(), height = request.picture_height();
  FrameRenderer renderer(communicator, prepared, request, progress);
  BandedPicture result;
  result.is_empty = true;
  std::optional<image::PictureRows> rows;
  std::optional<image::PictureHash> hash;
  std::vector<Picture> whole;  // of a format that wants it at once
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    if (!root) return;
    hash.emplace();
    if (!image::is_written_in_rows(request.output)) return;
    const std::vector<image::Attribute> attributes = picture_attributes(session, request.output);
    image::WriteOptions options;
    options.attributes = attributes;
    rows.emplace(request.output, width, height, options);
  });
  double seconds = 0;
  for (const Rect& band : bands) {
    Stopwatch watch;
    Frame frame = renderer.render(communicator, prepared.camera, band);
    seconds += watch.lap();
    add(std::move(frame.statistics), result.frames.statistics);
    result.frames.extras = std::move(frame.extras);
    comm::all_or_none(communicator, comm::Phase::other, [&] {
      if (!root) return;
      result.is_empty = result.is_empty && shows_nothing(request, frame.picture);
      put_background_behind(request, prepared, prepared.camera, band, frame.picture);
      std::visit(
          [&](auto& picture) {
            auto shown = cut(std::move(picture), band, columns_of(request, band), width);
            picture = {};
            hash->append(as_codes(shown));
            if (rows)
              rows->append(shown);
            else
              whole.emplace_back(std::move(shown));
          },
          frame.picture);
    });
    result.write_seconds += watch.lap();
  }
  Stopwatch watch;
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    if (!root) return;
    result.hash = hash->text();
    if (rows)
      rows->commit();
    else
      write_picture(session, request.output, stacked(whole, width, height));
  });
  result.write_seconds += watch.lap();
  result.frames.seconds = {seconds};
  result.frames.launched = launched(communicator, renderer);
  return result;
}

}  // namespace delray::apps
