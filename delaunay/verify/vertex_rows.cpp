// Marks rows of vertices, sums hashes of rows and places, and looks up points that are no vertices
// among the places of those that are. Only what is wrong is searched for, to name it: the first in
// the order of pieces, or of rows, so that it is the same for all numbers of ranks.
#include "delaunay/verify/vertex_rows.h"

#include <array>
#include <cstdio>
#include <functional>
#include <utility>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"

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

}  // namespace

template <int D>
std::uint64_t VertexRows<D>::most_rows() const {
  std::uint64_t rows = comm::all_or_none(communicator_, comm::Phase::other, [&] {
    const RankShare own = share_of_rank(communicator_, points_.parts());
    std::uint64_t mine = 0;
    for (std::size_t part = own.begin; part < own.end; ++part) mine += points_.most_rows(part);
    return mine;
  });
  return comm::all_reduce_value(communicator_, rows, std::plus<>());
}

template <int D>
VertexRows<D>::VertexRows(comm::Communicator& communicator, const PieceSource& pieces,
                          const PointParts& points, const VerifyPiecesOptions& options,
                          const RecordsPlace& borders)
    : communicator_(communicator),
      pieces_(pieces),
      points_(points),
      name_(options.name),
      memory_(options.memory),
      rows_(most_rows()),
      marks_(comm::all_or_none(communicator, comm::Phase::other,
                               [&] {
                                 memory_.require(rows_ / 8, name_, "a bit for each row");
                                 return RowMarks(rows_);
                               })),
      places_(communicator, rows_, 0, D),
      heights_(communicator, rows_, 2, 1),
      border_(borders) {}

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
void VertexRows<D>::add_pair(const RowPoint& point) {
  places_.add_mesh(point);
  if constexpr (D == 2) {
    heights_.add_mesh(point);
    if (point.position.z != 0) mesh_has_heights_.store(true, std::memory_order_relaxed);
  }
}

template <int D>
void VertexRows<D>::note_doubled(std::uint64_t row) {
  std::uint64_t lowest = doubled_;
  while (row < lowest && !doubled_.compare_exchange_weak(lowest, row)) {
  }
}

template <int D>
bool VertexRows<D>::add(std::uint32_t piece, const VerifiedMesh<D>& mesh,
                        std::span<const RowPoint> points, Findings& findings) {
  const std::size_t unknown = find_first(
      mesh.vertices.size(), [&](std::size_t i) { return points[mesh.vertices[i]].row >= rows_; });
  if (unknown != kAll) {
    constexpr bool kUnknownVertex = true;
    return findings.refuse(PieceSimplex{piece, static_cast<std::uint32_t>(unknown / (D + 1))},
                           mesh.row(mesh.vertices[unknown]) + " is not a row of the points",
                           kUnknownVertex);
  }
  const std::vector<std::uint8_t> kinds = kinds_of_vertices(mesh);
  parallel::parallel_for(0, kinds.size(), kVerifyGrain, [&](std::size_t i) {
    if (kinds[i] != kInner) return;
    if (marks_.mark(points[i].row)) {
      add_pair(points[i]);
    } else {
      note_doubled(points[i].row);
    }
  });
  std::vector<std::uint32_t> first(kinds.size());  // simplex with a vertex
  for (std::size_t i = mesh.vertices.size(); i-- > 0;) {
    first[mesh.vertices[i]] = static_cast<std::uint32_t>(i / (D + 1));
  }
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i] != kBorder) continue;
    const std::uint64_t place = bits_of_place<D>(without_signed_zeros<D>(mesh.at(i)));
    border_.add(mix_bits(place), {points[i], {piece, first[i]}});
  }
  return true;
}

