// Hits of many groups put side by side, material by material, so that what is shaded at a time is
// full and of one material, or of few.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/integrators/path_vertices.h"
#include "raytrace/scene/ray_batch.h"

namespace delray::raytrace {

// Lists of hits, one for each material. A hit is 16 * group + lane. Nothing but the order in which
// they are given decides the order in which they come out.
class HitsByMaterial {
 public:
  // Numbers are 0 to materials - 1.
  explicit HitsByMaterial(std::size_t materials) : runs_of_(materials, Runs{kEnd, kEnd}) {}

  void add(std::uint32_t material, std::uint32_t group, shading::LaneMask lanes);

  // All hits that were added, those of a material one after the other; forgets them.
  std::span<const std::uint32_t> take();

 private:
  static constexpr std::uint32_t kEnd = 0xFFFFFFFFU;
  struct Runs {
    std::uint32_t first, last;
  };
  struct Run {
    std::uint32_t group;
    shading::LaneMask lanes;
    std::uint32_t next;
  };
  std::vector<Runs> runs_of_;             // by material
  std::vector<std::uint32_t> materials_;  // that have runs
  std::vector<Run> runs_;
  std::vector<std::uint32_t> hits_;
};

// Lane i of `group` and `lanes` becomes what hit i of `hits` is of, as far as a path tracer looks
// at surfaces: points, their materials, views and cones, distances, and PathLanes but for the layer
// left behind. Lanes beyond repeat the first one. Colours of vertices are taken if the groups of
// all hits have them, what textures of so many sets are looked up with. REQUIRES: 1 to 16 hits.
void gather_hits(const Groups<RayGroup>& groups, const Groups<PathLanes>& path_lanes,
                 std::span<const std::uint32_t> hits, bool coloured, int texture_sets,
                 RayGroup& group, PathLanes& lanes);

}  // namespace delray::raytrace
