// Whether a flip is possible depends on the tetrahedra around an edge as well, so that facets that
// were blocked are looked at again, in passes over all, until one changes nothing.
#include "delaunay/construction/flip_facets.h"

#include <array>

#include "delaunay/flip/flip_3d.h"
#include "delaunay/flip/reusing_access.h"
#include "delaunay/insertion/orientation_3d.h"

namespace delray::delaunay::internal {
namespace {

// Notes what was created.
class NotingReuse : public ReusingAccess {
 public:
  using ReusingAccess::ReusingAccess;

  SimplexNumber create(const std::array<VertexNumber, 4>& vertices) {
    made.push_back(ReusingAccess::create(vertices));
    return made.back();
  }

  std::vector<SimplexNumber> made;
};

class FacetFlipper {
 public:
  FacetFlipper(Mesh<3>& mesh, std::span<const glm::dvec3> points, SimplexNumber finite)
      : mesh_(mesh),
        points_(points),
        orientation_(points, corners(finite)),
        access_(mesh, static_cast<SimplexNumber>(mesh.size())),
        flips_(mesh, orientation_, access_, suspects_) {}

  FacetFlips run() {
    FacetFlips result;
    for (std::uint64_t before = 1; before != 0;) {
      before = result.flips.sum();
      result.blocked.clear();
      std::vector<CornerNumber> open = wrong_facets();
      while (!open.empty()) flip(open, result);
      before = result.flips.sum() - before;
    }
    result.blocked = wrong_facets();
    mesh_.shrink(access_.used());
    return result;
  }

 private:
  std::array<VertexNumber, 4> corners(SimplexNumber t) const {
    return {mesh_.vertex(t, 0), mesh_.vertex(t, 1), mesh_.vertex(t, 2), mesh_.vertex(t, 3)};
  }

  // The corner at one side of a facet, with a finite vertex.
  CornerNumber finite_side(CornerNumber corner) const {
    return mesh_.vertex(corner) != kInfiniteVertex ? corner : mesh_.neighbour(corner);
  }

  // The same from both sides.
  bool is_wrong(CornerNumber corner) const {
    const CornerNumber near = finite_side(corner);
    return conflict(mesh_, orientation_, simplex_of(mesh_.neighbour(near)),
                    points_[mesh_.vertex(near)]);
  }

  std::vector<CornerNumber> wrong_facets() const {
    std::vector<CornerNumber> wrong;
    for (SimplexNumber t = 0; t < access_.used(); ++t) {
      for (unsigned k = 0; k < 4 && !mesh_.is_dead(t); ++k) {
        const CornerNumber corner = corner_of(t, k);
        if (corner < mesh_.neighbour(corner) && is_wrong(corner)) wrong.push_back(corner);
      }
    }
    return wrong;
  }

  // What replaces the last of the open facets, if anything can, leaves others open.
  void flip(std::vector<CornerNumber>& open, FacetFlips& result) {
    const CornerNumber corner = open.back();
    open.pop_back();
    if (mesh_.is_dead(simplex_of(corner)) || !is_wrong(corner)) return;
    access_.made.clear();
    flips_.flip_facet(finite_side(corner));
    bool any_ghost = false;
    for (const SimplexNumber t : access_.made) {
      any_ghost = any_ghost || mesh_.is_ghost(t);
      for (unsigned k = 0; k < 4; ++k) open.push_back(corner_of(t, k));
    }
    if (access_.made.size() == 2) ++result.flips.three_two;
    if (access_.made.size() == 3) ++result.flips.two_three;
    if (access_.made.size() == 4) ++(any_ghost ? result.flips.two_two : result.flips.four_four);
  }

  Mesh<3>& mesh_;
  std::span<const glm::dvec3> points_;
  Orientation<3> orientation_;
  NotingReuse access_;
  std::vector<CornerNumber> suspects_;
  Flips3d<Mesh<3>, NotingReuse> flips_;
};

}  // namespace

FacetFlips flip_facets(Mesh<3>& mesh, std::span<const glm::dvec3> points) {
  SimplexNumber finite = 0;
  while (finite < mesh.size() && mesh.is_ghost(finite)) ++finite;
  if (finite == mesh.size()) return {};
  return FacetFlipper(mesh, points, finite).run();
}

}  // namespace delray::delaunay::internal
