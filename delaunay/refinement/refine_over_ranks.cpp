// Refinement by ranks that exchange messages (Okusanya and Peraire 1996; Kohout 2004, 5.2.3): each
// has a part of the triangles, asks others for those that a cavity reaches, and is denied what
// somebody else has.
//
// Rounds, so that the result depends on the number of ranks alone and not on who was faster:
// 1. A rank refines as if it were alone, with its own triangles and those that were locked for it.
//    A step that would need others is put off.
// 2. Triangles of others go back, changed ones with what they have become.
// 3. While nobody writes, steps that were put off are rehearsed: the rank fetches copies of what
//    they read until none misses any, and so knows their cavities.
// 4. It asks the owners to lock these for the next round. An owner gives each triangle to one rank,
//    itself included, and denies it to others; one that goes first changes from round to round.
// The rank that goes first gets all it asks for and can do what it rehearsed, so that there are
// never more rounds without a step than ranks. The end is when nothing is left anywhere.
//
// A rank has its triangles, those beside them, and copies for a round. Rank 0 has all before and
// after. Messages of a round are as many as parts that touch, times a few.
#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "delaunay/distributed/counting.h"
#include "delaunay/refinement/mesh_part.h"
#include "delaunay/refinement/part_distribution.h"
#include "delaunay/refinement/refinement_runs.h"
#include "delaunay/refinement/refiner.h"

namespace delray::delaunay::internal {
namespace {

// Long enough for messages to cost little, short enough for the worst triangles to come before
// others on all ranks.
constexpr std::size_t kPointsOfRound = 1 << 12;
// A coarser mesh, as that of a square, cannot be cut into parts of equal work.
constexpr SimplexNumber kTrianglesOfPart = 64;

// What a rank may do in the steps of a round, and what they did.
struct Round {
  MeshPart& part;
  parallel::Progress* progress;
  bool is_rehearsal = false;  // nothing is written
  bool is_short = false;      // of vertices
  std::size_t steps_left = 0, vertices_left = 0;
  std::vector<bool> is_lent = {};  // own triangles that are locked for others
  // Triangles: of a step, those that steps lacked, of steps that were rehearsed, of others.
  std::vector<SimplexNumber> touched = {}, missing = {}, asked = {}, changed = {};
};

class PartAccess {
 public:
  explicit PartAccess(Round& round) : round_(&round) {}

  bool acquire(SimplexNumber t) {
    const bool is_free = round_->part.is_own(t) ? t >= round_->is_lent.size() || !round_->is_lent[t]
                                                : round_->part.is_here(t);
    (is_free ? round_->touched : round_->missing).push_back(t);
    return is_free;
  }
  bool prepare() const { return round_->is_rehearsal || round_->steps_left > 0; }
  bool claim() {
    if (round_->is_rehearsal) {
      round_->asked.insert(round_->asked.end(), round_->touched.begin(), round_->touched.end());
      return false;
    }
    round_->is_short |= round_->vertices_left == 0;
    return round_->vertices_left > 0;
  }
  VertexNumber vertex() {
    for (const SimplexNumber t : round_->touched) {
      if (!round_->part.is_own(t)) round_->changed.push_back(t);
    }
    --round_->steps_left;
    --round_->vertices_left;
    if (round_->progress != nullptr) round_->progress->advance();
    return round_->part.make_vertex();
  }
  SimplexNumber triangle() { return round_->part.make_triangle(); }
  void release() { round_->touched.clear(); }
  bool keeps(SimplexNumber t) const { return round_->part.is_own(t); }

 private:
  Round* round_;
};

void make_unique(std::vector<SimplexNumber>& triangles) {
  std::ranges::sort(triangles);
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
}

// By the rank that it goes to or comes from.
template <class T>
using ByRank = std::map<int, T>;
using Numbers = std::vector<std::uint32_t>;  // of triangles at their owner

std::vector<comm::Parcel> deliver(comm::Communicator& communicator, const ByRank<Packer>& packers) {
  std::vector<comm::Parcel> parcels;
  for (const auto& [rank, packer] : packers) parcels.push_back({rank, packer.buffer()});
  return comm::exchange(communicator, std::move(parcels));
}
ByRank<Numbers> deliver(comm::Communicator& communicator, const ByRank<Numbers>& numbers) {
  ByRank<Packer> packers;
  for (const auto& [rank, list] : numbers) packers[rank].list(list);
  ByRank<Numbers> received;
  for (const comm::Parcel& parcel : deliver(communicator, packers)) {
    received[parcel.rank] = Unpacker(parcel.message).list<std::uint32_t>();
  }
  return received;
}

// A piece of a segment whose triangle belongs to the receiver.
struct PieceRecord {
  PartId corner, start, end;
};

// The refinement of one rank's part.
class RankRefiner {
 public:
  RankRefiner(comm::Communicator& communicator, MeshPart& part, const TriangleBounds& bounds,
              parallel::Progress* progress)
      : communicator_(communicator),
        part_(part),
        round_{.part = part, .progress = progress},
        refiner_(part.mesh, bounds, PartAccess(round_)) {}

