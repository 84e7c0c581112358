// What the fuzz targets of the point and mesh readers have in common.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "delaunay/files/point_readers.h"

namespace delray::tests {

// Whatever the bytes, a reader returns finite points or throws FileError.
inline void fuzz_points(const std::uint8_t* data, std::size_t size,
                        delaunay::PointCloud (*read)(const delaunay::Input&)) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  try {
    const delaunay::PointCloud cloud = read({"fuzz", content});
    for (const glm::dvec3& p : cloud.positions) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) std::abort();
    }
    if (!cloud.colours.empty() && cloud.colours.size() != cloud.size()) std::abort();
    if (!cloud.intensity.empty() && cloud.intensity.size() != cloud.size()) std::abort();
  } catch (const files::FileError&) {
  }
}

// A mesh reader returns vertices in range besides.
inline void fuzz_mesh(const std::uint8_t* data, std::size_t size,
                      delaunay::PointMesh (*read)(const delaunay::Input&)) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  try {
    const delaunay::PointMesh mesh = read({"fuzz", content});
    for (const std::uint32_t vertex : mesh.triangulation.vertices) {
      if (vertex >= mesh.points.size()) std::abort();
    }
  } catch (const files::FileError&) {
  }
}

}  // namespace delray::tests
