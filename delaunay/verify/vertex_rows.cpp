// Marks rows of vertices, sums hashes of rows and places, and looks up points that are no vertices
// among the places of those that are. Only what is wrong is searched for, to name it.
#include "delaunay/verify/vertex_rows.h"

namespace delray::delaunay::internal {
namespace {

std::string place_text(const glm::dvec3& p, int dim) {
  std::string text = "(";
  for (int k = 0; k < dim; ++k) {
    std::array<char, 32> digits{};
    std::snprintf(digits.data(), digits.size(), "%.17g", p[k]);
    text += (k == 0 ? "" : ", ") + std::string(digits.data());
  }
  return text + ")";
}

// The first D + 1 points that are not flat, as far as there are such.
template <int D>
class FlatFrame {
 public:
  using Point = glm::vec<D, double>;
  void add(const RowPoint& point) {
    const auto at = [&](std::size_t i) { return Point(frame_[i].position); };
    const Point p(point.position);
    bool independent = frame_.empty();
    if (frame_.size() == 1) independent = p != at(0);
    if (frame_.size() == 2) independent = !collinear(at(0), at(1), p);
    if constexpr (D == 3) {
      if (frame_.size() == 3) independent = orient3d(at(0), at(1), at(2), p) != 0;
    }
    if (independent && frame_.size() <= D) frame_.push_back(point);
  }
  const std::vector<RowPoint>& get() const { return frame_; }

