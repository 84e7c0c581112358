// Adds what paths find to the samples of their pixels: for all of a block's lanes at once where a
// group is that of its primary rays, else lane by lane.
#include "raytrace/integrators/path_samples.h"

#include <bit>
#include <limits>

#include "image/image.h"
#include "raytrace/integrators/enqueue.h"
#include "raytrace/integrators/lane_sums.h"

namespace delray::raytrace {
namespace {

using shading::LaneMask;

bool finite(const glm::vec3& v) {
  return brightest(glm::abs(v)) < std::numeric_limits<float>::infinity();  // false for NaN
}

}  // namespace

void PathSamples::add(std::uint32_t pixel, const glm::vec3& radiance) {
  if (!finite(radiance)) return;
  SampleBlock& block = samples_[pixel / kPacketRays];
  const int lane = static_cast<int>(pixel % kPacketRays);
  block.colour.set(lane, block.colour.get(lane) + radiance);
}

void PathSamples::add(const shading::Vectors16& radiance, const PathLanes& lanes, LaneMask mask) {
  for (LaneMask rest = mask; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    add(lanes.pixel[i], radiance.get(i));
  }
}

void PathSamples::add_light(const ShadowGroup& group, const LightLanes& lanes) {
  for (LaneMask rest = group.lit; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const glm::vec3 reflected = lanes.reflected.get(i);
    add(lanes.pixel[i],
        (group.attenuated >> i & 1) != 0 ? reflected * group.transmittance.get(i) : reflected);
  }
}

LaneMask PathSamples::make_transparent(const PathLanes& lanes, LaneMask missed) {
  if (lanes.whole) {
    SampleBlock& block = samples_[lanes.block];
    choose_lanes(block.alpha.lane, 0.0F, ~missed, block.alpha);
    return 0;
  }
  for (LaneMask rest = missed; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    if (lanes.bounce[i] != 0) continue;
    samples_[lanes.pixel[i] / kPacketRays].alpha[static_cast<int>(lanes.pixel[i] % kPacketRays)] =
        0.0F;
    missed &= ~(1U << i);
  }
  return missed;
}

void PathSamples::set_depths(const RayGroup& group, const PathLanes& lanes, LaneMask seen) {
  if (lanes.whole) {
    choose_lanes(group.packet.far, image::kEmptyDepth, seen, samples_[lanes.block].depth);
    return;
  }
  for (LaneMask rest = seen; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    if (lanes.bounce[i] != 0) continue;
    const std::uint32_t pixel = lanes.pixel[i];
    samples_[pixel / kPacketRays].depth[static_cast<int>(pixel % kPacketRays)] =
        group.packet.far[i];
  }
}

}  // namespace delray::raytrace