  // Until nothing is left on any rank. False, on all ranks, if that takes more vertices.
  bool run(std::size_t most_vertices) {
    suspect_own();
    for (std::size_t left = most_vertices;; ++rounds_) {
      comm::all_or_none(communicator_, comm::Phase::other, [&] { work(left); });
      give_back();
      std::array<std::uint64_t, 3> sums = {refiner_.pending(), part_.made(),
                                           round_.is_short ? 1U : 0U};
      comm::all_reduce(communicator_, std::span<std::uint64_t>(sums), std::plus<>());
      left = most_vertices - sums[1];
      if (left == 0 && sums[2] > 0) return false;
      if (sums[0] == 0) return true;
      fetch();
      lock();
    }
  }

  std::uint64_t rounds() const { return rounds_; }
  const RefineCounts& counts() const { return refiner_.counts(); }
  const RefineRank& of_rank() const { return of_rank_; }

 private:
  int owner(SimplexNumber t) const { return static_cast<int>(part_.triangle_id(t).rank); }
  // Of two ranks the one with the lower number goes first.
  std::uint64_t turn(int rank) const {
    return (static_cast<std::uint64_t>(rank) + rounds_) %
           static_cast<std::uint64_t>(communicator_.size());
  }

  // Copies of triangles across own pieces are here.
  void suspect_own() {
    const SimplexNumber triangles = part_.mesh.triangles;
    for (SimplexNumber t = 0; t < triangles; ++t) {
      if (part_.is_own(t)) suspect_all(part_.mesh, refiner_, t, t + 1);
    }
    for (SimplexNumber t = 0; t < triangles; ++t) {
      if (!part_.is_own(t)) part_.forget(t);
    }
  }

  void work(std::size_t vertices_left) {
    const auto ranks = static_cast<std::size_t>(communicator_.size());
    const bool is_first = turn(communicator_.rank()) == 0;
    round_.vertices_left = vertices_left / ranks + (is_first ? vertices_left % ranks : 0);
    round_.steps_left = kPointsOfRound;
    round_.is_short = false;
    refiner_.retry();
    while (refiner_.step()) {
    }
  }

  void give_back() {
    make_unique(round_.changed);
    of_rank_.returned += round_.changed.size();
    ByRank<std::vector<SimplexNumber>> changed;
    ByRank<std::vector<PieceRecord>> pieces;
    for (const SimplexNumber t : round_.changed) changed[owner(t)].push_back(t);
    for (const auto& [corner, start, end] : refiner_.take_elsewhere()) {
      const int to = owner(simplex_of(corner));
      pieces[to].push_back({part_.corner_id(corner), part_.vertex_id(start), part_.vertex_id(end)});
      changed.try_emplace(to);
    }
    ByRank<Packer> packers;
    for (const auto& [rank, triangles] : changed) {
      part_.pack(triangles, packers[rank]);
      packers[rank].list(pieces[rank]);
    }
    round_.changed.clear();
    round_.is_lent.clear();
    for (const SimplexNumber t : copies_) part_.forget(t);
    copies_.clear();
    for (const comm::Parcel& parcel : deliver(communicator_, packers)) take_back(parcel.message);
  }

  // Who changed a triangle has found out which of its pieces are to be cut.
  void take_back(const comm::Buffer& message) {
    Unpacker content(message);
    for (const SimplexNumber t : part_.unpack(content)) {
      if (part_.mesh.is_inside(t)) refiner_.suspect_triangle(t);
    }
    for (const PieceRecord& piece : content.list<PieceRecord>()) {
      const auto start = part_.find_vertex(piece.start), end = part_.find_vertex(piece.end);
      // A vertex that is not known here is of no triangle any more.
      if (start && end) refiner_.add_piece({part_.corner_of(piece.corner), *start, *end});
    }
  }

  // Copies of all that steps read which were put off.
  void fetch() {
    round_.is_rehearsal = true;
    for (;;) {
      round_.missing.clear();
      round_.asked.clear();
      refiner_.rehearse();
      make_unique(round_.missing);
      const std::uint64_t missing = comm::all_reduce_value(
          communicator_, std::uint64_t{round_.missing.size()}, std::plus<>());
      if (missing == 0) break;
      ByRank<Packer> packers;
      for (const auto& [rank, numbers] : deliver(communicator_, numbers_of(round_.missing))) {
        part_.pack(around(numbers), packers[rank]);
      }
      for (const comm::Parcel& parcel : deliver(communicator_, packers)) {
        Unpacker content(parcel.message);
        const std::vector<SimplexNumber> copies = part_.unpack(content);
        of_rank_.fetched += copies.size();
        copies_.insert(copies_.end(), copies.begin(), copies.end());
      }
    }
    make_unique(round_.asked);
    round_.is_rehearsal = false;
  }

  ByRank<Numbers> numbers_of(const std::vector<SimplexNumber>& triangles) const {
    ByRank<Numbers> numbers;
    for (const SimplexNumber t : triangles) {
      numbers[owner(t)].push_back(part_.triangle_id(t).number);
    }
    return numbers;
  }

