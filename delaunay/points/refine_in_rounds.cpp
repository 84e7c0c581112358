// Terrains in rounds (Puppo, Davis, De Menthon and Teng 1994; Kohout 2004, 5.2.2): every triangle
// offers its candidate, and those are inserted whose cavities share nothing, the farther before the
// nearer.
//
// Candidates that a better one is near of wait for another round without further ado.
//
// Puppo et al. let two triangles at an edge agree on who goes first, and flip afterwards under the
// same rule; here whole cavities are claimed (cavity/claims.h), which comes to the same
// triangulation. A round's winners write nothing in common, so that they fill their cavities, share
// out the places in them and look for new candidates at the same time.
#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "delaunay/cavity/claims.h"
#include "delaunay/cavity/hole.h"
#include "delaunay/points/simplification.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay::internal {

struct Simplification::Insertion {
  Entry entry;
  std::uint64_t claim = 0;
  bool is_winner = false;
  Hole<2> hole;
  HoleFinder<2> finder;
  StarFiller<2> filler;
  std::vector<SimplexNumber> slots;  // for its star, then those that are left over
  std::vector<CornerNumber> star;
  std::vector<std::uint32_t> orphans;
};

void Simplification::fill_star(Insertion& insertion) {
  const std::uint32_t place = insertion.entry.candidate.place;
  insertion.orphans.clear();
  for (const SimplexNumber t : insertion.hole.removed) take_places(t, place, insertion.orphans);
  const std::size_t star = insertion.hole.star();
  insertion.filler.fill(mesh_, insertion.hole, place, std::span(insertion.slots).first(star));
  for (std::size_t i = star; i < insertion.slots.size(); ++i) {
    mesh_.set_vertex(corner_of(insertion.slots[i], 0), kDeadVertex);
    candidates_[insertion.slots[i]] = {};
  }
  is_kept_[place] = 1;
  find_star(place, insertion.slots.front(), insertion.star);
  share_out(place, insertion.star, insertion.orphans);
}

// Slots for the stars of the winners.
void Simplification::reserve_round(std::vector<Insertion>& insertions,
                                   std::vector<SimplexNumber>& free) {
  std::vector<SimplexNumber> left_over;
  std::size_t wanted = 0;
  for (const Insertion& insertion : insertions) {
    wanted += insertion.is_winner ? insertion.hole.star() : 0;
  }
  reserve(access_.used() + wanted);
  for (Insertion& insertion : insertions) {
    if (!insertion.is_winner) continue;
    insertion.slots = insertion.hole.removed;
    while (insertion.slots.size() < insertion.hole.star()) {
      if (free.empty()) {
        insertion.slots.push_back(access_.create());
      } else {
        insertion.slots.push_back(free.back());
        free.pop_back();
      }
    }
    left_over.insert(left_over.end(),
                     insertion.slots.begin() + static_cast<std::ptrdiff_t>(insertion.hole.star()),
                     insertion.slots.end());
  }
  free.insert(free.end(), left_over.begin(), left_over.end());
}

void Simplification::refine_in_rounds() {
  std::array<VertexNumber, 3> first{};
  SimplexNumber finite = 0;
  while (mesh_.is_ghost(finite)) ++finite;
  for (unsigned k = 0; k < 3; ++k) first[k] = mesh_.vertex(finite, k);
  const PointSpace<2> space(places_.points, first);
  Claims<2> claims(mesh_.size());
  std::vector<SimplexNumber> free;
  std::vector<Insertion> insertions;
  std::vector<Entry> entries;
  for (SimplexNumber t = 0; t < access_.used(); ++t) {
    if (candidates_[t].place != kNoPlace) entries.push_back({candidates_[t], t});
  }
  const auto for_entries = [&](std::size_t grain, const auto& f) {
    constexpr std::size_t kFew = 16;  // not worth waking threads
    if (entries.size() > kFew) return parallel::parallel_for(0, entries.size(), grain, f);
    for (std::size_t i = 0; i < entries.size(); ++i) f(i);
  };
  for (std::uint64_t round = 0; !entries.empty(); ++round) {
    std::ranges::sort(entries, [](const Entry& a, const Entry& b) { return b < a; });
    // A triangle of a star may be in the slot, and have the candidate, of one that was removed.
    const auto copies = std::ranges::unique(entries, {}, [](const Entry& entry) {
      return std::pair(entry.triangle, entry.candidate.place);
    });
    entries.erase(copies.begin(), copies.end());
    insertions.resize(entries.size());
    for_entries(16, [&](std::size_t i) {
      Insertion& own = insertions[i];
      own.entry = entries[i];
      own.is_winner = is_best_around(mesh_, own.entry.triangle, [&](SimplexNumber t) {
        return candidates_[t].place != kNoPlace && own.entry < Entry{candidates_[t], t};
      });
      if (!own.is_winner) return;
      own.claim = Claims<2>::claim_of(round, static_cast<std::uint32_t>(i));
      claims.dig(mesh_, space, own.entry.triangle, own.entry.candidate.place, own.claim, own.finder,
                 own.hole);
    });
    for_entries(64, [&](std::size_t i) {
      Insertion& own = insertions[i];
      own.is_winner = own.is_winner && claims.holds(mesh_, own.hole, own.claim);
    });
    reserve_round(insertions, free);
    claims.resize(mesh_.size());
    for_entries(1, [&](std::size_t i) {
      if (insertions[i].is_winner) fill_star(insertions[i]);
    });
    entries.clear();
    std::size_t inserted = 0;
    for (const Insertion& insertion : insertions) {
      // Those of removed triangles have other ones now.
      if (!insertion.is_winner) {
        const Entry& entry = insertion.entry;
        if (candidates_[entry.triangle] == entry.candidate) entries.push_back(entry);
        continue;
      }
      ++inserted;
      for (const CornerNumber corner : insertion.star) {
        const SimplexNumber t = simplex_of(corner);
        if (candidates_[t].place != kNoPlace) entries.push_back({candidates_[t], t});
      }
    }
    if (progress_ != nullptr) progress_->advance(inserted);
  }
}

}  // namespace delray::delaunay::internal