 private:
  std::vector<RowPoint> frame_;
};

}  // namespace

template <int D>
std::uint64_t VertexRows<D>::most_rows(const PointParts& points) {
  std::uint64_t rows = 0;
  for (std::size_t part = 0; part < points.parts(); ++part) rows += points.most_rows(part);
  return rows;
}

template <int D>
VertexRows<D>::VertexRows(const PieceSource& pieces, const PointParts& points,
                          const std::string& name, const files::MemoryBudget& memory)
    : pieces_(pieces),
      points_(points),
      name_(name),
      memory_(memory),
      rows_(most_rows(points)),
      marks_((memory.require(rows_ / 8, name, "a bit for each row"), rows_)),
      places_(rows_, 0, D),
      heights_(rows_, 2, 1) {}

// How a vertex of a piece is met: on no facet without a mate, or on some.
template <int D>
std::vector<std::uint8_t> VertexRows<D>::kinds_of_vertices(const VerifiedMesh<D>& mesh) {
  std::vector<std::uint8_t> kinds(mesh.points.size(), kUnused);
  for (const std::uint32_t v : mesh.vertices) kinds[v] = kInner;
  for (std::size_t facet = 0; facet < mesh.vertices.size(); ++facet) {
    if (mesh.facets.mates[facet] != FacetMates::kNone) continue;
    for (const std::uint32_t v : mesh.outward(facet)) kinds[v] = kBorder;
  }
  return kinds;
}

template <int D>
PieceSimplex VertexRows<D>::simplex_with(std::uint32_t piece, const VerifiedMesh<D>& mesh,
                                         std::size_t vertex) {
  const auto at = std::ranges::find(mesh.vertices, static_cast<std::uint32_t>(vertex));
  return {piece, static_cast<std::uint32_t>((at - mesh.vertices.begin()) / (D + 1))};
}

template <int D>
void VertexRows<D>::add_pair(const RowPoint& point) {
  places_.add_mesh(point);
  if constexpr (D == 2) {
    heights_.add_mesh(point);
    if (point.position.z != 0) mesh_has_heights_.store(true, std::memory_order_relaxed);
  }
}

template <int D>
bool VertexRows<D>::add(std::uint32_t piece, const VerifiedMesh<D>& mesh,
                        std::span<const RowPoint> points, Findings& findings) {
  const std::size_t unknown = find_first(
      mesh.vertices.size(), [&](std::size_t i) { return points[mesh.vertices[i]].row >= rows_; });
  if (unknown != kAll) {
    return findings.refuse(PieceSimplex{piece, static_cast<std::uint32_t>(unknown / (D + 1))},
                           mesh.row(mesh.vertices[unknown]) + " is not a row of the points");
  }
  const std::vector<std::uint8_t> kinds = kinds_of_vertices(mesh);
  std::size_t doubled = find_first(kinds.size(), [&](std::size_t i) {
    if (kinds[i] != kInner) return false;
    if (!marks_.mark(points[i].row)) return true;
    add_pair(points[i]);
    return false;
  });
  for (std::size_t i = 0; i < kinds.size() && doubled == kAll; ++i) {
    if (kinds[i] != kBorder) continue;
    const RowPoint& point = points[i];
    const auto known = border_.add(without_signed_zeros<D>(mesh.at(i)), point.row);
    if (known.first != point.row) {
      Findings::note(findings.not_canonical, simplex_with(piece, mesh, i),
                     internal::row(point.row) + " is where " + internal::row(known.first) +
                         " is a vertex of another piece");
    }
    if (!known.is_new) continue;
    memory_.require(BorderVertices<D>::kBytes, name_, "borders of pieces");
    if (marks_.mark(point.row)) {
      add_pair(point);
    } else {
      doubled = i;
    }
  }
  if (doubled == kAll) return true;
  return findings.refuse(
      simplex_with(piece, mesh, doubled),
      mesh.row(doubled) + " is a vertex at another place too, or of simplices that this does not " +
          "meet");
}

// Calls f(point, whether it has a height) for all points in the order of rows.
template <int D>
template <class F>
void VertexRows<D>::for_points(F&& f) const {
  PointCloud part;
  std::uint64_t row = 0;
  for (std::size_t i = 0; i < points_.parts(); ++i) {
    points_.read(i, part);
    for (const glm::dvec3& position : part.positions) f(RowPoint{position, row++}, part.has_z);
  }
}

// Calls f(found) for each corner of each simplex, until it returns true.
template <int D>
template <class F>
void VertexRows<D>::for_vertices(F&& f) const {
  PieceMesh mesh;
  for (std::size_t piece = 0; piece < pieces_.pieces; ++piece) {
    pieces_.read(piece, mesh);
    for (std::size_t i = 0; i < mesh.simplices.size(); ++i) {
      const PieceSimplex of{static_cast<std::uint32_t>(piece),
                            static_cast<std::uint32_t>(i / (D + 1))};
      if (f(Found{mesh.points[mesh.simplices[i]], of})) return;
    }
  }
}

template <int D>
bool VertexRows<D>::check_points(PiecesVerdict& verdict, Findings& findings) {
  constexpr std::uint64_t kBytesOfUnused = 160;
  constexpr std::uint64_t kAlways = 4096;
  const std::uint64_t most = std::max(memory_.left() / 4 / kBytesOfUnused, kAlways);
  std::vector<RowPoint> unused;  // the first of those that are no vertices
  std::uint64_t all_unused = 0;
  for_points([&](const RowPoint& point, bool has_z) {
    ++verdict.points;
    points_have_heights_ |= has_z && point.position.z != 0;
    if (!marks_.is_marked(point.row)) {
      if (++all_unused <= most) unused.push_back(point);
      return;
    }
    ++verdict.distinct;
    places_.add_points(point);
    if constexpr (D == 2) heights_.add_points(point);
  });
  if (const auto extra = marks_.next(verdict.points)) {
    std::optional<PieceSimplex> of;
    for_vertices([&](const Found& found) {
      if (found.vertex.row == *extra) of = found.of;
      return of.has_value();
    });
    return findings.refuse(of, internal::row(*extra) + " is not a row of the points");
  }
  if (const auto range = places_.first_difference()) {
    std::string reason = "vertices are not the points of their rows";
    const auto found = find_different(*range, D, reason);
    return findings.refuse(found ? std::optional(found->of) : std::nullopt, reason);
  }
  if (!check_unused(unused, findings)) return false;
  for (std::uint64_t done = unused.size(); done < all_unused; done += unused.size()) {
    unused.clear();
    std::uint64_t seen = 0;
    for_points([&](const RowPoint& point, bool) {
      if (!marks_.is_marked(point.row) && seen++ >= done && unused.size() < most) {
        unused.push_back(point);
      }
    });
    if (!check_unused(unused, findings)) return false;
  }
  if constexpr (D == 2) compare_heights(verdict);
  return true;
}

// Each has to be where a vertex of a lower row is.
template <int D>
bool VertexRows<D>::check_unused(const std::vector<RowPoint>& unused, Findings& findings) {
  if (unused.empty()) return true;
  struct Lowest {
    std::uint64_t row;
    bool found;
  };
  std::unordered_map<Point, Lowest, PlaceHash<D>> lowest;  // the first is the lowest
  for (const RowPoint& point : unused) {
    lowest.try_emplace(without_signed_zeros<D>(Point(point.position)), Lowest{point.row, false});
  }
  for_vertices([&](const Found& found) {
    const auto at = lowest.find(without_signed_zeros<D>(Point(found.vertex.position)));
    if (at == lowest.end()) return false;
    at->second.found = true;
    if (at->second.row < found.vertex.row) {
      Findings::note(findings.not_canonical, found.of,
                     internal::row(found.vertex.row) + " is a vertex, but equals " +
                         internal::row(at->second.row));
    }
    return false;
  });
  std::uint64_t first = rows_;
  for (const auto& [place, point] : lowest) {
    if (!point.found) first = std::min(first, point.row);
  }
  if (first == rows_) return true;
  return findings.refuse({}, internal::row(first) + " is in no " + Words<D>::simplex);
}

// The first vertex with a row of the range that is not where its point is in the first `compared`
// coordinates; `reason` becomes a sentence about it.
template <int D>
auto VertexRows<D>::find_different(const Range& range, int compared, std::string& reason)
    -> std::optional<Found> {
  std::vector<glm::dvec3> positions;
  for_points([&](const RowPoint& point, bool) {
    if (point.row >= range.first && point.row < range.last) positions.push_back(point.position);
  });
  std::optional<Found> different;
  for_vertices([&](const Found& found) {
    const RowPoint& vertex = found.vertex;
    if (vertex.row < range.first || vertex.row >= range.last) return false;
    const glm::dvec3& point = positions[vertex.row - range.first];
    bool equal = true;
    for (int k = 0; k < compared; ++k) equal = equal && vertex.position[k] == point[k];
    if (equal) return false;
    different = found;
    reason = internal::row(vertex.row) + " is at " + place_text(vertex.position, compared) +
             " in the mesh, at " + place_text(point, compared) + " in the points";
    return true;
  });
  return different;
}

template <int D>
void VertexRows<D>::compare_heights(PiecesVerdict& verdict) {
  if (!points_have_heights_ || !mesh_has_heights_) return;
  verdict.heights = "equal";
  if (const auto range = heights_.first_difference()) {
    verdict.heights = "different";
    find_different(*range, 3, verdict.other_height);
  }
}

template <int D>
bool VertexRows<D>::check_flat(PiecesVerdict& verdict, Findings& findings) {
  FlatFrame<D> flat;
  for_points([&](const RowPoint& point, bool) {
    ++verdict.points;
    flat.add(point);
  });
  if (flat.get().size() <= D) return true;
  std::string rows;
  for (std::size_t k = 0; k <= D; ++k) {
    rows += (k == 0 ? "" : k < D ? ", " : " and ") + std::to_string(flat.get()[k].row);
  }
  return findings.refuse({}, std::string("there are no ") + Words<D>::simplices + ", but rows " +
                                 rows + " are not " + Words<D>::flat);
}

template class VertexRows<2>;
template class VertexRows<3>;

}  // namespace delray::delaunay::internal
