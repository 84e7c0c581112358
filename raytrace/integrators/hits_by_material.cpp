// Keeps a list of runs of lanes for each material, and gathers the fields of hits into a group by
// vectors. O(hits).
#include "raytrace/integrators/hits_by_material.h"

#include <bit>
#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/integrators/hits_by_material.cpp"
#include <hwy/foreach_target.h>
// Code that is compiled per target comes after it.
#include <hwy/highway.h>

#include "shading/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

using namespace shading::HWY_NAMESPACE;

static_assert(sizeof(RayGroup) % sizeof(float) == 0 && sizeof(PathLanes) % sizeof(float) == 0);

// Elements of arrays of so many lanes in structures that lie one after the other.
class Gather {
 public:
  HWY_INLINE Gather(I offsets, int i) : offsets_(offsets), i_(i) {}
  HWY_INLINE void operator()(const float* from, float* to) const {
    hn::Store(hn::GatherIndex(FloatTag(), from, offsets_), FloatTag(), to + i_);
  }
  HWY_INLINE void operator()(const std::uint32_t* from, std::uint32_t* to) const {
    (*this)(reinterpret_cast<const float*>(from), reinterpret_cast<float*>(to));
  }
  HWY_INLINE void operator()(const shading::Floats16& from, shading::Floats16& to) const {
    (*this)(from.lane, to.lane);
  }
  HWY_INLINE void operator()(const shading::Vectors16& from, shading::Vectors16& to) const {
    (*this)(from.x, to.x);
    (*this)(from.y, to.y);
    (*this)(from.z, to.z);
  }
  HWY_INLINE void operator()(const shading::TexturePoints& from, shading::TexturePoints& to) const {
    (*this)(from.u, to.u);
    (*this)(from.v, to.v);
    (*this)(from.dx_u, to.dx_u);
    (*this)(from.dx_v, to.dx_v);
    (*this)(from.dy_u, to.dy_u);
    (*this)(from.dy_v, to.dy_v);
  }

 private:
  I offsets_;
  int i_;
};

void gather_block(const RayGroup& first, const PathLanes& first_lanes, const std::uint32_t* hits,
                  bool coloured, int texture_sets, RayGroup& to, PathLanes& to_lanes) {
  for (int i = 0; i < kPacketRays; i += lanes()) {
    const I hit = hn::Load(IntTag(), reinterpret_cast<const std::int32_t*>(hits) + i);
    const I group = hn::ShiftRight<4>(hit), lane = hit & set(kPacketRays - 1);
    const auto offsets = [&](std::size_t bytes) {
      return group * set(static_cast<std::int32_t>(bytes / sizeof(float))) + lane;
    };
    const Gather take(offsets(sizeof(RayGroup)), i);
    const shading::Points& from = first.points;
    take(from.position, to.points.position);
    take(from.geometric_normal, to.points.geometric_normal);
    take(from.normal, to.points.normal);
    take(first.view, to.view);
    take(first.width, to.width);
    take(first.spread, to.spread);
    take(first.offset, to.offset);
    take(first.packet.far, to.packet.far);
    take(first.material, to.material);
    if (texture_sets > 0) {
      take(from.tangent, to.points.tangent);
      take(from.handedness, to.points.handedness);
    }
    for (int set = 0; set < texture_sets; ++set) take(from.uvs[set], to.points.uvs[set]);
    if (coloured) {
      take(from.colour, to.points.colour);
      take(from.colour_alpha, to.points.colour_alpha);
    }
    const Gather take_lanes(offsets(sizeof(PathLanes)), i);
    take_lanes(first_lanes.throughput, to_lanes.throughput);
    take_lanes(first_lanes.pdf, to_lanes.pdf);
    take_lanes(first_lanes.pixel, to_lanes.pixel);
    take_lanes(first_lanes.bounce, to_lanes.bounce);
    take_lanes(first_lanes.vertex, to_lanes.vertex);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {
namespace {

HWY_EXPORT(gather_block);

}  // namespace

void HitsByMaterial::add(std::uint32_t material, std::uint32_t group, shading::LaneMask lanes) {
  const auto number = static_cast<std::uint32_t>(runs_.size());
  Runs& runs = runs_of_[material];
  if (runs.first == kEnd) {
    materials_.push_back(material);
    runs.first = number;
  } else {
    runs_[runs.last].next = number;
  }
  runs.last = number;
  runs_.push_back({group, lanes, kEnd});
}

std::span<const std::uint32_t> HitsByMaterial::take() {
  hits_.clear();
  for (const std::uint32_t material : materials_) {
    for (std::uint32_t r = runs_of_[material].first; r != kEnd; r = runs_[r].next) {
      const Run& run = runs_[r];
      for (shading::LaneMask rest = run.lanes; rest != 0; rest &= rest - 1) {
        hits_.push_back(run.group * kPacketRays +
                        static_cast<std::uint32_t>(std::countr_zero(rest)));
      }
    }
    runs_of_[material] = {kEnd, kEnd};
  }
  materials_.clear();
  runs_.clear();
  return hits_;
}

void gather_hits(const Groups<RayGroup>& groups, const Groups<PathLanes>& path_lanes,
                 std::span<const std::uint32_t> hits, bool coloured, int texture_sets,
                 RayGroup& group, PathLanes& lanes) {
  assert(!hits.empty() && hits.size() <= kPacketRays);
  alignas(64) std::uint32_t sources[kPacketRays];
  for (std::size_t i = 0; i < kPacketRays; ++i) sources[i] = hits[i < hits.size() ? i : 0];
  group.points.coloured = coloured;
  HWY_DYNAMIC_DISPATCH(gather_block)
  (groups[0], path_lanes[0], sources, coloured, texture_sets, group, lanes);
}

}  // namespace delray::raytrace
#endif
