// Verification of a mesh in pieces, one after the other.
//
// A piece is checked by itself as a whole mesh is: orientation, at most two simplices at a facet
// and on opposite sides, empty balls across its inner facets. A facet that has no mate in its piece
// waits in a table until a piece brings one of the same places with its simplex on the other side;
// then the balls of the two are checked, and both are forgotten. What is left in the end is the
// boundary, and must be one convex polygon or polyhedron (check_hull()). Rows are marked when they
// become vertices, and sums of hashes show that the vertices are the points of their rows.
//
// Why that is enough.
//
// 1. Simplices cover the hull of the vertices exactly once. Take the sum of the oriented boundaries
//    of all simplices: two facets that are matched, in a piece or between pieces, have the same
//    places and opposite orientations, so they cancel, whichever are matched with which. What is
//    left is the boundary of the sum of all simplices. How many simplices lie over a place in
//    general position is the winding number of that around it, as all are positively oriented
//    (Mehlhorn et al. 1999); for a convex boundary that is passed once it is one within and none
//    outside. A simplex that is missing, doubled or overlaps others changes that number somewhere,
//    and with it what is left. Facets are matched by places, not by rows: copies of a vertex in
//    several pieces that differ are vertices of facets that find no mates.
// 2. A vertex in a simplex, or in a facet or edge of one that it is no corner of, would lie under
// its
//    own star and under that simplex: a place near it would be covered twice. So simplices meet in
//    common faces: they are a triangulation.
// 3. Every distinct point is a vertex: its row is marked, or it lies where a vertex does.
// 4. A triangulation of all points is Delaunay if across each inner facet the opposite corner is
// not
//    in the ball (Delaunay 1934).
// 5. Ties: the canonical triangulation is the regular one of heights x^2 + infinitesimal
//    perturbations that depend on the order of places alone (conflict.h), no D + 2 of which are
//    degenerate. A triangulation of all points that is locally regular at each inner facet is the
//    regular one: its lifting is a function that is convex across each facet, hence convex, and
//    there is one such with all points as vertices. Local regularity at a facet is what
//    counts_as_inside() decides; nothing about it needs the rest of the mesh. Facets of flat
//    simplices cannot occur: the perturbation moves heights alone.
// 6. A row is at one place: within a piece vertices are at distinct places and have distinct rows;
// a
//    vertex whose facets are all matched in its piece has its star there, so that its row may be
//    marked once only; of those on borders a table knows the rows. Each pair of row and place is
//    summed once, and so is that of each point whose row is marked: by row_fingerprints.h the two
//    sets are the same.
#include "delaunay/verify_pieces.h"

#include <algorithm>
#include <exception>
#include <thread>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/equal_points.h"
#include "delaunay/verify/piece_borders.h"
#include "delaunay/verify/vertex_rows.h"

namespace delray::delaunay {
namespace {

using internal::BorderFacet;
using internal::find_first;
using internal::Findings;
using internal::kAll;
using internal::Objection;
using internal::PieceSimplex;
using internal::VerifiedMesh;
using internal::Words;

// The pieces in their order, of which the next is read while one is looked at.
class PiecesAhead {
 public:
  explicit PiecesAhead(const PieceSource& source) : source_(source) { start(0); }
  // The next piece, until the next call.
  const PieceMesh& next() {
    reader_.join();
    if (error_) std::rethrow_exception(error_);
    std::swap(current_, coming_);
    start(at_ + 1);
    return current_;
  }

 private:
  void start(std::size_t piece) {
    at_ = piece;
    reader_ = std::jthread([this, piece] {
      try {
        if (piece < source_.pieces) source_.read(piece, coming_);
      } catch (...) {
        error_ = std::current_exception();
      }
    });
  }
  const PieceSource& source_;
  std::size_t at_ = 0;
  PieceMesh current_, coming_;
  std::exception_ptr error_;
  std::jthread reader_;  // ends before what it uses
};

template <int D>
class PiecesVerifier {
 public:
  using Point = glm::vec<D, double>;

  PiecesVerifier(const PieceSource& pieces, const PointParts& points, const std::string& name,
                 const files::MemoryBudget& memory)
      : pieces_(pieces), name_(name), memory_(memory), rows_(pieces, points, name, memory) {}

