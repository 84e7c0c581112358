// Each option of `delray render`, described once: what it sets, what it takes, its help, its key in
// statistics, and which capability of a strategy, schedule, integrator or distribution it needs.
#include "apps/render/options/option_table.h"

#include <fmt/format.h>

#include "apps/options/help.h"
#include "apps/options/numbers.h"
#include "apps/render/options/no_effect.h"
#include "composite/codec.h"
#include "loadbalance/partition.h"
#include "loadbalance/schedule.h"
#include "raster/strategies.h"
#include "raytrace/distribution.h"
#include "raytrace/integrator.h"

namespace delray::apps {
namespace {

std::string why_no_codec(const RenderRequest& r) {
  return r.raster.shade == raster::Shade::composited ? "--shade composited" : "";
}
std::string why_no_travel(const RenderRequest& r) {
  return r.sharing.schedule.empty() ? "" : "--schedule: every rank has all primitives";
}
std::string why_no_partition(const RenderRequest& r) {
  if (r.layout.draw_at_home) return "--draw-at-home";
  if (is_raster(r) || schedule_of(r)->begins_with_shares) return "";
  return fmt::format("--schedule {}, which begins with no shares", r.sharing.schedule);
}
std::string why_no_costs(const RenderRequest& r) {
  return r.sharing.partition.empty() ? "no --partition" : "";
}
std::string why_no_measured_costs(const RenderRequest& r) {
  return is_raster(r) && !strategy_of(r).partitions ? "" : why_no_costs(r);
}
std::string why_no_block(const RenderRequest& r) {
  return r.sharing.schedule.empty() ? "no --schedule" : "";
}
std::string why_no_geometry_ranks(const RenderRequest& r) {
  return r.raster.groups == raster::Groups::one ? "--groups one" : "";
}
}  // namespace

std::vector<RenderOption> picture_options() {
  return {
      RenderOption::of(
          "-o,--output", [](auto& r) -> auto& { return r.output; }, group::kOutput,
          "Picture to write: .png, .exr, .tif or .jpg; - for PNG on standard output; of an "
          "animation .mp4 too, where ffmpeg is installed")
          .type_name("FILE"),
      RenderOption::of(
          "--size", [](auto& r) -> auto& { return r.size; }, group::kPicture,
          "Width and height in pixels, such as 1920x1080 (default: 1280x720)")
          .type_name("WxH")
          .in_checkpoint(
              [](const RenderRequest& r) { return fmt::format("{}x{}", r.width, r.height); })
          .reported("size"),
      RenderOption::choice<Engine>(
          "--engine", [](auto& r) -> auto& { return r.engine; },
          {{"raster", Engine::raster}, {"raytrace", Engine::raytrace}}, group::kPicture,
          "Renderer: raster, the rasterizer (default), or raytrace, the ray tracer")
          .reported("engine"),
      RenderOption::of(
          "--frames", [](auto& r) -> auto& { return r.frames; }, group::kOutput,
          "Render the picture this many times and report the median time (default: 1)")
          .transform(count_between(1, 100000))
          .reported("frames"),
      RenderOption::of(
          "--background", [](auto& r) -> auto& { return r.background; }, group::kPicture,
          "What is behind the scene: environment, studio (grey, brighter above), transparent, a "
          "colour as #rrggbb, or auto (default), which suits the scene")
          .type_name("WHAT")
          .one_of(background_names(),
                  {"#rrggbb", [](const std::string& text) { return text.starts_with('#'); }})
          .reported("background"),
      RenderOption::of(
          "--legend", [](auto& r) -> auto& { return r.legend; }, group::kPicture,
          "Draw into the picture what colours tell: heights, intensity, classes or returns"),
  };
}

std::vector<RenderOption> animation_options() {
  return {
      RenderOption::of(
          "--turntable", [](auto& r) -> auto& { return r.turntable; }, group::kCamera,
          "Animation of so many frames once around the scene: IMAGE-0000 and on")
          .transform(count_between(1, 1000000))
          .excludes("--frames")
          .reported("turntable"),
      RenderOption::of(
          "--camera-path", [](auto& r) -> auto& { return r.camera_path; }, group::kCamera,
          "Animation along the cameras in this file, one a line: [FRAME:] eye,at,up,fov")
          .type_name("FILE")
          .excludes("--frames")
          .excludes("--turntable")
          .excludes("--camera")
          .excludes("--view")
          .reported("camera_path"),
      RenderOption::of(
          "--animate", [](auto& r) -> auto& { return r.motion.animate; }, group::kCamera,
          "Animation of a scene that moves, as its file says: FPS frames a second from START up to "
          "END seconds, such as 0:2:30: IMAGE-0000 and on")
          .type_name("START:END:FPS")
          .excludes("--frames")
          .excludes("--turntable")
          .excludes("--camera-path")
          .reported("animate"),
      RenderOption::of(
          "--pose-time", [](auto& r) -> auto& { return r.motion.pose_time; }, group::kCamera,
          "Seconds of the scene's animation to show it at (default: at rest)")
          .type_name("SECONDS")
          .excludes("--animate")
          .in_checkpoint()
          .reported("pose_time"),
      RenderOption::of(
          "--animation", [](auto& r) -> auto& { return r.motion.animation; }, group::kCamera,
          "Name or number of the scene's animation, for --animate and --pose-time (default: the "
          "first; info lists them)")
          .type_name("NAME")
          .unless([](const RenderRequest& r) -> std::string {
            const bool moves = r.motion.is_animation() || !r.motion.pose_time.empty();
            return moves ? "" : "neither --animate nor --pose-time";
          })
          .in_checkpoint()
          .reported("animation"),
      RenderOption::of(
          "--frames-at-once", [](auto& r) -> auto& { return r.frames_at_once; }, group::kCamera,
          "Frames of an animation to work on at the same time (default: threads + 2, but 4 to 8)")
          .transform(count_between(1, 64))
          .unless([](const RenderRequest& r) -> std::string {
            return r.is_animation() ? "" : "a single picture";
          }),
  };
}

std::vector<RenderOption> rasterizer_options() {
  using raster::Strategy;
  return {
      RenderOption::of(
          "--strategy", [](auto& r) -> auto& { return r.raster.strategy; }, group::kSharing,
          "Rasterizer: whether primitives, triangles or pixels go to other ranks: sort-first, "
          "sort-middle, sort-last (default) or hybrid")
          .one_of(names_in(raster::strategies()))
          .unless(unless_raster())
          .reported("strategy", is_raster),
      RenderOption::of(
          "--partition", [](auto& r) -> auto& { return r.sharing.partition; }, group::kSharing,
          "How the screen is divided among ranks, for all strategies but sort-last (default: "
          "mahd); ray tracer: the blocks that ranks begin with, for the schedules static and "
          "stealing (default: none)")
          .one_of(names_in(loadbalance::partitioners()))
          .unless(unless_strategy(&Strategy::partitions, why_no_partition))
          .reported("partition", ray_tracer_or_strategy_that(&Strategy::partitions)),
      RenderOption::of(
          "--compose", [](auto& r) -> auto& { return r.raster.scheme; }, group::kSharing,
          "Compositing scheme, which merges the images of all ranks, for --strategy sort-last "
          "(default: binary-swap; radix-k may be given its radices, such as radix-k:4,2)")
          .unless(unless_raster(unless_strategy(&Strategy::composites)))
          .reported("compose", strategy_that(&Strategy::composites)),
      RenderOption::choice<SurfaceLighting>(
          "--shading", [](auto& r) -> auto& { return r.shading; },
          {{"phong", SurfaceLighting::phong},
           {"gouraud", SurfaceLighting::gouraud},
           {"eye-dome", SurfaceLighting::eye_dome}},
          group::kRasterizer,
          "Lighting of surfaces: phong, at every pixel (default), gouraud, at vertices, or "
          "eye-dome, "
          "as phong and darker behind what stands before it, which shows the shape of points")
          .unless(unless_raster())
          .reported("shading", is_raster),
      RenderOption::of(
          "--codec", [](auto& r) -> auto& { return r.raster.codec; }, group::kSharing,
          "Pixel encoding between ranks, for --strategy sort-last (default: active)")
          .one_of(names_in(composite::codecs()))
          .unless(unless_raster(unless_strategy(&Strategy::composites, why_no_codec)))
          .reported("codec", strategy_that(&Strategy::composites)),
      RenderOption::choice<raster::Blend>(
          "--blend", [](auto& r) -> auto& { return r.raster.blend; },
          {{"by-owner", raster::Blend::by_owner}, {"by-cell", raster::Blend::by_cell}},
          group::kSharing,
          "Transparent surfaces, for --strategy sort-last: by-owner, the rank that owns a pixel "
          "sorts all its fragments (default, exact), or by-cell, each rank blends those in its "
          "cell of space, and cells are merged front to back")
          .unless(unless_raster(unless_strategy(&Strategy::composites, why_no_codec)))
          .reported("blend", strategy_that(&Strategy::composites)),
      RenderOption::choice<raster::Shade>(
          "--shade", [](auto& r) -> auto& { return r.raster.shade; },
          {{"deferred", raster::Shade::deferred},
           {"immediate", raster::Shade::immediate},
           {"composited", raster::Shade::composited}},
          group::kRasterizer,
          "When pixels are shaded: immediate, as they are drawn; deferred, once all is drawn "
          "(default); composited, once the images of all ranks are merged (sort-last)")
          .unless(unless_raster())
          .reported("shade", is_raster),
      RenderOption::of(
          "--samples", [](auto& r) -> auto& { return r.raster.supersampling; }, group::kRasterizer,
          "Samples per pixel in each direction: 1 (default), 2 or 4, which is 16 per pixel")
          .check(one_of({"1", "2", "4"}))
          .unless(unless_raster())
          .reported("samples", is_raster),
      RenderOption::choice<raster::Travel>(
          "--travel", [](auto& r) -> auto& { return r.raster.travel; },
          {{"geometry", raster::Travel::geometry}, {"numbers", raster::Travel::numbers}},
          group::kSharing,
          "How primitives are sent to other ranks, for --strategy sort-first and hybrid: as "
          "geometry (default), or as numbers, by which they are looked up in the scene")
          .unless(unless_raster(unless_strategy(&Strategy::travels, why_no_travel)))
          .reported("travel", strategy_that(&Strategy::partitions)),
      RenderOption::choice<bool>(
          "--costs", [](auto& r) -> auto& { return r.sharing.measured_costs; },
          {{"model", false}, {"measured", true}}, group::kSharing,
          "Costs that partitions balance, and shares of --strategy sort-last: model, an estimate "
          "(default), or measured, times of the last frame")
          .unless(unless_strategy(&Strategy::costs, why_no_measured_costs))
          .reported("costs", ray_tracer_or_strategy_that(&Strategy::costs)),
      RenderOption::of(
          "--regions", [](auto& r) -> auto& { return r.sharing.regions_per_rank; }, group::kSharing,
          "Regions of the screen per rank (default: 1)")
          .transform(count_between(1, 64))
          .unless(unless_strategy(&Strategy::partitions, why_no_costs))
          .reported("regions", ray_tracer_or_strategy_that(&Strategy::partitions)),
      RenderOption::of(
          "--keep", [](auto& r) -> auto& { return r.sharing.keep_factor; }, group::kSharing,
          "Repartition when a rank exceeds this multiple of the mean load (default: 1.1)")
          .check(number_between(1.0, 1000.0))
          .unless(unless_strategy(&Strategy::partitions, why_no_costs))
          .reported("keep", ray_tracer_or_strategy_that(&Strategy::partitions)),
      RenderOption::of(
          "--block", [](auto& r) -> auto& { return r.sharing.block; }, group::kSharing,
          "Side in pixels of the blocks that --schedule hands out (default: 64; ray tracer: 16, or "
          "32 with path), or cache: as many pixels as fit the first-level data cache, in whole "
          "lines of it")
          .transform(block_side())
          .unless(unless_strategy(&Strategy::schedules, why_no_block))
          .reported("block", ray_tracer_or_strategy_that(&Strategy::partitions)),
      RenderOption::choice<raster::Groups>(
          "--groups", [](auto& r) -> auto& { return r.raster.groups; },
          {{"one", raster::Groups::one}, {"two", raster::Groups::two}}, group::kSharing,
          "For --strategy sort-middle: one group of ranks, each for geometry and pixels (default), "
          "or two groups, one for geometry and one for pixels")
          .unless(unless_raster(unless_strategy(&Strategy::groups)))
          .reported("groups", strategy_that(&Strategy::groups)),
      RenderOption::of(
          "--geometry-ranks", [](auto& r) -> auto& { return r.raster.geometry_ranks; },
          group::kSharing, "Number of ranks for geometry, for --groups two (default: half of all)")
          .transform(count_between(1, 1000000))
          .unless(unless_raster(unless_strategy(&Strategy::groups, why_no_geometry_ranks)))
          .reported("geometry_ranks", strategy_that(&Strategy::groups)),
      RenderOption::choice<raster::Redistribution>(
          "--redistribute", [](auto& r) -> auto& { return r.raster.redistribution; },
          {{"immediate", raster::Redistribution::immediate},
           {"at-end", raster::Redistribution::at_end},
           {"broadcast", raster::Redistribution::broadcast}},
          group::kSharing,
          "For --strategy sort-middle: send triangles in batches as they are transformed "
          "(immediate, default), all at-end, or broadcast, at the end and once to all ranks, which "
          "take what they need, as on InfiniteReality's bus (with --partition infinite-reality)")
          .unless(unless_raster(unless_strategy(&Strategy::groups)))
          .reported("redistribute", strategy_that(&Strategy::groups)),
  };
}

std::vector<RenderOption> pack_options() {
  return {
      RenderOption::of(
          "--error", [](auto& r) -> auto& { return r.raster.error; }, group::kRasterizer,
          "Of packs: how far surfaces may be from where they belong, in pixels, so that coarser "
          "ones "
          "are drawn (default: 0, the exact picture)")
          .check(number_between(0.0, 1000.0))
          .unless(unless_raster([](const RenderRequest& r) -> std::string {
            if (!strategy_of(r).packs) return "--strategy " + r.raster.strategy;
            return r.sharing.schedule.empty() ? "" : "--schedule";
          }))
          .reported("error", strategy_that(&raster::Strategy::packs)),
      RenderOption::of(
          "--frame-time", [](auto& r) -> auto& { return r.frame_milliseconds; }, group::kRasterizer,
          "Of animations of packs: milliseconds that a frame is to take; the bound of error "
          "follows "
          "from what the frames before took")
          .check(number_between(0.1, 1e6))
          .type_name("MS")
          .excludes("--error")
          .unless(unless_raster([](const RenderRequest& r) -> std::string {
            if (!r.is_animation()) return "a single picture";
            if (!strategy_of(r).packs) return "--strategy " + r.raster.strategy;
            return r.sharing.schedule.empty() ? "" : "--schedule";
          }))
          .reported("frame_time", [](const RenderRequest& r) { return r.frame_milliseconds > 0; }),
  };
}

std::vector<RenderOption> output_options() {
  return {
      RenderOption::of(
          "--stats", [](auto& r) -> auto& { return r.statistics; }, group::kOutput,
          "Statistics as JSON to this file; - for standard output")
          .type_name("FILE"),
      RenderOption::of(
          "--list", [](auto& r) -> auto& { return r.list; }, group::kOutput,
          "List the names that options choose from, and what they mean"),
  };
}

}  // namespace delray::apps
