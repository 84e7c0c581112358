// Ruppert's refinement by one thread that is alone with the mesh: pieces of segments before
// triangles, the worst triangle first.
#include <stdexcept>

#include "delaunay/refinement/refinement_runs.h"
#include "delaunay/refinement/refiner.h"

namespace delray::delaunay::internal {
namespace {

class SoleAccess {
 public:
  SoleAccess(RefinementMesh& mesh, const RefinementLimits& limits)
      : mesh_(&mesh), limits_(&limits) {}

  static bool acquire(SimplexNumber) { return true; }
  static bool claim() { return true; }
  static bool keeps(SimplexNumber) { return true; }
  static void release() {}
  bool prepare() {
    mesh_->reserve(1);
    return true;
  }
  VertexNumber vertex() {
    if (mesh_->vertices >= limits_->most_vertices) {
      throw std::length_error(too_many_points(limits_->most_vertices));
    }
    if (limits_->progress != nullptr) limits_->progress->advance();
    return mesh_->vertices++;
  }
  SimplexNumber triangle() { return mesh_->triangles++; }

 private:
  RefinementMesh* mesh_;
  const RefinementLimits* limits_;
};

}  // namespace

void refine_alone_until(RefinementMesh& mesh, const TriangleBounds& bounds,
                        const RefinementLimits& limits, SimplexNumber triangles,
                        RefineCounts& counts) {
  Refiner<SoleAccess> refiner(mesh, bounds, SoleAccess(mesh, limits));
  suspect_all(mesh, refiner, 0, mesh.triangles);
  while (mesh.triangles < triangles && refiner.step()) {
  }
  counts.on_segments += refiner.counts().on_segments;
  counts.inside += refiner.counts().inside;
  counts.too_fine += refiner.counts().too_fine;
}

void refine_alone(RefinementMesh& mesh, const TriangleBounds& bounds,
                  const RefinementLimits& limits, RefineCounts& counts) {
  refine_alone_until(mesh, bounds, limits, kMaximumSimplices, counts);
}

}  // namespace delray::delaunay::internal
