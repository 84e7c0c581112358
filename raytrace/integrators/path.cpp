// Path tracing (Kajiya 1986) over many samples at a time, generation by generation of rays
// (wavefronts: Laine et al. 2013).
//
// All paths of a task advance by one surface together. Surfaces that were met are sorted by
// material, so that blocks of sixteen are full; each draws a light and a direction, weighted by the
// power heuristic (Veach 1997), and rays that go on are packed into full groups again. Russian
// roulette ends paths that carry little. Cost: two rays for each surface that a path meets.
//
// Degenerate: radiance that is not finite is dropped; layers are passed by chance, and a path
// through too many of them ends; a light without size counts in full, as no scattered ray finds it.
#include "raytrace/integrators/path.h"

#include <bit>
#include <span>

#include "raytrace/integrators/enqueue.h"
#include "raytrace/integrators/hits_by_material.h"
#include "raytrace/integrators/lane_sums.h"
#include "raytrace/integrators/path_queue.h"
#include "raytrace/integrators/path_samples.h"
#include "raytrace/integrators/path_vertices.h"
#include "raytrace/integrators/waiting_rays.h"
#include "raytrace/sampling/bsdf.h"
#include "raytrace/sampling/light_table.h"
#include "raytrace/sampling/warp.h"
#include "raytrace/scene/same_material.h"
#include "shading/batch.h"

namespace delray::raytrace {
namespace {

using shading::LaneMask;

// Scatterings after which a path may end by chance.
constexpr int kCertain = 2;

// Random numbers drawn at each surface: dimensions of the sampler, pairs first.
enum Dimension : std::uint32_t {
  kLight,
  kLobe = kLight + LightTable::kPairs,  // and whether the path goes on
  kDirection,
  kLayer,
  kDimensions,
};

class Path final : public WavefrontIntegrator {
 public:
  explicit Path(const FrameContext& context)
      : WavefrontIntegrator(context, Positions::random),
        plain_(context.shader.materials.size()),
        coloured_(context.shader.materials.size()) {}

 private:
  void begin() override { queue_.begin(); }

  void count_waiting(std::span<std::uint32_t> by_block) override {
    count_rays(batch_.rays, queue_.waiting(), by_block);
    count_rays(batch_.shadows, queue_.waiting_lights(), by_block);
  }
  RayCounts write_waiting(std::span<const std::uint8_t> moved, RayWriter& to) override {
    RayCounts counts;
    write_rays(batch_.rays, queue_.waiting(), moved, to, [&](const PathLanes& lanes, int i) {
      ++(lanes.is_primary(i) ? counts.primary : counts.secondary);
    });
    write_rays(batch_.shadows, queue_.waiting_lights(), moved, to,
               [&](const LightLanes&, int) { ++counts.shadow; });
    return counts;
  }
  void read_waiting(RayReader& from) override {
    read_rays(from, batch_.rays, queue_.waiting());
    read_rays(from, batch_.shadows, queue_.waiting_lights());
  }

  void shade() override {
    queue_.begin_generation();
    texture_sets_ = 0;
    for (std::size_t g = 0; g < batch_.shadows.size(); ++g) {
      sums_.add_light(batch_.shadows[g], queue_.lights(g));
    }
    for (std::size_t g = 0; g < batch_.rays.size(); ++g) {
      PathLanes& lanes = queue_.paths(g);
      if (lanes.whole && batch_.rays[g].hits != 0) spell_out(lanes);
      add_sky(batch_.rays[g], lanes);
      if (batch_.rays[g].hits != 0) find(static_cast<std::uint32_t>(g), lanes);
    }
    shade_gathered(plain_.take(), false);
    shade_gathered(coloured_.take(), true);
  }

  static void spell_out(PathLanes& lanes) {
    for (int i = 0; i < kPacketRays; ++i) {
      lanes.throughput.set(i, glm::vec3(1.0F));
      lanes.pdf[i] = 0.0F;
      lanes.pixel[i] = lanes.block * kPacketRays + static_cast<std::uint32_t>(i);
      lanes.bounce[i] = lanes.vertex[i] = 0;
      lanes.instance[i] = lanes.triangle[i] = kMiss;
    }
  }

  void add_sky(const RayGroup& group, const PathLanes& lanes) {
    LaneMask missed = active_lanes(group.active) & ~group.hits;
    if (missed == 0) return;
    const bool transparent = context_.options.background == TraceOptions::Background::transparent;
    if (transparent) missed = sums_.make_transparent(lanes, missed);
    if (missed == 0 || context_.shader.shader->environment.black) return;
    negate_lanes(group.view, directions_);
    shading::environment_radiance(context_.shader, directions_, 0.0F, missed, colour_);
    if (lanes.whole) return add_lanes(colour_, missed, samples_[lanes.block].colour);
    context_.lights.pdf_of_sky(directions_, pdfs_);
    weigh_sky(lanes, pdfs_, colour_);
    sums_.add(colour_, lanes, missed);
  }

