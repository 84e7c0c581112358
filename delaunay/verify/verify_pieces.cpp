// Verification of a mesh in pieces, one after the other, by one rank or by several.
//
// A piece is checked by itself as a whole mesh is: orientation, at most two simplices at a facet
// and on opposite sides, empty balls across its inner facets. Facets without a mate in their piece
// are put together by the places of their corners when all pieces have been seen, and the balls of
// those that meet are checked. What is left is the boundary, and must be one convex polygon or
// polyhedron (check_hull()). Rows are marked when they become vertices, and sums of hashes show
// that the vertices are the points of their rows. Ranks have runs of pieces; what lies on borders
// goes to the rank of its hash. What is told is the first objection in the order of pieces, so that
// it does not depend on ranks.
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
#include <functional>
#include <optional>
#include <thread>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "comm/threads.h"
#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/equal_points.h"
#include "delaunay/verify/flat_points.h"
#include "delaunay/verify/piece_borders.h"
#include "delaunay/verify/piece_runs.h"
#include "delaunay/verify/vertex_rows.h"
#include "parallel/arena.h"

namespace delray::delaunay {
namespace {

using internal::BorderFacet;
using internal::find_first;
using internal::Findings;
using internal::kAll;
using internal::Objection;
using internal::PieceSimplex;
using internal::RankShare;
using internal::VerifiedMesh;
using internal::Words;

// Measured, for a simplex: adjacency, what finds it, and the next piece.
constexpr std::uint64_t bytes_of_simplex(int dim) { return dim == 2 ? 90 : 200; }

// A rank's pieces in their order, of which the next is read while one is looked at.
class PiecesAhead {
 public:
  PiecesAhead(const PieceSource& source, const RankShare& own) : source_(source), end_(own.end) {
    start(own.begin);
  }
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
        if (piece < end_) source_.read(piece, coming_);
      } catch (...) {
        error_ = std::current_exception();
      }
    });
  }
  const PieceSource& source_;
  std::size_t end_, at_ = 0;
  PieceMesh current_, coming_;
  std::exception_ptr error_;
  std::jthread reader_;  // ends before what it uses
};

// Half each for facets and vertices, of what ranks that are threads have together.
internal::RecordsPlace place_of_borders(const comm::Communicator& communicator,
                                        const VerifyPiecesOptions& options) {
  constexpr std::uint64_t kShare = 16, kLeast = std::uint64_t{1} << 20;
  const auto ranks = static_cast<std::uint64_t>(communicator.size());
  return {std::max(options.memory.limit() / kShare / ranks, kLeast), options.scratch};
}

// Simplices of which a rank looks at a time, the same number for all.
std::uint64_t most_simplices(comm::Communicator& communicator, int dim,
                             const VerifyPiecesOptions& options) {
  constexpr std::uint64_t kShare = 4, kLeast = 4096;
  const std::uint64_t bytes =
      bytes_of_simplex(dim) * kShare * static_cast<std::uint64_t>(communicator.size());
  return comm::all_reduce_value(communicator, std::max(options.memory.limit() / bytes, kLeast),
                                [](std::uint64_t a, std::uint64_t b) { return std::min(a, b); });
}

template <int D>
class PiecesVerifier {
 public:
  using Point = glm::vec<D, double>;

  PiecesVerifier(comm::Communicator& communicator, const PieceSource& pieces,
                 const PointParts& points, const VerifyPiecesOptions& options)
      : communicator_(communicator),
        pieces_(pieces),
        points_(points),
        options_(options),
        facets_(place_of_borders(communicator, options)),
        rows_(communicator, pieces, points, options, place_of_borders(communicator, options)) {}

  PiecesVerdict run() {
    verdict_.valid = check();
    findings_.agree(communicator_);
    verdict_.delaunay = verdict_.valid && !findings_.not_delaunay;
    verdict_.canonical = verdict_.delaunay && !findings_.not_canonical;
    const auto& objection = !verdict_.valid      ? findings_.invalid
                            : !verdict_.delaunay ? findings_.not_delaunay
                                                 : findings_.not_canonical;
    if (objection) {
      verdict_.reason = objection->reason;
      verdict_.unknown_vertex = objection->unknown_vertex;
      if (objection->of) {
        verdict_.piece = objection->of->piece;
        verdict_.simplex = objection->of->simplex;
      }
    }
    return std::move(verdict_);
  }

 private:
  // The table of contents, of all ranks. False as soon as the mesh is no triangulation of the
  // points.
  bool check() {
    if (!check_pieces()) return false;
    if (verdict_.simplices == 0) {
      return internal::check_flat<D>(communicator_, points_, verdict_, findings_);
    }
    return rows_.put_together(findings_) && check_boundary(match_all_borders()) &&
           rows_.check_points(verdict_, findings_);
  }

  // Each piece by itself, up to the first that is refused.
  bool check_pieces() {
    comm::all_or_none(communicator_, comm::Phase::other, [&] {
      const RankShare own = internal::share_of_rank(communicator_, pieces_.pieces);
      PiecesAhead ahead(pieces_, own);
      for (std::size_t piece = own.begin; piece < own.end; ++piece) {
        if (!check_piece(static_cast<std::uint32_t>(piece), ahead.next())) return;
      }
    });
    Findings refused;
    refused.invalid = findings_.invalid;
    refused.agree(communicator_);
    findings_.invalid = refused.invalid;
    // Up to the piece that is refused, as if one rank had looked at them.
    const auto& at = findings_.invalid ? findings_.invalid->of : std::nullopt;
    if (at && internal::share_of_rank(communicator_, pieces_.pieces).begin > at->piece) {
      verdict_.simplices = 0;
      verdict_.hash = {};
    }
    verdict_.simplices = comm::all_reduce_value(communicator_, verdict_.simplices, std::plus<>());
    verdict_.hash = comm::all_reduce_value(communicator_, verdict_.hash, std::plus<>());
    return !findings_.invalid;
  }

