// Each candidate finds its cavity and claims it (claims.h). Which points are inserted in a round
// depends on the seed alone, not on threads.
//
// Spielman, Teng and Ungor choose among circumcentres that refine a mesh, by the distances of
// centres; here the points are given, and the cavities themselves tell. Points that wait know the
// simplex that holds them; after a round those of removed simplices walk to it from what replaced
// them.
//
// Degenerate: a cavity that is as large as the mesh lets one point in a round, so that points whose
// simplices all meet in few vertices take as many rounds as points.
#include "delaunay/cavity/spielman.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "delaunay/cavity/claims.h"
#include "delaunay/cavity/hole.h"
#include "delaunay/cavity/insert_distinct.h"
#include "delaunay/cavity/point_space.h"
#include "delaunay/mesh/extract.h"
#include "delaunay/mesh/start_mesh.h"
#include "delaunay/mesh/stopwatch.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay::internal {
namespace {

template <int D>
class IndependentSets {
 public:
  IndependentSets(const std::vector<Position<D>>& points,
                  const std::array<VertexNumber, D + 1>& first, const Options& options)
      : space_(points, first),
        options_(options),
        mesh_(4 * points.size() + 64),
        claims_(mesh_.size()),
        first_in_(mesh_.size(), kNobody),
        replaced_by_(mesh_.size(), kNotReplaced),
        creators_(options.created_by && options.threads > 1 ? mesh_.size() : 0),
        holders_(points.size(), 0) {
    start_mesh(mesh_, first);
    for (VertexNumber v = 0; v < points.size(); ++v) {
      if (std::ranges::find(first, v) == first.end()) waiting_.push_back(v);
    }
    order_.resize(points.size());
    std::iota(order_.begin(), order_.end(), 0U);
    std::mt19937_64 random(options.seed);
    for (std::size_t i = order_.size(); i > 1; --i) std::swap(order_[i - 1], order_[random() % i]);
  }

  void run() {
    Stopwatch watch;
    for_each(waiting_.size(), kFewPoints, [&](std::size_t i) { locate(waiting_[i], 0); });
    while (!waiting_.empty()) {
      choose_candidates();
      for_each(candidates_.size(), 1, [&](std::size_t i) { dig(candidates_[i]); });
      for_each(candidates_.size(), kFewPoints, [&](std::size_t i) { check(candidates_[i]); });
      give_slots();
      seconds_.subdivide += watch.lap();
      for_each(candidates_.size(), 1, [&](std::size_t i) { fill(candidates_[i]); });
      const std::size_t inserted = drop_inserted();
      seconds_.subdivide += watch.lap();
      for_each(waiting_.size(), kFewPoints, [&](std::size_t i) { follow(waiting_[i]); });
      for (const Candidate& candidate : candidates_) forget_replacements(candidate);
      seconds_.locate += watch.lap();
      if (options_.progress != nullptr) options_.progress->advance(inserted);
      ++round_;
    }
    mesh_.shrink(used_);
  }

  Result extract_with(std::span<const std::uint32_t> rows) {
    if (!creators_.empty()) creators_.resize(used_);
    Result result = extract(std::move(mesh_), rows, options_.threads, std::move(creators_));
    seconds_.synchronization.rollbacks = lost_;
    result.statistics = seconds_;
    return result;
  }

 private:
  struct Candidate {
    VertexNumber vertex = 0;
    bool is_winner = false;
    Hole<D> hole;
    HoleFinder<D> finder;
    StarFiller<D> filler;
    std::vector<SimplexNumber> slots;  // for its star, then those that are left over
  };

  static constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();
  static constexpr SimplexNumber kNotReplaced = std::numeric_limits<SimplexNumber>::max();
  static constexpr std::size_t kFewPoints = 1024;    // tens of microseconds of a loop
  static constexpr std::size_t kFewCandidates = 16;  // not worth waking threads

  template <class F>
  void for_each(std::size_t n, std::size_t grain, const F& f) const {
    if (options_.threads > 1 && n > std::max(grain, kFewCandidates)) {
      return parallel::parallel_for(0, n, grain, f);
    }
    for (std::size_t i = 0; i < n; ++i) f(i);
  }
  void locate(VertexNumber v, SimplexNumber start) {
    std::uint32_t random = order_[v] | 1;
    holders_[v] = space_.walk_to(mesh_, start, v, random);
  }