// Rows that each rank's parts have, so that it can compare them with its marks.
template <int D>
void VertexRows<D>::find_own_rows() {
  const int ranks = communicator_.size();
  begins_.assign(static_cast<std::size_t>(ranks) + 1, 0);
  begins_.back() = rows_;
  if (ranks == 1) return;
  const RankShare own = share_of_rank(communicator_, points_.parts());
  const std::uint64_t mine = comm::all_or_none(communicator_, comm::Phase::other, [&] {
    std::uint64_t rows = 0;
    PointCloud part;
    for (std::size_t i = own.begin; i < own.end; ++i) {
      points_.read(i, part);
      rows += part.size();
    }
    return rows;
  });
  const std::vector<comm::Buffer> all =
      comm::all_gather(communicator_, comm::Buffer::of_value(mine));
  for (std::size_t rank = 0; rank + 1 < all.size(); ++rank) {
    begins_[rank + 1] = begins_[rank] + all[rank].template as<std::uint64_t>()[0];
  }
  own_first_ = begins_[static_cast<std::size_t>(communicator_.rank())];
}

template <int D>
void VertexRows<D>::exchange_marks() {
  if (communicator_.size() == 1) return;
  const auto own = static_cast<std::size_t>(communicator_.rank());
  std::vector<comm::Parcel> parcels;
  for (std::size_t rank = 0; rank + 1 < begins_.size(); ++rank) {
    if (rank == own) continue;
    const std::vector<std::uint64_t> words = marks_.words(begins_[rank], begins_[rank + 1]);
    if (words.empty()) continue;
    parcels.push_back(
        {static_cast<int>(rank), comm::Buffer::of(std::span<const std::uint64_t>(words))});
  }
  parcels = comm::exchange(communicator_, std::move(parcels));
  marks_.keep(begins_[own], begins_[own + 1]);
  for (const comm::Parcel& parcel : parcels) {
    const auto twice = marks_.merge(begins_[own], parcel.message.as<std::uint64_t>());
    if (twice) note_doubled(*twice);
  }
}

// Each row at each place counts once, and so does each of its heights.
template <int D>
void VertexRows<D>::take_places(std::span<BorderVertex> vertices, Findings& findings,
                                std::vector<std::uint64_t>& rows) {
  for_places<D>(vertices, [&](std::span<const BorderVertex> same) {
    const std::uint64_t lowest = same.front().point.row;
    for (std::size_t i = 0; i < same.size(); ++i) {
      const RowPoint& point = same[i].point;
      const bool new_row = i == 0 || same[i - 1].point.row != point.row;
      if (new_row) {
        rows.push_back(point.row);
        add_pair(point);
      } else if (D == 2 && same[i - 1].point.position.z != point.position.z) {
        heights_.add_mesh(point);
      }
      if (point.row == lowest) continue;
      Findings::note(findings.not_canonical,
                     {same[i].of, internal::row(point.row) + " is where " + internal::row(lowest) +
                                      " is a vertex of another piece"});
    }
  });
}

// Collective.
template <int D>
void VertexRows<D>::mark_rows(std::vector<std::uint64_t>& rows) {
  const auto mark = [&](std::span<const std::uint64_t> some) {
    for (const std::uint64_t row : some) {
      if (!marks_.mark(row)) note_doubled(row);
    }
  };
  if (communicator_.size() == 1) {
    mark(rows);
    rows.clear();
    return;
  }
  std::ranges::sort(rows);
  std::vector<comm::Parcel> parcels;
  for (std::size_t rank = 0, first = 0; rank + 1 < begins_.size(); ++rank) {
    const auto end = std::ranges::lower_bound(rows, begins_[rank + 1]) - rows.begin();
    const auto last = static_cast<std::size_t>(end);
    if (first < last) {
      parcels.push_back({static_cast<int>(rank), comm::Buffer::of(std::span<const std::uint64_t>(
                                                     rows.data() + first, last - first))});
    }
    first = last;
  }
  rows.clear();
  for (const comm::Parcel& parcel : comm::exchange(communicator_, std::move(parcels))) {
    mark(parcel.message.as<std::uint64_t>());
  }
}

template <int D>
std::uint64_t VertexRows<D>::least_of_all(std::uint64_t row) const {
  return comm::all_reduce_value(communicator_, row,
                                [](std::uint64_t a, std::uint64_t b) { return std::min(a, b); });
}

