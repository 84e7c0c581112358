// Insertion and removal of points in a Delaunay triangulation, for the plane and for space.
//
// Rows with equal coordinates share a site; only the first row of a site inserts a vertex and only
// the last one removes it. A point is located by a walk from the nearest of about n^(1/3) random
// vertices (Muecke, Saias and Zhu 1999); DynamicMesh changes the mesh. Expected O(n^(1/3)) for the
// location of a point among evenly spread ones.
//
// Degenerate: while all sites lie on one line (3D: plane) there is no mesh, but up to D sites are
// known that span the line or plane. The first point outside starts the mesh from all sites, and a
// removal that makes the rest flat drops it again.
#include "delaunay/dynamic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "delaunay/dynamic/distinct_points.h"
#include "delaunay/dynamic/dynamic_mesh.h"
#include "delaunay/insertion/first_tetrahedron.h"
#include "delaunay/insertion/insertion_order.h"
#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/xorshift.h"
#include "delaunay/predicates.h"

namespace delray::delaunay {
namespace {

constexpr SimplexNumber kNotInserted = kDeadVertex;

// A mesh has at most 2 triangles, and as a rule less than 7 tetrahedra, to a point.
template <int D>
constexpr std::size_t kMaximumRows = kMaximumSimplices / (D == 2 ? 2 : 8);

// Whether a point is outside what the frame, up to D points of which that holds, spans.
bool is_independent(std::span<const glm::dvec2> frame, const glm::dvec2& q) {
  return frame.size() < 2 || orient2d(frame[0], frame[1], q) != 0;
}
bool is_independent(std::span<const glm::dvec3> frame, const glm::dvec3& q) {
  if (frame.size() == 3) return orient3d(frame[0], frame[1], frame[2], q) != 0;
  return frame.size() < 2 || !internal::are_collinear(frame[0], frame[1], q);
}

bool is_positive(const std::array<glm::dvec2, 3>& p) { return orient2d(p[0], p[1], p[2]) > 0; }
bool is_positive(const std::array<glm::dvec3, 4>& p) {
  return orient3d(p[0], p[1], p[2], p[3]) > 0;
}

}  // namespace

template <int D>
struct DynamicTriangulation<D>::State {
  internal::DistinctPoints<D> sites;
  // Per site: a simplex that once had it; kNotInserted as long as it is to be inserted.
  std::vector<SimplexNumber> near;

  // While all sites are on one line (3D: plane) there is no mesh, but sites that span what they
  // are on: none if they have to be found again.
  bool meshed = false;
  std::vector<std::uint32_t> frame;
  internal::DynamicMesh<D> mesh;
  SimplexNumber last = 0;  // a live simplex
  std::uint32_t random = 1;

  const Point& at(std::uint32_t site) const { return sites.positions()[site]; }

  // With -0 made equal to 0 in every bit.
  static Point checked(Point point, std::size_t row) {
    if (row >= kMaximumRows<D>) throw std::invalid_argument("too many points");
    for (int k = 0; k < D; ++k) {
      if (!std::isfinite(point[k])) {
        throw std::invalid_argument("row " + std::to_string(row) +
                                    " has a coordinate that is not finite");
      }
      point[k] += 0.0;
    }
    return point;
  }

  // Whether the site is new.
  bool add_row(const Point& point) {
    const auto [site, is_new] = sites.add(point);
    near.resize(sites.size());
    if (is_new) near[site] = kNotInserted;
    return is_new;
  }

  SimplexNumber start_near(const Point& q) {
    const auto distance = [&](const Point& p) { return glm::dot(p - q, p - q); };
    SimplexNumber best = last;
    double least = std::numeric_limits<double>::infinity();
    for (unsigned k = 0; k <= D; ++k) {
      const VertexNumber vertex = mesh.mesh().vertex(corner_of(last, k));
      if (vertex != kInfiniteVertex) least = std::min(least, distance(at(vertex)));
    }
    const auto sites_end = static_cast<std::uint32_t>(sites.size());
    auto samples = static_cast<std::size_t>(std::cbrt(static_cast<double>(sites_end)));
    for (; samples > 0; --samples) {
      const std::uint32_t site = internal::next_random(random) % sites_end;
      const SimplexNumber simplex = near[site];
      if (!sites.is_used(site) || simplex >= mesh.used() || mesh.mesh().is_dead(simplex)) continue;
      if (const double d = distance(at(site)); d < least) {
        least = d;
        best = simplex;
      }
    }
    return best;
  }

  void insert_site(std::uint32_t site) {
    last = mesh.insert(sites.positions(), site, start_near(at(site)));
    near[site] = last;
  }

  bool is_independent_of_frame(std::uint32_t site) const {
    std::array<Point, D> points{};
    for (std::size_t i = 0; i < frame.size(); ++i) points[i] = at(frame[i]);
    return is_independent(std::span<const Point>(points.data(), frame.size()), at(site));
  }

