// Resolves the options, checks the input, runs the method of the table and completes what it leaves
// to its caller.
#include "delaunay/triangulate.h"

#include <stdexcept>

#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/methods.h"

namespace delray::delaunay {

Result triangulate(PointView<double> points, const Options& options) {
  const Options resolved = resolve(options);
  internal::check_view(points, resolved.dim);
  if (points.size() > kMaximumSimplices / 2) {
    throw std::invalid_argument("more than 2^29 points");
  }
  if (resolved.progress != nullptr) resolved.progress->start(points.size());
  Result result = method_of(resolved).triangulate(points, resolved);
  if (!resolved.statistics) result.statistics = {};
  // Methods leave it empty where one thread made everything.
  if (resolved.created_by) result.created_by.resize(result.triangulation.size(), 0);
  return result;
}

}  // namespace delray::delaunay