template <int D>
bool VertexRows<D>::put_together(Findings& findings) {
  find_own_rows();
  exchange_marks();
  std::vector<std::uint64_t> rows;
  border_.exchange(
      communicator_,
      [&](std::span<BorderVertex> vertices) { take_places(vertices, findings, rows); },
      [&] { mark_rows(rows); });
  const std::uint64_t doubled = least_of_all(doubled_);
  return doubled == kNoRow || refuse_doubled(doubled, findings);
}

// Names the first vertex in another place than the first one that has the row, or else in another
// piece.
template <int D>
bool VertexRows<D>::refuse_doubled(std::uint64_t row, Findings& findings) {
  const auto first_with = [&](auto&& wanted) {
    return first_corner(communicator_, pieces_, [&](const PieceCorner& found) {
      return found.vertex.row == row && wanted(found);
    });
  };
  auto named = first_with([](const PieceCorner&) { return true; });
  if (named) {
    const PieceCorner first = *named;
    auto other = first_with([&](const PieceCorner& found) {
      return Point(found.vertex.position) != Point(first.vertex.position);
    });
    if (!other) {
      other =
          first_with([&](const PieceCorner& found) { return found.of.piece != first.of.piece; });
    }
    if (other) named = other;
  }
  return findings.refuse(
      named ? std::optional(named->of) : std::nullopt,
      internal::row(row) +
          " is a vertex at another place too, or of simplices that this does not meet");
}

template <int D>
bool VertexRows<D>::check_points(PiecesVerdict& verdict, Findings& findings) {
  constexpr std::uint64_t kBytesOfUnused = 160;
  constexpr std::uint64_t kAlways = 4096;
  constexpr bool kUnknownVertex = true;
  const RankShare parts = share_of_rank(communicator_, points_.parts());
  const std::uint64_t most = std::max(
      memory_.left() / 4 / kBytesOfUnused / static_cast<std::uint64_t>(communicator_.size()),
      kAlways);
  std::vector<RowPoint> unused;  // the first of those that are no vertices
  std::uint64_t all_unused = 0;
  std::uint64_t sums[] = {0, 0, 0, mesh_has_heights_ ? 1U : 0U};
  comm::all_or_none(communicator_, comm::Phase::other, [&] {
    for_points(points_, parts, own_first_, [&](const RowPoint& point, bool has_z) {
      ++sums[0];
      if (has_z && point.position.z != 0) sums[2] = 1;
      if (!marks_.is_marked(point.row)) {
        if (++all_unused <= most) unused.push_back(point);
        return;
      }
      ++sums[1];
      places_.add_points(point);
      if constexpr (D == 2) heights_.add_points(point);
    });
  });
  comm::all_reduce(communicator_, std::span<std::uint64_t>(sums), std::plus<>());
  verdict.points = sums[0];
  verdict.distinct = sums[1];
  points_have_heights_ = sums[2] != 0;
  mesh_has_heights_ = sums[3] != 0;
  if (const std::uint64_t extra = least_of_all(marks_.next(verdict.points).value_or(kNoRow));
      extra != kNoRow) {
    const auto found = first_corner(
        communicator_, pieces_, [&](const PieceCorner& each) { return each.vertex.row == extra; });
    return findings.refuse(found ? std::optional(found->of) : std::nullopt,
                           internal::row(extra) + " is not a row of the points", kUnknownVertex);
  }
  places_.add_up(communicator_);
  heights_.add_up(communicator_);
  if (const auto range = places_.first_difference()) {
    std::string reason = "vertices are not the points of their rows";
    const auto found = find_different(*range, D, reason);
    return findings.refuse(found ? std::optional(found->of) : std::nullopt, reason, kUnknownVertex);
  }
  for (std::uint64_t done = 0;;) {
    if (!check_unused(unused, findings)) return false;
    done += unused.size();
    const std::uint64_t left = all_unused - done;
    if (comm::all_reduce_value(communicator_, left, std::plus<>()) == 0) break;
    unused.clear();
    comm::all_or_none(communicator_, comm::Phase::other, [&] {
      std::uint64_t seen = 0;
      if (left == 0) return;
      for_points(points_, parts, own_first_, [&](const RowPoint& point, bool) {
        if (!marks_.is_marked(point.row) && seen++ >= done && unused.size() < most) {
          unused.push_back(point);
        }
      });
    });
  }
  if constexpr (D == 2) compare_heights(verdict);
  return true;
}

