// Options of `delray render` for the ray tracer, and for what both engines share out by tasks.
#include <fmt/format.h>

#include "apps/options/help.h"
#include "apps/options/numbers.h"
#include "apps/render/options/no_effect.h"
#include "apps/render/options/option_table.h"
#include "loadbalance/schedule.h"
#include "raytrace/distribution.h"
#include "raytrace/integrator.h"

namespace delray::apps {
namespace {

std::string why_no_master(const RenderRequest& r) {
  if (r.sharing.schedule.empty()) return "no --schedule";
  return schedule_of(r)->has_master ? "" : "--schedule " + r.sharing.schedule;
}
std::string why_no_assignment(const RenderRequest& r) {
  const raytrace::Distribution& data = *raytrace::find_distribution(r.data);
  const bool is_dealt = data.division == raytrace::ShareOptions::Division::voxels;
  return data.replicated || is_dealt ? "--data " + r.data : "";
}
std::string why_no_primary(const RenderRequest& r) {
  if (!raytrace::find_distribution(r.data)->replicated) return "--data " + r.data;
  return r.sampling.aperture > 0.0 ? "--aperture, whose rays start all over the lens" : "";
}
std::string why_no_cache(const RenderRequest& r) {
  return raytrace::find_distribution(r.data)->fetches ? "" : "--data " + r.data;
}

}  // namespace

std::vector<RenderOption> raytracer_options() {
  using raytrace::Integrator;
  using Quality = raytrace::BuildOptions::Quality;
  using Assignment = raytrace::ShareOptions::Assignment;
  return {
      RenderOption::of(
          "--integrator", [](auto& r) -> auto& { return r.raytrace.integrator; }, group::kRaytracer,
          "What is computed along rays (default: whitted; --list describes them)")
          .one_of(names_in(raytrace::integrators()))
          .unless(unless_raytrace())
          .in_checkpoint()
          .reported("integrator", is_raytrace),
      RenderOption::of(
          "--spp", [](auto& r) -> auto& { return r.raytrace.samples; }, group::kRaytracer,
          "Samples per pixel (default: 1)")
          .transform(count_between(1, 65536))
          .unless(unless_raytrace())
          .reported("spp", is_raytrace),
      RenderOption::of(
          "--depth", [](auto& r) -> auto& { return r.raytrace.trace.depth; }, group::kRaytracer,
          "Maximum reflections and refractions (default: 8)")
          .transform(count_between(0, 64))
          .unless(unless_raytrace())
          .in_checkpoint()
          .reported("depth", is_raytrace),
      RenderOption::of(
          "--diffuse-depth", [](auto& r) -> auto& { return r.raytrace.trace.diffuse_depth; },
          group::kRaytracer,
          "Maximum diffuse bounces, for --integrator path (default: 64, more than most paths last)")
          .transform(count_between(0, 1024))
          .unless(unless_integrator(&Integrator::scatters))
          .in_checkpoint()
          .reported("diffuse_depth", is_raytrace),
      RenderOption::of(
          "--reach", [](auto& r) -> auto& { return r.reach; }, group::kRaytracer,
          "Ambient occlusion radius in units of the scene, for --integrator ao (default: "
          "unlimited)")
          .check(positive_float())
          .unless(unless_integrator(&Integrator::reaches))
          .in_checkpoint([](const RenderRequest& r) {
            return r.reach > 0.0 ? fmt::format("{}", r.reach) : "unlimited";
          })
          .reported("reach", is_raytrace),
      RenderOption::off(
          "--no-shadows", [](auto& r) -> auto& { return r.raytrace.trace.shadows; },
          group::kRaytracer,
          "Trace no shadow rays, for --integrator direct: light passes through everything")
          .unless(unless_integrator(&Integrator::may_omit_shadows))
          .in_checkpoint([](const RenderRequest& r) {
            return r.raytrace.trace.shadows ? "not given" : "given";
          })
          .reported("shadows", is_raytrace),
      RenderOption::choice<raytrace::Primary>(
          "--primary", [](auto& r) -> auto& { return r.raytrace.primary; },
          {{"trace", raytrace::Primary::trace}, {"raster", raytrace::Primary::raster}},
          group::kRaytracer,
          "Where the first hits of camera rays come from: trace, by rays (default), or raster, "
          "rasterized but for silhouettes, where that is faster: the same picture")
          .unless(unless_raytrace(why_no_primary))
          .reported("primary", is_raytrace),
      RenderOption::choice<Quality>(
          "--build", [](auto& r) -> auto& { return r.raytrace.build.quality; },
          {{"low", Quality::low}, {"medium", Quality::medium}, {"high", Quality::high}},
          group::kRaytracer,
          "Quality of Embree's bounding volume hierarchies: low (fast to build), medium (default) "
          "or high (fast to trace, splits triangles)")
          .unless(unless_raytrace())
          .in_checkpoint()
          .reported("build", is_raytrace),
      RenderOption::choice<std::string>(
          "--isa", [](auto& r) -> auto& { return r.raytrace.build.isa; },
          {{"best", ""},
           {"sse2", "sse2"},
           {"sse4.2", "sse4.2"},
           {"avx", "avx"},
           {"avx2", "avx2"},
           {"avx512", "avx512"}},
          group::kRaytracer,
          "Instruction set for Embree: sse2, sse4.2, avx, avx2, avx512 or best, of this processor "
          "(default); avx2 may be faster than avx512 for incoherent rays")
          .unless(unless_raytrace())
          .in_checkpoint()
          .reported("isa", is_raytrace),
      RenderOption::of(
          "--schedule", [](auto& r) -> auto& { return r.sharing.schedule; }, group::kSharing,
          "How ranks share the blocks of the picture (ray tracer, default: interlaced); "
          "rasterizer: the same for --strategy sort-first (default: none, each rank keeps its "
          "regions)")
          .one_of(names_in(loadbalance::schedules()))
          .unless(unless_strategy(&raster::Strategy::schedules))
          .reported("schedule", ray_tracer_or_strategy_that(&raster::Strategy::partitions)),
      RenderOption::choice<bool>(
          "--master", [](auto& r) -> auto& { return r.sharing.master_works; },
          {{"works", true}, {"serves", false}}, group::kSharing,
          "Whether ranks that hand out blocks (schedules demand, guided and hierarchical) render "
          "some too: works, they do (default), or serves, they do not")
          .unless(why_no_master)
          .reported("master", ray_tracer_or_strategy_that(&raster::Strategy::partitions)),
      RenderOption::of(
          "--data", [](auto& r) -> auto& { return r.data; }, group::kSharing,
          "Ray tracer: distribution of the scene: replicated, all of it on every rank (default), "
          "or another one of --list")
          .one_of(names_in(raytrace::distributions()))
          .unless(unless_raytrace())
          .reported("data", is_raytrace),
      RenderOption::choice<Assignment>(
          "--deal", [](auto& r) -> auto& { return r.share.assignment; },
          {{"neighbours", Assignment::neighbours}, {"random", Assignment::random}}, group::kSharing,
          "Which rank gets which parts of a scene that --data distributes: neighbours stay "
          "together (default), or random")
          .unless(unless_raytrace(why_no_assignment))
          .reported("deal", is_raytrace),
      RenderOption::of(
          "--cut-level", [](auto& r) -> auto& { return r.share.cut_level; }, group::kSharing,
          "Height at which the hierarchy of a scene that --data distributes is cut: about 2^N "
          "subtrees go to ranks, which all have what is above (default: by the number of "
          "triangles)")
          .transform(count_between(0, 24))
          .unless(unless_raytrace(why_no_assignment))
          .reported(
              "cut_level",
              [](const RenderRequest& r) { return is_raytrace(r) && r.share.cut_level >= 0; }),
      RenderOption::of(
          "--cache", [](auto& r) -> auto& { return r.cache_mebibytes; }, group::kSharing,
          "MiB of other ranks' parts of the scene that a rank keeps, for --data object, "
          "packed-voxels and both hybrids (default: a tenth of the scene)")
          .check(number_between(1e-3, 1e9))
          .unless(unless_raytrace(why_no_cache))
          .reported("cache", is_raytrace),
  };
}

}  // namespace delray::apps