  // The surfaces that a group's rays met: looks at them at once where they fill it.
  void find(std::uint32_t number, PathLanes& lanes) {
    const RayGroup& group = batch_.rays[number];
    const LaneMask seen = see(group, lanes);
    for (LaneMask rest = seen; rest != 0;) {
      const LaneMask same = same_material(group, rest);
      rest &= ~same;
      const std::uint32_t material = group.material[std::countr_zero(same)];
      if (same == shading::kAllLanes) return shade_all(number, lanes);
      const bool known = material < context_.shader.materials.size();
      (group.points.coloured ? coloured_ : plain_).add(known ? material : 0, number, same);
      texture_sets_ = std::max(texture_sets_, context_.shader.material(material).texture_sets);
    }
  }

  void shade_all(std::uint32_t number, PathLanes& lanes) {
    for (std::uint32_t i = 0; i < kPacketRays; ++i) sources_[i] = number * kPacketRays + i;
    shade_hits(batch_.rays[number], lanes, shading::kAllLanes);
  }

  void shade_gathered(std::span<const std::uint32_t> hits, bool coloured) {
    while (!hits.empty()) {
      const std::size_t count = std::min<std::size_t>(hits.size(), kPacketRays);
      gather_hits(batch_.rays, queue_.paths(), hits.first(count), coloured, texture_sets_, group_,
                  lanes_);
      std::copy_n(hits.begin(), count, sources_);
      shade_hits(group_, lanes_, shading::first_lanes(static_cast<int>(count)));
      hits = hits.subspan(count);
    }
  }

  // Surfaces side by side, of which lane i is that of hit sources_[i] of the batch.
  void shade_hits(const RayGroup& group, PathLanes& lanes, LaneMask seen) {
    evaluate_surfaces(group, lanes, seen);
    LaneMask alive = remove_spent_lobes(lanes, seen);
    for (LaneMask rest = emissive_lanes(surfaces_, seen); rest != 0; rest &= rest - 1) {
      add_emission(lanes, std::countr_zero(rest));
    }
    if (alive != 0) make_bsdfs(surfaces_, group.view, alive, bsdfs_);
    alive &= ~bsdfs_.black;
    if (alive == 0) return;
    draw_at(lanes, alive, kLight, pairs_);
    const Vertices vertices{group, lanes, surfaces_};
    connect(vertices, alive);
    scatter(vertices, alive);
  }

  void evaluate_surfaces(const RayGroup& group, PathLanes& lanes, LaneMask seen) {
    for (LaneMask rest = seen; rest != 0;) {
      const LaneMask same = same_material(group, rest);
      const std::uint32_t material = group.material[std::countr_zero(rest)];
      shading::evaluate(context_.shader, material, group.points, group.view, same, surfaces_);
      if (context_.shader.material(material).absorbs) absorb(group, lanes, same);
      rest &= ~same;
    }
  }

  // Enqueues a shadow ray from each vertex to a light that is drawn.
  void connect(const Vertices& vertices, LaneMask alive) {
    context_.lights.sample(context_.shader, surfaces_.position, alive,
                           std::span(pairs_).subspan<kLight, LightTable::kPairs>(), lights_);
    evaluate(bsdfs_, lights_.direction, alive, values_);
    const LaneMask lit = rays_to_lights(vertices, lights_, values_, alive, light_rays_);
    if (lit != 0) queue_.enqueue(light_rays_, lit, lights_);
  }

  // Enqueues the rays by which paths go on.
  void scatter(const Vertices& vertices, LaneMask alive) {
    sample(bsdfs_, pairs_[kLobe].x, pairs_[kDirection].x, pairs_[kDirection].y, alive, scattered_);
    scattered_rays(vertices, scattered_, pairs_[kLobe].y, kCertain, alive, next_rays_);
    if (next_rays_.count != 0) queue_.enqueue(next_rays_);
  }

  // Bodies of glass take from the light that comes out of them.
  void absorb(const RayGroup& group, PathLanes& lanes, LaneMask same) {
    for (LaneMask rest = same; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      if (surfaces_.front[i] != 0) continue;
      // Rays of the camera have directions of any length.
      const float distance = lanes.bounce[i] == 0
                                 ? glm::distance(surfaces_.position.get(i), context_.view.eye)
                                 : group.packet.far[i];
      const auto& material = context_.shader.material(group.material[i]).material;
      lanes.throughput.set(i, lanes.throughput.get(i) * shading::transmittance(material, distance));
    }
  }

