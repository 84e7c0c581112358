// LAS, LAZ and COPC in memory: all of their parts.
#include "delaunay/files/parts/las_parts.h"
#include "delaunay/files/point_readers.h"

namespace delray::delaunay {

PointCloud read_las_points(const Input& input) {
  return read_all(LasParts(ByteSource(input), {}), {}, input.memory);
}

}  // namespace delray::delaunay