  PiecesVerdict run() {
    verdict_.valid = check();
    verdict_.delaunay = verdict_.valid && !findings_.not_delaunay;
    verdict_.canonical = verdict_.delaunay && !findings_.not_canonical;
    const auto& objection = !verdict_.valid      ? findings_.invalid
                            : !verdict_.delaunay ? findings_.not_delaunay
                                                 : findings_.not_canonical;
    if (objection) {
      verdict_.reason = objection->reason;
      if (objection->of) {
        verdict_.piece = objection->of->piece;
        verdict_.simplex = objection->of->simplex;
      }
    }
    return std::move(verdict_);
  }

 private:
  // The table of contents. False as soon as the mesh is no triangulation of the points.
  bool check() {
    PiecesAhead ahead(pieces_);
    for (std::size_t piece = 0; piece < pieces_.pieces; ++piece) {
      if (!check_piece(static_cast<std::uint32_t>(piece), ahead.next())) return false;
    }
    if (verdict_.simplices == 0) return rows_.check_flat(verdict_, findings_);
    return check_boundary() && rows_.check_points(verdict_, findings_);
  }

  bool passes(std::uint32_t piece, const internal::Check& check) {
    if (!check) return true;
    std::optional<PieceSimplex> of;
    if (check->simplex != kAll)
      of = PieceSimplex{piece, static_cast<std::uint32_t>(check->simplex)};
    return findings_.refuse(of, check->reason);
  }
  void note_tie(PieceSimplex of, const std::string& row) {
    Findings::note(findings_.not_canonical, of,
                   row + " is on its " + Words<D>::ball + " and counts as inside");
  }
  void note_inside(PieceSimplex of, const std::string& row) {
    Findings::note(findings_.not_delaunay, of, row + " is inside its " + Words<D>::ball);
  }

  bool check_piece(std::uint32_t piece, const PieceMesh& content) {
    const auto* const bytes = reinterpret_cast<const std::byte*>(content.points.data());
    const PointView<double> places{bytes, content.points.size(), sizeof(RowPoint)};
    VerifiedMesh<D> mesh{places, content.simplices, {}, content.simplices, 0, {}};
    mesh.rows = {bytes + offsetof(RowPoint, row), content.points.size(), sizeof(RowPoint)};
    mesh.facets = match_facets(D, content.simplices, content.points.size());
    verdict_.simplices += mesh.size();
    if (!passes(piece, check_orientation(mesh)) || !passes(piece, check_facets(mesh)) ||
        !passes(piece, check_distinct(mesh))) {
      return false;
    }
    const internal::BadBalls bad = find_bad_balls(mesh);
    const auto note_facet = [&](std::size_t facet, auto&& how) {
      if (facet == kAll) return;
      (this->*how)({piece, static_cast<std::uint32_t>(facet / (D + 1))},
                   mesh.row(mesh.vertices[mesh.facets.mates[facet]]));
    };
    note_facet(bad.inside, &PiecesVerifier::note_inside);
    note_facet(bad.tie, &PiecesVerifier::note_tie);
    add_hash(content);
    match_border(piece, mesh);
    return rows_.add(piece, mesh, content.points, findings_);
  }

  // Points of a piece are at distinct places; that each has a row of its own shows when it is
  // marked.
  static internal::Check check_distinct(const VerifiedMesh<D>& mesh) {
    const std::vector<std::uint32_t> lowest = lowest_equal_rows(mesh.points, D);
    const std::size_t bad = find_first(mesh.vertices.size(), [&](std::size_t i) {
      return lowest[mesh.vertices[i]] != mesh.vertices[i];
    });
    if (bad == kAll) return std::nullopt;
    return Objection{bad / (D + 1), mesh.row(mesh.vertices[bad]) + " and " +
                                        mesh.row(lowest[mesh.vertices[bad]]) +
                                        " are at one place in the piece"};
  }

  void add_hash(const PieceMesh& content) {
    constexpr std::size_t kCornersAtOnce = 12 * 8192;  // whole simplices of either dimension
    std::vector<std::uint64_t> rows;
    for (std::size_t first = 0; first < content.simplices.size(); first += kCornersAtOnce) {
      rows.clear();
      const std::size_t last = std::min(content.simplices.size(), first + kCornersAtOnce);
      for (std::size_t i = first; i < last; ++i) {
        rows.push_back(content.points[content.simplices[i]].row);
      }
      verdict_.hash = verdict_.hash + hash(D, rows);
    }
  }