  bool passes(std::uint32_t piece, const internal::Check& check) {
    if (!check) return true;
    std::optional<PieceSimplex> of;
    if (check->simplex != kAll)
      of = PieceSimplex{piece, static_cast<std::uint32_t>(check->simplex)};
    return findings_.refuse(of, check->reason);
  }
  void note_tie(PieceSimplex of, const std::string& row) {
    Findings::note(findings_.not_canonical,
                   {of, row + " is on its " + Words<D>::ball + " and counts as inside"});
  }
  void note_inside(PieceSimplex of, const std::string& row) {
    Findings::note(findings_.not_delaunay, {of, row + " is inside its " + Words<D>::ball});
  }

  bool check_piece(std::uint32_t piece, const PieceMesh& content) {
    const std::size_t simplices = content.simplices.size() / (D + 1);
    options_.memory.require(simplices * bytes_of_simplex(D), options_.name,
                            "a piece of " + std::to_string(simplices) + " simplices");
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
    add_border(piece, mesh);
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

  void add_border(std::uint32_t piece, const VerifiedMesh<D>& mesh) {
    for (std::size_t facet = 0; facet < mesh.vertices.size(); ++facet) {
      if (mesh.facets.mates[facet] != FacetMates::kNone) continue;
      const BorderFacet<D> border = border_facet(piece, mesh, facet);
      facets_.add(border.key(), border);
    }
  }

  // As seen from the one that comes first.
  void check_ball(const BorderFacet<D>& first, const BorderFacet<D>& second) {
    const auto corners = first.simplex();
    const Point& opposite = second.corners[D];
    const int sign = internal::in_ball(corners, opposite);
    if (sign > 0) note_inside(first.of, internal::row(second.rows[D]));
    if (sign == 0 && internal::counts_as_inside(corners, opposite)) {
      note_tie(first.of, internal::row(second.rows[D]));
    }
  }

  // Collective: rank 0 gets the facets without a mate in any piece.
  std::vector<BorderFacet<D>> match_all_borders() {
    std::vector<BorderFacet<D>> left;
    facets_.exchange(
        communicator_,
        [&](std::span<const BorderFacet<D>> some) {
          internal::match_borders<D>(
              some,
              [&](const BorderFacet<D>& first, const BorderFacet<D>& second) {
                check_ball(first, second);
              },
              [&](const BorderFacet<D>& facet) {
                options_.memory.require(2 * sizeof facet, options_.name, "boundary of the mesh");
                left.push_back(facet);
              });
        },
        [] {});
    verdict_.hull_facets =
        comm::all_reduce_value(communicator_, std::uint64_t{left.size()}, std::plus<>());
    if (communicator_.size() == 1) return left;
    std::vector<BorderFacet<D>> all;
    for (const comm::Buffer& some :
         comm::gather(communicator_, 0, comm::Buffer::of(std::span<const BorderFacet<D>>(left)))) {
      const auto received = some.template as<BorderFacet<D>>();
      all.insert(all.end(), received.begin(), received.end());
    }
    return all;
  }

  // Collective.
  bool check_boundary(std::vector<BorderFacet<D>>&& facets) {
    Findings refused;
    comm::all_or_none(communicator_, comm::Phase::other, [&] {
      if (communicator_.rank() == 0) check_hull_of(std::move(facets), refused);
    });
    refused.agree(communicator_);
    if (!refused.invalid) return true;
    findings_.invalid = refused.invalid;
    return false;
  }

  // A mesh of the simplices at the boundary, whose other facets count as matched.
  void check_hull_of(std::vector<BorderFacet<D>>&& facets, Findings& findings) {
    options_.memory.require(facets.size() * (sizeof(BorderFacet<D>) + 64), options_.name,
                            "boundary of the mesh");
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
    if (!check) return;
    std::optional<PieceSimplex> of;
    if (check->simplex != kAll) of = facets[check->simplex].of;
    findings.refuse(of, check->reason);
  }

  comm::Communicator& communicator_;
  const PieceSource& pieces_;
  const PointParts& points_;
  const VerifyPiecesOptions& options_;
  internal::BorderRecords<BorderFacet<D>> facets_;
  internal::VertexRows<D> rows_;
  PiecesVerdict verdict_;
  Findings findings_;
};

}  // namespace

PiecesVerdict verify_pieces(comm::Communicator& communicator, const PieceSource& pieces,
                            const PointParts& points, const VerifyPiecesOptions& options) {
  internal::check_dim(pieces.dim);
  const internal::PieceRuns runs(pieces, most_simplices(communicator, pieces.dim, options));
  PiecesVerdict verdict =
      pieces.dim == 2 ? PiecesVerifier<2>(communicator, runs.pieces(), points, options).run()
                      : PiecesVerifier<3>(communicator, runs.pieces(), points, options).run();
  runs.name_in_source(verdict);
  return verdict;
}

PiecesVerdict verify_pieces(const PieceSource& pieces, const PointParts& points,
                            const std::string& name, const files::MemoryBudget& memory) {
  PiecesVerdict verdict;
  comm::run_threads(1, parallel::arena_threads(), [&](comm::Communicator& communicator) {
    verdict = verify_pieces(communicator, pieces, points, {name, memory, {}});
  });
  return verdict;
}

}  // namespace delray::delaunay
