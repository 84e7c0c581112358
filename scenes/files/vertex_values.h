// Coordinates, directions and colours as files give them, made fit for a mesh.
#pragma once

#include <atomic>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "parallel/parallel_for.h"
#include "scenes/files/source.h"
#include "scenes/files/text_lines.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// Null if all of `p` are finite and of at most kLargestCoordinate, else what is wrong.
const char* wrong_with(const glm::dvec3& p);

// The next words of a line as numbers; fails with the line's number unless there are N that
// wrong_with has nothing to say of.
template <int N>
glm::vec<N, double> read_coordinates(const Source& source, const Lines& lines, Words& words);

// Warns where coordinates that the file keeps in single precision reach so far from 0 that their
// steps show in a scene of this diagonal.
void warn_if_coarse(const Source& source, double reach, double diagonal);

// sRGB, as programs that write colours of vertices show them, from 0 to 1; alpha stays as it is.
// Values that are not finite become 0, or alpha 1.
glm::vec4 linear_colour(const glm::dvec4& srgb);

// Directions of unit length; all or none, as normals that are missing can be computed. Parallel.
template <class T>
void normalize_or_clear(std::vector<T>& directions) {
  constexpr std::size_t kBlock = 1 << 14;  // tens of microseconds
  std::atomic<bool> usable{true};
  parallel::parallel_blocks(0, directions.size(), kBlock, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      T& d = directions[i];
      const float length = glm::length(glm::vec3(d));
      if (!(length > 1e-6F) || !std::isfinite(length)) {
        usable.store(false, std::memory_order_relaxed);
        return;
      }
      // Normals of unit length keep their bits.
      if (std::abs(length - 1.0F) < 1e-6F) continue;
      for (int k = 0; k < 3; ++k) d[k] /= length;
    }
  });
  if (!usable) directions.clear();
}

// How points and lines look whose file does not say how large they are.
inline constexpr Shape kPointShape{Shape::Kind::point, true, 1.5F};
inline constexpr Shape kLineShape{Shape::Kind::line, true, 0.75F};

// The material of things that have none: grey, or white under the colours of vertices.
Material plain_material(bool has_colours);

// A scene of one mesh, relative to `origin`, with a plain material.
Scene scene_of(Mesh mesh, const glm::dvec3& origin);

}  // namespace delray::scenes::internal