  // Own triangles and those around them, since a cavity has some of these.
  std::vector<SimplexNumber> around(std::vector<SimplexNumber> triangles) {
    constexpr int kRings = 2;
    const auto me = static_cast<std::uint32_t>(communicator_.rank());
    for (SimplexNumber& t : triangles) t = part_.slot_of({me, t});
    std::size_t next = 0;
    for (int ring = 0; ring < kRings; ++ring) {
      for (const std::size_t last = triangles.size(); next < last; ++next) {
        for (unsigned k = 0; k < 3; ++k) {
          const SimplexNumber beside = simplex_of(part_.mesh.mesh.neighbour(triangles[next], k));
          if (part_.is_own(beside)) triangles.push_back(beside);
        }
      }
    }
    make_unique(triangles);
    return triangles;
  }

  // Locks of what steps touch that were rehearsed; other copies are forgotten.
  void lock() {
    struct Claim {
      SimplexNumber triangle;
      int rank;
    };
    std::vector<Claim> claims;
    std::vector<SimplexNumber> remote;
    const int me = communicator_.rank();
    for (const SimplexNumber t : round_.asked) {
      if (part_.is_own(t)) {
        claims.push_back({t, me});
      } else {
        remote.push_back(t);
      }
    }
    for (const auto& [rank, numbers] : deliver(communicator_, numbers_of(remote))) {
      for (const std::uint32_t t : numbers) claims.push_back({t, rank});
    }
    std::ranges::sort(claims, [&](const Claim& a, const Claim& b) {
      return a.triangle != b.triangle ? a.triangle < b.triangle : turn(a.rank) < turn(b.rank);
    });
    ByRank<Numbers> granted;
    round_.is_lent.resize(part_.mesh.triangles);
    for (std::size_t i = 0; i < claims.size(); ++i) {
      const auto [t, rank] = claims[i];
      if (rank == me || (i > 0 && claims[i - 1].triangle == t)) continue;
      comm::check_message(t < part_.mesh.triangles && part_.is_own(t));
      round_.is_lent[t] = true;
      granted[rank].push_back(t);
    }
    std::vector<SimplexNumber> held;
    for (const auto& [rank, numbers] : deliver(communicator_, granted)) {
      for (const std::uint32_t number : numbers) {
        held.push_back(part_.slot_of({static_cast<std::uint32_t>(rank), number}));
      }
    }
    of_rank_.requests += remote.size();
    of_rank_.denials += remote.size() - held.size();
    make_unique(held);
    for (const SimplexNumber t : copies_) {
      if (!std::ranges::binary_search(held, t)) part_.forget(t);
    }
    copies_ = std::move(held);
  }

  comm::Communicator& communicator_;
  MeshPart& part_;
  Round round_;
  Refiner<PartAccess> refiner_;
  std::vector<SimplexNumber> copies_;  // that are here
  std::uint64_t rounds_ = 0;
  RefineRank of_rank_;
};

}  // namespace

std::vector<RefineRank> refine_over_ranks(comm::Communicator& communicator, RefinementMesh& mesh,
                                          const TriangleBounds& bounds,
                                          const RefinementLimits& limits, RefineCounts& counts) {
  MessageCounts messages;
  Counting counting(communicator, messages);
  bool is_short = false;
  const VertexNumber vertices = mesh.vertices;
  comm::all_or_none(counting, comm::Phase::other, [&] {
    if (counting.rank() != 0) return;
    try {
      refine_alone_until(mesh, bounds, limits,
                         kTrianglesOfPart * static_cast<SimplexNumber>(counting.size()), counts);
    } catch (const std::length_error&) {
      is_short = true;
    }
  });
  const VertexNumber made_first = mesh.vertices - vertices;
  MeshPart part = distribute_parts(counting, mesh, bounds);
  const std::uint64_t given = part.mesh.triangles;
  RankRefiner refiner(counting, part, bounds, limits.progress);
  const std::size_t most = limits.most_vertices - std::min(limits.most_vertices, part.given());
  if (!refiner.run(is_short ? 0 : most)) {
    throw comm::Agreed<std::length_error>(too_many_points(limits.most_vertices));
  }
  gather_parts(counting, part, mesh);
  RefineRank mine = refiner.of_rank();
  mine.triangles = given;
  mine.most_triangles = part.mesh.triangles;
  mine.points = made_first + part.made();
  mine.messages = messages.messages;
  mine.bytes = messages.bytes;
  mine.waiting_seconds = messages.waiting_seconds;
  std::array<std::uint64_t, 4> sums = {refiner.counts().on_segments, refiner.counts().inside,
                                       refiner.counts().too_fine, refiner.counts().denied};
  comm::all_reduce(communicator, std::span<std::uint64_t>(sums), std::plus<>());
  counts.on_segments += sums[0];
  counts.inside += sums[1];
  counts.too_fine += sums[2];
  counts.denied += sums[3];
  counts.rounds = refiner.rounds() + 1;
  std::vector<RefineRank> ranks;
  for (const comm::Buffer& each : comm::gather(communicator, 0, comm::Buffer::of_value(mine))) {
    ranks.push_back(each.as<RefineRank>().front());
  }
  return ranks;
}

}  // namespace delray::delaunay::internal