  // The first of each simplex, unless a simplex nearby has an earlier one.
  void choose_candidates() {
    for_each(waiting_.size(), kFewPoints, [&](std::size_t i) {
      lower_to(first_in_[holders_[waiting_[i]]], order_[waiting_[i]]);
    });
    firsts_.clear();
    for (const VertexNumber v : waiting_) {
      if (first_in_[holders_[v]] == order_[v]) firsts_.push_back(v);
    }
    is_candidate_.resize(firsts_.size());
    for_each(firsts_.size(), kFewPoints, [&](std::size_t i) {
      const std::uint32_t own = order_[firsts_[i]];
      is_candidate_[i] = is_best_around(mesh_, holders_[firsts_[i]],
                                        [&](SimplexNumber t) { return first_in_[t] < own; });
    });
    std::size_t count = 0;
    for (std::size_t i = 0; i < firsts_.size(); ++i) {
      first_in_[holders_[firsts_[i]]] = kNobody;
      if (is_candidate_[i] == 0) continue;
      if (count == candidates_.size()) candidates_.emplace_back();
      candidates_[count++].vertex = firsts_[i];
    }
    candidates_.resize(count);
  }

  std::uint64_t claim_of(VertexNumber v) const { return Claims<D>::claim_of(round_, order_[v]); }
  void dig(Candidate& candidate) {
    const VertexNumber v = candidate.vertex;
    claims_.dig(mesh_, space_, holders_[v], v, claim_of(v), candidate.finder, candidate.hole);
  }
  void check(Candidate& candidate) {
    candidate.is_winner = claims_.holds(mesh_, candidate.hole, claim_of(candidate.vertex));
  }

  void give_slots() {
    std::size_t wanted = 0;
    for (Candidate& candidate : candidates_) {
      lost_ += candidate.is_winner ? 0 : 1;
      if (!candidate.is_winner) continue;
      candidate.slots = candidate.hole.removed;
      while (candidate.slots.size() < candidate.hole.star()) {
        if (free_.empty()) {
          candidate.slots.push_back(used_++);
        } else {
          candidate.slots.push_back(free_.back());
          free_.pop_back();
        }
      }
      wanted = used_;
    }
    if (wanted > mesh_.size()) grow(wanted);
    for (const Candidate& candidate : candidates_) {
      if (!candidate.is_winner) continue;
      for (std::size_t i = candidate.hole.star(); i < candidate.slots.size(); ++i) {
        free_.push_back(candidate.slots[i]);
      }
    }
  }

  void grow(std::size_t wanted) {
    if (wanted > kMaximumSimplices) throw std::bad_alloc();
    const std::size_t size = std::min(kMaximumSimplices, 2 * wanted);
    mesh_.grow(size);
    claims_.resize(size);
    first_in_.resize(size, kNobody);
    replaced_by_.resize(size, kNotReplaced);
    if (!creators_.empty()) creators_.resize(size);
  }

  void fill(Candidate& candidate) {
    if (!candidate.is_winner) return;
    const Hole<D>& hole = candidate.hole;
    candidate.filler.fill(mesh_, hole, candidate.vertex,
                          std::span(candidate.slots).first(hole.star()));
    for (std::size_t i = hole.star(); i < candidate.slots.size(); ++i) {
      mesh_.set_vertex(corner_of(candidate.slots[i], 0), kDeadVertex);
    }
    for (const SimplexNumber t : hole.removed) replaced_by_[t] = candidate.slots.front();
    for (std::size_t i = 0; i < hole.star() && !creators_.empty(); ++i) {
      creators_[candidate.slots[i]] = static_cast<std::uint16_t>(parallel::arena_thread());
    }
    holders_[candidate.vertex] = kNotReplaced;
  }

  std::size_t drop_inserted() {
    return std::erase_if(waiting_, [&](VertexNumber v) { return holders_[v] == kNotReplaced; });
  }
  void follow(VertexNumber v) {
    const SimplexNumber start = replaced_by_[holders_[v]];
    if (start != kNotReplaced) locate(v, start);
  }
  void forget_replacements(const Candidate& candidate) {
    if (!candidate.is_winner) return;
    for (const SimplexNumber t : candidate.hole.removed) replaced_by_[t] = kNotReplaced;
  }

  PointSpace<D> space_;
  const Options& options_;
  Mesh<D> mesh_;
  SimplexNumber used_ = D + 2;
  std::vector<SimplexNumber> free_;
  Claims<D> claims_;
  std::vector<std::uint32_t> first_in_;     // per simplex, in `order_`
  std::vector<SimplexNumber> replaced_by_;  // per simplex that a round removed
  std::vector<std::uint16_t> creators_;     // per simplex, or none
  std::vector<SimplexNumber> holders_;      // per vertex that waits: the simplex that it lies in
  std::vector<std::uint32_t> order_;        // per vertex
  std::vector<VertexNumber> waiting_, firsts_;
  std::vector<std::uint8_t> is_candidate_;  // of `firsts_`
  std::vector<Candidate> candidates_;
  std::uint64_t round_ = 0, lost_ = 0;
  Statistics seconds_;
};

}  // namespace

Result insert_independent_sets(PointView<double> points, const Options& options) {
  return insert_distinct<IndependentSets>(points, options);
}

}  // namespace delray::delaunay::internal