  // The lanes that may scatter once more.
  LaneMask remove_spent_lobes(const PathLanes& lanes, LaneMask seen) {
    LaneMask alive = 0;
    for (LaneMask rest = seen; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      alive |= may_scatter(lanes, i) ? 1U << i : 0U;
    }
    return alive;
  }

  // Takes the lobes from a surface of which light has been scattered by its kind as often as it
  // may. Returns whether some are left.
  bool may_scatter(const PathLanes& lanes, int i) {
    const bool diffuse = diffuse_bounces(lanes.bounce[i]) < context_.options.diffuse_depth;
    const bool others = other_bounces(lanes.bounce[i]) < context_.options.depth;
    if (!diffuse) shading::remove_diffuse(surfaces_, i);
    if (!others) shading::keep_diffuse(surfaces_, i);
    return diffuse || others;
  }

  // Pairs of numbers from a dimension on.
  void draw_at(const PathLanes& lanes, LaneMask mask, Dimension first, std::span<Pairs16> pairs) {
    draw(lanes.pixel, mask, numbers_);
    for (int i = 0; i < kPacketRays; ++i) {
      numbers_.dimension[i] += lanes.vertex[i] * kDimensions + first;
    }
    sobol_pairs(numbers_, pairs);
  }

  // The hits that may be seen through, with their alpha_.
  LaneMask find_alphas(const RayGroup& group) {
    LaneMask layered = 0;
    for (LaneMask rest = group.hits; rest != 0;) {
      const LaneMask same = same_material(group, rest);
      const std::uint32_t material = group.material[std::countr_zero(rest)];
      rest &= ~same;
      if (context_.shader.material(material).covers && !group.points.coloured) continue;
      shading::coverage(context_.shader, material, group.points, same, alpha_);
      layered |= same;
    }
    return layered;
  }

  // Asks for rays behind layers that a path goes through by chance. Returns the other hits, and
  // notes their depths.
  LaneMask see(const RayGroup& group, const PathLanes& lanes) {
    LaneMask seen = group.hits;
    const LaneMask layered = find_alphas(group);
    bool drawn = false;
    for (LaneMask rest = layered; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      const Hit hit = hit_of(group.packet, i);
      // A ray that left a layer behind may meet it once more.
      const bool again = hit.instance == lanes.instance[i] && hit.triangle == lanes.triangle[i];
      if (!again) {
        if (!(alpha_[i] < 1.0F)) continue;
        if (!drawn) draw_at(lanes, layered, kLayer, std::span(pairs_).first<1>());
        drawn = true;
        if (pairs_[0].x[i] < alpha_[i]) continue;
      }
      const auto most =
          static_cast<std::uint32_t>(context_.options.depth + context_.options.diffuse_depth);
      if (lanes.vertex[i] < kMostLayers + most) queue_.go_behind(group, lanes, i, hit);
      seen &= ~(1U << i);
    }
    sums_.set_depths(group, lanes, seen);
    return seen;
  }

  void add_emission(const PathLanes& lanes, int i) {
    float share = 1.0F;
    if (lanes.pdf[i] > 0.0F) {
      const RayPacket& packet = batch_.rays[sources_[i] / kPacketRays].packet;
      const int lane = static_cast<int>(sources_[i] % kPacketRays);
      const Hit hit = hit_of(packet, lane);
      const float pdf = context_.lights.pdf_of_hit(
          hit.instance, hit.triangle, origin_of(packet, lane), surfaces_.position.get(i));
      share = power_heuristic(lanes.pdf[i], pdf);
    }
    sums_.add(lanes.pixel[i], lanes.throughput.get(i) * surfaces_.emission.get(i) * share);
  }

  PathQueue queue_{next_, rays_};
  PathSamples sums_{samples_};
  HitsByMaterial plain_, coloured_;  // colours of vertices: of none, of some of a group
  int texture_sets_ = 0;             // the most that one of their materials looks at
  // The surfaces that are shaded.
  RayGroup group_;
  PathLanes lanes_;
  std::uint32_t sources_[kPacketRays] = {};
  shading::Floats16 alpha_;
  shading::Surfaces surfaces_;
  Bsdfs bsdfs_;
  SampleLanes numbers_{};
  Pairs16 pairs_[kLayer];
  LightSamples lights_;
  BsdfValues values_;
  BsdfSamples scattered_;
  LightRays light_rays_;
  ScatteredRays next_rays_;
  shading::Vectors16 directions_, colour_;
  shading::Floats16 pdfs_;
};

}  // namespace

std::unique_ptr<WavefrontIntegrator> make_path(const FrameContext& context) {
  return std::make_unique<Path>(context);
}

}  // namespace delray::raytrace
