#include "delaunay/triangulate.h"

#include <stdexcept>

#include "delaunay/mesh.h"
#include "delaunay/methods.h"

namespace delray::delaunay {

Triangulation triangulate(PointView<double> points, const Options& options) {
  const Options resolved = resolve(options);
  if (points.size() > kMaximumSimplices / 2) {
    throw std::invalid_argument("more than 2^29 points");
  }
  if (resolved.statistics != nullptr) *resolved.statistics = {};
  if (resolved.progress != nullptr) resolved.progress->start(points.size());
  return method_of(resolved).triangulate(points, resolved);
}

}  // namespace delray::delaunay