// Each of those of all ranks has to be where a vertex of a lower row is.
template <int D>
bool VertexRows<D>::check_unused(const std::vector<RowPoint>& unused, Findings& findings) {
  struct Lowest {
    std::uint64_t row;
    std::size_t number;
  };
  std::unordered_map<Point, Lowest, PlaceHash<D>> lowest;  // the first is the lowest
  std::vector<std::uint64_t> rows;                         // of places
  for (const comm::Buffer& some :
       comm::all_gather(communicator_, comm::Buffer::of(std::span<const RowPoint>(unused)))) {
    for (const RowPoint& point : some.template as<RowPoint>()) {
      const auto [at, is_new] = lowest.try_emplace(without_signed_zeros<D>(Point(point.position)),
                                                   Lowest{point.row, rows.size()});
      if (is_new) rows.push_back(point.row);
    }
  }
  if (rows.empty()) return true;
  std::vector<std::uint8_t> found(rows.size());
  comm::all_or_none(communicator_, comm::Phase::other, [&] {
    for_corners(communicator_, pieces_, [&](const PieceCorner& vertex) {
      const auto at = lowest.find(without_signed_zeros<D>(Point(vertex.vertex.position)));
      if (at == lowest.end()) return false;
      found[at->second.number] = 1;
      if (at->second.row < vertex.vertex.row) {
        Findings::note(findings.not_canonical,
                       {vertex.of, internal::row(vertex.vertex.row) + " is a vertex, but equals " +
                                       internal::row(at->second.row)});
      }
      return false;
    });
  });
  comm::all_reduce(communicator_, std::span<std::uint8_t>(found),
                   [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
  std::uint64_t first = kNoRow;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (found[i] == 0) first = std::min(first, rows[i]);
  }
  if (first == kNoRow) return true;
  return findings.refuse({}, internal::row(first) + " is in no " + Words<D>::simplex);
}

// The first vertex with a row of the range that is not where its point is in the first `compared`
// coordinates; `reason` becomes a sentence about it.
template <int D>
auto VertexRows<D>::find_different(const Range& range, int compared, std::string& reason)
    -> std::optional<PieceCorner> {
  const std::vector<RowPoint> mine = comm::all_or_none(communicator_, comm::Phase::other, [&] {
    std::vector<RowPoint> some;
    for_points(points_, share_of_rank(communicator_, points_.parts()), own_first_,
               [&](const RowPoint& point, bool) {
                 if (point.row >= range.first && point.row < range.last) some.push_back(point);
               });
    return some;
  });
  std::vector<glm::dvec3> positions;  // rows of lower ranks come first
  for (const comm::Buffer& some :
       comm::all_gather(communicator_, comm::Buffer::of(std::span<const RowPoint>(mine)))) {
    for (const RowPoint& point : some.template as<RowPoint>()) positions.push_back(point.position);
  }
  const auto different = first_corner(communicator_, pieces_, [&](const PieceCorner& found) {
    const RowPoint& vertex = found.vertex;
    if (vertex.row < range.first || vertex.row - range.first >= positions.size()) return false;
    const glm::dvec3& point = positions[vertex.row - range.first];
    bool equal = true;
    for (int k = 0; k < compared; ++k) equal = equal && vertex.position[k] == point[k];
    return !equal;
  });
  if (different) {
    const RowPoint& vertex = different->vertex;
    reason = internal::row(vertex.row) + " is at " + place_text(vertex.position, compared) +
             " in the mesh, at " + place_text(positions[vertex.row - range.first], compared) +
             " in the points";
  }
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

template class VertexRows<2>;
template class VertexRows<3>;

}  // namespace delray::delaunay::internal
