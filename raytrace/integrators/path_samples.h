// The samples of a task, as paths add to them.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/integrators/path_vertices.h"
#include "raytrace/integrators/wavefront_integrator.h"

namespace delray::raytrace {

// Adds to the samples of blocks, which are the integrator's.
class PathSamples {
 public:
  // REQUIRES: `samples` outlives it.
  explicit PathSamples(std::vector<SampleBlock>& samples) : samples_(samples) {}

  // `pixel` as in PathLanes. Radiance that is not finite is dropped.
  void add(std::uint32_t pixel, const glm::vec3& radiance);
  // Adds the lanes in `mask`, each to its pixel.
  void add(const shading::Vectors16& radiance, const PathLanes& lanes, shading::LaneMask mask);
  // Adds the light that shadow rays have let through.
  void add_light(const ShadowGroup& group, const LightLanes& lanes);

  // Makes pixels of which a ray of the camera is in `missed` transparent. Returns the other lanes.
  shading::LaneMask make_transparent(const PathLanes& lanes, shading::LaneMask missed);
  // Takes the depths of rays of the camera that are in `seen`, which have met a surface.
  void set_depths(const RayGroup& group, const PathLanes& lanes, shading::LaneMask seen);

 private:
  std::vector<SampleBlock>& samples_;
};

}  // namespace delray::raytrace
