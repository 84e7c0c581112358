// Vertices of paths, sixteen at a time.
#pragma once

#include <cstdint>

#include "raytrace/integrators/dense_lanes.h"
#include "raytrace/sampling/bsdf.h"
#include "raytrace/sampling/light_table.h"
#include "raytrace/scene/ray_batch.h"
#include "shading/batch.h"

namespace delray::raytrace {

// In PathLanes::bounce.
inline constexpr std::uint32_t kDiffuse = 1U << 16;
inline int diffuse_bounces(std::uint32_t bounce) { return static_cast<int>(bounce / kDiffuse); }
inline int other_bounces(std::uint32_t bounce) { return static_cast<int>(bounce % kDiffuse); }

// State of the rays of a group beside their geometry.
struct PathLanes {
  bool whole = true;              // the primary rays of `block`: the rest is not set
  std::uint32_t block = 0;        // of samples()
  shading::Vectors16 throughput;  // what the sample makes of radiance along the ray
  shading::Floats16 pdf;          // with which the direction was drawn; 0: no other way finds it
  alignas(64) std::uint32_t pixel[kPacketRays];  // 16 * sample block + lane in it
  // Scatterings so far: diffuse ones times kDiffuse, and others.
  alignas(64) std::uint32_t bounce[kPacketRays];
  alignas(64) std::uint32_t vertex[kPacketRays];  // surfaces met so far, layers among them
  alignas(64) std::uint32_t instance[kPacketRays], triangle[kPacketRays];  // left behind

  std::uint32_t pixel_of(int i) const {
    return whole ? block * kPacketRays + static_cast<std::uint32_t>(i) : pixel[i];
  }
  bool is_primary(int i) const { return whole || bounce[i] == 0; }
  template <class Visitor>
  void visit(Visitor& to) {  // waiting_rays.h
    to.value(whole);
    to.value(block);
    if (whole) return;
    for (float* const field : {throughput.x.lane, throughput.y.lane, throughput.z.lane, pdf.lane})
      to.lanes(field);
    for (std::uint32_t* const field : {pixel, bounce, vertex, instance, triangle}) to.lanes(field);
  }
};

// State of shadow rays beside their geometry.
struct LightLanes {
  shading::Vectors16 reflected;  // what is added if all of the light arrives
  alignas(64) std::uint32_t pixel[kPacketRays];

  std::uint32_t pixel_of(int i) const { return pixel[i]; }
  template <class Visitor>
  void visit(Visitor& to) {
    for (float* const field : {reflected.x.lane, reflected.y.lane, reflected.z.lane})
      to.lanes(field);
    to.lanes(pixel);
  }
};

// Fields of rays that go on, in the order of path_fields and light_fields.
using ScatteredRays = DenseLanes<18>;
using LightRays = DenseLanes<11>;
std::array<float*, 18> path_fields(RayGroup& group, PathLanes& lanes);
std::array<float*, 11> light_fields(ShadowGroup& group, LightLanes& lanes);

// Surfaces that a group's rays met, with what was drawn there.
struct Vertices {
  const RayGroup& group;
  const PathLanes& lanes;
  const shading::Surfaces& surfaces;
};

// Lanes of `hits` whose surfaces emit light.
shading::LaneMask emissive_lanes(const shading::Surfaces& surfaces, shading::LaneMask hits);

// Multiplies radiance of the sky by the lanes' throughputs, and, where a light sample may find it
// as well, by the share of the scattered ray. `pdfs`: LightTable::pdf_of_sky.
void weigh_sky(const PathLanes& lanes, const shading::Floats16& pdfs, shading::Vectors16& radiance);

// Shadow rays from the surfaces of `mask` to lights that were drawn, with the surfaces' answers to
// them. Returns the lanes that ask; lane after lane they are put into `rays`.
shading::LaneMask rays_to_lights(const Vertices& vertices, const LightSamples& lights,
                                 const BsdfValues& values, shading::LaneMask mask, LightRays& rays);

// Rays from the surfaces of `mask` on their way. Paths that have scattered `certain` times end by
// chance, decided by `luck`.
void scattered_rays(const Vertices& vertices, const BsdfSamples& samples,
                    const shading::Floats16& luck, std::uint32_t certain, shading::LaneMask mask,
                    ScatteredRays& rays);

}  // namespace delray::raytrace