  static BorderFacet<D> border_facet(std::uint32_t piece, const VerifiedMesh<D>& mesh,
                                     std::size_t facet) {
    BorderFacet<D> border;
    const auto outward = mesh.outward(facet);
    for (int k = 0; k <= D; ++k) {
      const std::uint32_t v = k < D ? outward[k] : mesh.vertices[facet];
      border.corners[k] = internal::without_signed_zeros<D>(mesh.at(v));
      border.rows[k] = mesh.rows(v, 0);
    }
    border.of = {piece, static_cast<std::uint32_t>(facet / (D + 1))};
    return border;
  }

  void match_border(std::uint32_t piece, const VerifiedMesh<D>& mesh) {
    for (std::size_t facet = 0; facet < mesh.vertices.size(); ++facet) {
      if (mesh.facets.mates[facet] != FacetMates::kNone) continue;
      const BorderFacet<D> border = border_facet(piece, mesh, facet);
      const auto mate = facets_.match(border);
      if (!mate) {
        memory_.require(internal::BorderFacets<D>::kBytes, name_, "borders of pieces");
        continue;
      }
      // As seen from the one that came first.
      const auto corners = mate->simplex();
      const Point& opposite = border.corners[D];
      const int sign = internal::in_ball(corners, opposite);
      if (sign > 0) note_inside(mate->of, internal::row(border.rows[D]));
      if (sign == 0 && internal::counts_as_inside(corners, opposite)) {
        note_tie(mate->of, internal::row(border.rows[D]));
      }
    }
  }

  // A mesh of the simplices at the boundary, whose other facets count as matched.
  bool check_boundary() {
    verdict_.hull_facets = facets_.size();
    memory_.require(facets_.size() * (sizeof(BorderFacet<D>) + 64), name_, "boundary of the mesh");
    std::vector<BorderFacet<D>> facets;
    facets_.for_each([&](const BorderFacet<D>& facet) { facets.push_back(facet); });
    // The table's own order is none to tell of the first by.
    std::ranges::sort(facets, [](const BorderFacet<D>& a, const BorderFacet<D>& b) {
      return std::tie(a.of.piece, a.of.simplex, a.rows) <
             std::tie(b.of.piece, b.of.simplex, b.rows);
    });
    std::vector<Point> places;
    std::vector<std::uint64_t> rows;
    std::unordered_map<Point, std::uint32_t, internal::PlaceHash<D>> numbers;
    std::vector<std::uint32_t> simplices;
    for (const BorderFacet<D>& facet : facets) {
      const auto corners = facet.simplex();
      for (int k = 0; k <= D; ++k) {
        const auto [at, is_new] =
            numbers.try_emplace(corners[k], static_cast<std::uint32_t>(places.size()));
        if (is_new) {
          places.push_back(corners[k]);
          // simplex() has turned the first two of a tetrahedron round.
          rows.push_back(facet.rows[D == 3 && k < 2 ? 1 - k : k]);
        }
        simplices.push_back(at->second);
      }
    }
    VerifiedMesh<D> mesh{view(places), simplices, {}, simplices, 0, {}};
    mesh.rows = {reinterpret_cast<const std::byte*>(rows.data()), rows.size(), sizeof(rows[0])};
    mesh.facets.mates.assign(simplices.size(), 0);
    for (std::size_t i = 0; i < facets.size(); ++i) {
      mesh.facets.mates[i * (D + 1) + D] = FacetMates::kNone;
    }
    const internal::Check check = check_hull(mesh);
    if (!check) return true;
    std::optional<PieceSimplex> of;
    if (check->simplex != kAll) of = facets[check->simplex].of;
    return findings_.refuse(of, check->reason);
  }

  const PieceSource& pieces_;
  const std::string& name_;
  const files::MemoryBudget& memory_;
  internal::BorderFacets<D> facets_;
  internal::VertexRows<D> rows_;
  PiecesVerdict verdict_;
  Findings findings_;
};

}  // namespace

PiecesVerdict verify_pieces(const PieceSource& pieces, const PointParts& points,
                            const std::string& name, const files::MemoryBudget& memory) {
  internal::check_dim(pieces.dim);
  return pieces.dim == 2 ? PiecesVerifier<2>(pieces, points, name, memory).run()
                         : PiecesVerifier<3>(pieces, points, name, memory).run();
}

}  // namespace delray::delaunay
