// Resolves the options, checks the input, runs the method of the table and completes what it leaves
// to its caller.
#include "delaunay/triangulate.h"

#include <stdexcept>

#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/methods.h"

namespace delray::delaunay {

Triangulation triangulate(PointView<double> points, const Options& options) {
  const Options resolved = resolve(options);
  internal::check_view(points, resolved.dim);
  if (points.size() > kMaximumSimplices / 2) {
    throw std::invalid_argument("more than 2^29 points");
  }
  if (resolved.statistics != nullptr) *resolved.statistics = {};
  if (resolved.progress != nullptr) resolved.progress->start(points.size());
  if (resolved.created_by == nullptr) return method_of(resolved).triangulate(points, resolved);
  resolved.created_by->clear();
  Triangulation result = method_of(resolved).triangulate(points, resolved);
  // A thread that was alone leaves that to be said here.
  resolved.created_by->resize(result.size(), 0);
  return result;
}

}  // namespace delray::delaunay