  template <class F>
  void each_inserted(F&& f) const {
    for (std::uint32_t site = 0; site < sites.size(); ++site) {
      if (sites.is_used(site) && near[site] != kNotInserted) f(site);
    }
  }

  void start_mesh() {
    std::array<VertexNumber, D + 1> simplex;
    std::array<Point, D + 1> points;
    std::ranges::copy(frame, simplex.begin());
    for (std::size_t k = 0; k <= D; ++k) points[k] = at(simplex[k]);
    if (!is_positive(points)) std::swap(simplex[0], simplex[1]);
    mesh.start(simplex);
    meshed = true;
    last = 0;
    each_inserted([&](std::uint32_t site) {
      if (std::ranges::find(simplex, site) == simplex.end()) {
        insert_site(site);
      } else {
        near[site] = 0;
      }
    });
    frame.clear();
  }

  void add_site(std::uint32_t site) {
    if (meshed) {
      insert_site(site);
      return;
    }
    if (frame.empty()) {
      each_inserted([&](std::uint32_t other) {
        if (frame.size() < D && is_independent_of_frame(other)) frame.push_back(other);
      });
    }
    near[site] = 0;
    if (!is_independent_of_frame(site)) return;
    frame.push_back(site);
    if (frame.size() == D + 1) start_mesh();
  }

  // Removes a site of which no row is left.
  void remove_site(std::uint32_t site) {
    if (!meshed) {
      if (std::ranges::find(frame, site) != frame.end()) frame.clear();
      return;
    }
    const auto found = mesh.remove(sites.positions(), site, start_near(at(site)), sites.distinct());
    if (!found) {
      meshed = false;
      return;
    }
    last = *found;
    for (const VertexNumber vertex : mesh.link()) near[vertex] = last;
  }
};

template <int D>
DynamicTriangulation<D>::DynamicTriangulation() : state_(std::make_unique<State>()) {}
template <int D>
DynamicTriangulation<D>::~DynamicTriangulation() = default;
template <int D>
DynamicTriangulation<D>::DynamicTriangulation(DynamicTriangulation&& other) noexcept = default;
template <int D>
DynamicTriangulation<D>& DynamicTriangulation<D>::operator=(DynamicTriangulation&& other) noexcept =
    default;

template <int D>
std::size_t DynamicTriangulation<D>::size() const {
  return state_->sites.live_rows();
}

template <int D>
bool DynamicTriangulation<D>::is_live(std::uint32_t row) const {
  return state_->sites.is_live(row);
}

template <int D>
std::uint32_t DynamicTriangulation<D>::insert(const Point& point) {
  const auto row = static_cast<std::uint32_t>(state_->sites.rows());
  const bool is_new = state_->add_row(State::checked(point, row));
  if (is_new) state_->add_site(state_->sites.site_of(row));
  return row;
}

template <int D>
std::uint32_t DynamicTriangulation<D>::insert(PointView<double> points) {
  internal::check_view(points, D);
  const std::size_t first = state_->sites.rows();
  std::vector<Point> batch(points.size());
  for (std::size_t i = 0; i < batch.size(); ++i) {
    for (int k = 0; k < D; ++k) batch[i][k] = points(i, k);
    batch[i] = State::checked(batch[i], first + i);
  }
  std::vector<bool> is_new(batch.size());
  for (std::size_t i = 0; i < batch.size(); ++i) is_new[i] = state_->add_row(batch[i]);
  state_->mesh.reserve_vertices(batch.size());
  for (const std::uint32_t i : insertion_order(std::span<const Point>(batch), "brio", 1)) {
    const auto row = static_cast<std::uint32_t>(first) + i;
    if (is_new[i]) state_->add_site(state_->sites.site_of(row));
  }
  return static_cast<std::uint32_t>(first);
}

template <int D>
bool DynamicTriangulation<D>::remove(std::uint32_t row) {
  if (!is_live(row)) return false;
  const std::uint32_t site = state_->sites.site_of(row);
  if (state_->sites.remove(row)) state_->remove_site(site);
  return true;
}

template <int D>
Triangulation DynamicTriangulation<D>::triangulation() const {
  Triangulation result;
  result.dim = D;
  result.distinct = state_->sites.distinct();
  if (!state_->meshed) return result;
  const Mesh<D>& mesh = state_->mesh.mesh();
  for (SimplexNumber t = 0; t < state_->mesh.used(); ++t) {
    if (mesh.is_dead(t)) continue;
    if (mesh.is_ghost(t)) {
      ++result.hull_facets;
      continue;
    }
    for (unsigned k = 0; k <= D; ++k) {
      result.vertices.push_back(state_->sites.lowest_row(mesh.vertex(corner_of(t, k))));
    }
  }
  return result;
}

template class DynamicTriangulation<2>;
template class DynamicTriangulation<3>;

}  // namespace delray::delaunay
