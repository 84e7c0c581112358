// PCD in memory: all of its parts.
#include "delaunay/files/parts/pcd_parts.h"
#include "delaunay/files/point_readers.h"

namespace delray::delaunay {

PointCloud read_pcd_points(const Input& input) {
  return read_all(PcdParts(ByteSource(input)), {}, input.memory);
}

}  // namespace delray::delaunay
