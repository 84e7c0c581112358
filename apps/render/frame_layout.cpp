// The options of crops and walls, and what goes together with them.
#include "apps/render/frame_layout.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <filesystem>

#include "apps/options/help.h"
#include "apps/render/options/option_table.h"
#include "raster/strategies.h"

namespace delray::apps {
namespace {

constexpr int kMostDisplays = 65536;

// Whole numbers with `separator` between them, and nothing else.
template <std::size_t N>
std::optional<std::array<int, N>> parse_numbers(const std::string& text, char separator) {
  std::array<int, N> n{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < N; ++i) {
    const auto [next, error] = std::from_chars(at, end, n[i]);
    if (error != std::errc() || next == at) return {};
    if (i + 1 == N) return next == end ? std::optional(n) : std::nullopt;
    if (next == end || *next != separator) return {};
    at = next + 1;
  }
  return {};
}

geometry::Rect parse_crop(const std::string& text, int width, int height) {
  if (const auto n = parse_numbers<4>(text, ',')) {
    const auto [x, y, w, h] = *n;
    if (x >= 0 && y >= 0 && w >= 1 && h >= 1 && w <= width - x && h <= height - y)
      return {x, y, x + w, y + h};
  }
  throw UsageError(
      fmt::format("--crop: '{}' is not x,y,width,height within the picture of {} x {} pixels", text,
                  width, height));
}

loadbalance::Wall parse_wall(const RenderRequest& request) {
  loadbalance::Wall wall;
  wall.width = request.width;
  wall.height = request.height;
  const auto grid = parse_numbers<2>(request.layout.grid, 'x');
  if (!grid || (*grid)[0] < 1 || (*grid)[1] < 1 || (*grid)[0] > kMostDisplays / (*grid)[1]) {
    throw UsageError(fmt::format("--wall: '{}' is not COLUMNSxROWS, of up to {} displays",
                                 request.layout.grid, kMostDisplays));
  }
  wall.columns = (*grid)[0];
  wall.rows = (*grid)[1];
  if (const std::string& bezel = request.layout.bezel; !bezel.empty()) {
    const auto both = parse_numbers<2>(bezel, 'x');
    const auto one = parse_numbers<1>(bezel, 'x');
    wall.bezel_x = both ? (*both)[0] : one ? (*one)[0] : -1;
    wall.bezel_y = both ? (*both)[1] : one ? (*one)[0] : -1;
    if (std::min(wall.bezel_x, wall.bezel_y) < 0 ||
        std::max(wall.bezel_x, wall.bezel_y) > kLargestSide) {
      throw UsageError(
          fmt::format("--bezel: '{}' is not a number of pixels, or WIDTHxHEIGHT", bezel));
    }
  }
  const std::int64_t width =
      std::int64_t{wall.columns} * wall.width + std::int64_t{wall.columns - 1} * wall.bezel_x;
  const std::int64_t height =
      std::int64_t{wall.rows} * wall.height + std::int64_t{wall.rows - 1} * wall.bezel_y;
  if (width > kLargestSide || height > kLargestSide) {
    throw UsageError(fmt::format("--wall: {} x {} pixels are more than {} in one direction", width,
                                 height, kLargestSide));
  }
  return wall;
}

std::string why_no_wall(const RenderRequest& r) { return r.layout.grid.empty() ? "no --wall" : ""; }

std::string why_not_at_home(const RenderRequest& r) {
  if (r.layout.grid.empty()) return "no --wall";
  if (r.layout.one_file) return "--one-file, which rank 0 writes, so that pixels travel to it";
  if (is_raytrace(r)) return "--engine raytrace, whose ranks trace any part of the picture";
  if (!raster::find_strategy(r.raster.strategy)->displays) {
    return fmt::format("--strategy {}: choose one that cuts the screen, sort-first or sort-middle",
                       r.raster.strategy);
  }
  if (!r.sharing.schedule.empty()) return "--schedule, which hands blocks to any rank";
  return r.raster.groups == raster::Groups::two ? "--groups two, of which one draws nothing" : "";
}

}  // namespace

std::vector<RenderOption> layout_options() {
  return {
      RenderOption::of(
          "--crop", [](auto& r) -> auto& { return r.layout.crop; }, group::kPicture,
          "Render only a part of the picture: x,y,width,height in pixels, from its upper left "
          "corner")
          .type_name("RECT")
          .reported("crop")
          .in_checkpoint([](const RenderRequest& r) {
            const geometry::Rect& w = r.window;
            return fmt::format("{},{},{},{}", w.x0, w.y0, w.width(), w.height());
          }),
      RenderOption::of(
          "--wall", [](auto& r) -> auto& { return r.layout.grid; }, group::kPicture,
          "Show the picture on a wall of so many displays, such as 4x3, each of --size pixels: "
          "ranks share the displays out, and a display is written by the rank that shows it, to "
          "IMAGE-COLUMN-ROW")
          .type_name("CxR")
          .reported("wall"),
      RenderOption::of(
          "--bezel", [](auto& r) -> auto& { return r.layout.bezel; }, group::kPicture,
          "Pixels of the picture that are hidden between two displays: a number, or WIDTHxHEIGHT "
          "(default: 0)")
          .type_name("PIXELS")
          .unless(why_no_wall)
          .reported("bezel"),
      RenderOption::of(
          "--one-file", [](auto& r) -> auto& { return r.layout.one_file; }, group::kPicture,
          "Write the displays of the wall side by side into one file, without what bezels hide")
          .unless(why_no_wall)
          .reported("one_file"),
      RenderOption::of(
          "--draw-at-home", [](auto& r) -> auto& { return r.layout.draw_at_home; }, group::kPicture,
          "Have every display of the wall drawn by the rank that shows it, so that primitives "
          "travel and no pixels, with sort-first and sort-middle (default: regions by --partition, "
          "of which ranks send on what others show)")
          .unless(why_not_at_home)
          .reported("draw_at_home"),
  };
}

void complete_layout(RenderRequest& request) {
  FrameLayout& layout = request.layout;
  if (layout.grid.empty()) {
    if (!layout.crop.empty())
      request.window = parse_crop(layout.crop, request.width, request.height);
    return;
  }
  const auto refuse = [&](bool given, const char* what) {
    if (given) throw UsageError(fmt::format("--wall does not go with {}", what));
  };
  const SamplingOptions& sampling = request.sampling;
  refuse(request.is_animation(), "an animation");
  refuse(!layout.crop.empty(), "--crop");
  refuse(request.output == "-" && !layout.one_file, "-o -, unless with --one-file");
  refuse(sampling.noise > 0.0, "--noise, which looks at neighbouring pixels");
  refuse(sampling.denoise, "--denoise, which looks at neighbouring pixels");
  refuse(sampling.seconds > 0.0, "--time");
  refuse(sampling.channels, "--aovs");
  refuse(sampling.show != "colour", "--show");
  refuse(!sampling.checkpoint.empty(), "--checkpoint");
  refuse(sampling.preview_every > 0.0, "--preview-every");
  layout.wall = parse_wall(request);
  request.window = layout.wall->frame();
  request.width = request.window.width();
  request.height = request.window.height();
}

std::string display_path(const std::string& output, int column, int row) {
  const std::filesystem::path path(output);
  const std::string name =
      fmt::format("{}-{}-{}{}", path.stem().string(), column, row, path.extension().string());
  return (path.parent_path() / name).string();
}

}  // namespace delray::apps
