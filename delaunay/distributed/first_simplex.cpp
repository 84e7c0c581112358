// Each rank offers a point that is independent of those that were chosen, and the lowest rank that
// has one wins, until there are enough.
#include "delaunay/distributed/first_simplex.h"

#include <utility>

#include "comm/collectives.h"
#include "delaunay/insertion/first_tetrahedron.h"
#include "delaunay/predicates.h"

namespace delray::delaunay {
namespace {

// Whether a point lies in the flat through those before it.
bool lies_in_flat(std::span<const RowPoint> chosen, const glm::dvec2& p) {
  switch (chosen.size()) {
    case 0:
      return false;
    case 1:
      return glm::dvec2(chosen[0].position) == p;
    default:
      return orient2d(glm::dvec2(chosen[0].position), glm::dvec2(chosen[1].position), p) == 0;
  }
}

bool lies_in_flat(std::span<const RowPoint> chosen, const glm::dvec3& p) {
  switch (chosen.size()) {
    case 0:
      return false;
    case 1:
      return chosen[0].position == p;
    case 2:
      return internal::are_collinear(chosen[0].position, chosen[1].position, p);
    default:
      return orient3d(chosen[0].position, chosen[1].position, chosen[2].position, p) == 0;
  }
}

}  // namespace

template <int D>
std::optional<FirstSimplex<D>> find_first_simplex(comm::Communicator& communicator,
                                                  std::span<const RowPoint> points) {
  std::vector<RowPoint> chosen;
  while (chosen.size() <= D) {
    std::size_t i = 0;
    while (i < points.size() && lies_in_flat(chosen, Position<D>(points[i].position))) ++i;
    const auto own = i < points.size() ? points.subspan(i, 1) : std::span<const RowPoint>();
    const std::size_t before = chosen.size();
    for (const comm::Buffer& offer : comm::all_gather(communicator, comm::Buffer::of(own))) {
      if (chosen.size() == before && !offer.empty()) chosen.push_back(offer.as<RowPoint>()[0]);
    }
    if (chosen.size() == before) return std::nullopt;
  }
  FirstSimplex<D> result;
  std::copy(chosen.begin(), chosen.end(), result.begin());
  Node<D> node;
  node.corners = result;
  // The last corner in its own place.
  const unsigned facet = facet_towards<D>(node, result[D].position, D);
  if (facet <= D) std::swap(result[0], result[1]);
  return result;
}

template std::optional<FirstSimplex<2>> find_first_simplex<2>(comm::Communicator&,
                                                              std::span<const RowPoint>);
template std::optional<FirstSimplex<3>> find_first_simplex<3>(comm::Communicator&,
                                                              std::span<const RowPoint>);

}  // namespace delray::delaunay
