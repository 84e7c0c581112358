// Terrains in parts (after Puppo, Davis, De Menthon and Teng 1994; Kohout 2004, 5.2.2): each part
// inserts its own farthest places, one after the other, all parts at the same time.
//
// Puppo et al. insert a place of every triangle at once. Here levels of error keep near to the
// order of one thread: nothing within half of what is allowed now is inserted before everything
// beyond it. At each level triangles are cut into columns, and these into cells, with about as many
// candidates in each. A part writes its own triangles only, and reads no others: what reaches out
// of it waits until the cuts have moved, and in the end for the order of one thread.
//
// Columns, cells and the room of a part follow from the candidates alone, so threads change
// nothing. Degenerate: where all candidates have one x and y, or are few, one thread does
// everything.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <span>
#include <utility>

#include "delaunay/cavity/hole.h"
#include "delaunay/cavity/point_space.h"
#include "delaunay/points/simplification.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay::internal {
namespace {

constexpr std::size_t kEnoughTriangles = 512;
constexpr std::size_t kEnoughCandidates = 512;
constexpr double kCandidatesPerPart = 128;  // a part has many more triangles inside than at its rim
constexpr std::size_t kMostColumns = 64;
constexpr std::size_t kSlotsPerCandidate = 5;  // an insertion takes two
constexpr int kMostLevels = 16;
constexpr int kMostCuts = 8;  // of a level
constexpr std::size_t kSamples = 16384;

// Where [0, 1) is cut into `parts`, all but the first cut moved by `shift` of a part.
std::vector<double> cuts_of(std::vector<double>& sample, std::size_t parts, double shift) {
  std::ranges::sort(sample);
  std::vector<double> cuts;
  for (std::size_t i = 1; i <= parts; ++i) {
    const double at = (static_cast<double>(i) - shift) / static_cast<double>(parts);
    const auto place = static_cast<std::size_t>(at * static_cast<double>(sample.size()));
    if (place < sample.size()) cuts.push_back(sample[place]);
  }
  return cuts;
}

std::size_t interval_of(const std::vector<double>& cuts, double x) {
  return static_cast<std::size_t>(std::ranges::upper_bound(cuts, x) - cuts.begin());
}

// Columns of about as many points of a sample, and as many cells in each.
class Grid {
 public:
  Grid(const std::vector<glm::dvec2>& sample, std::size_t columns, double shift) {
    std::vector<double> xs;
    xs.reserve(sample.size());
    for (const glm::dvec2& p : sample) xs.push_back(p.x);
    columns_ = cuts_of(xs, columns, shift);
    std::vector<std::vector<double>> ys(columns_.size() + 1);
    for (const glm::dvec2& p : sample) ys[interval_of(columns_, p.x)].push_back(p.y);
    for (std::vector<double>& y : ys) {
      first_.push_back(cells_);
      rows_.push_back(cuts_of(y, columns, shift));
      cells_ += rows_.back().size() + 1;
    }
  }
  std::size_t size() const { return cells_; }
  std::size_t operator()(const glm::dvec2& p) const {
    const std::size_t column = interval_of(columns_, p.x);
    return first_[column] + interval_of(rows_[column], p.y);
  }

 private:
  std::vector<double> columns_;
  std::vector<std::vector<double>> rows_;  // by column
  std::vector<std::size_t> first_;         // number of a column's first cell
  std::size_t cells_ = 0;
};

}  // namespace

// The parts of one cut of the triangles.
class Simplification::Parts {
 public:
  Parts(Simplification& terrain, const PointSpace<2>& space) : terrain_(terrain), space_(space) {}

  // Inserts what has an error above `least` and touches one part only. Returns how many places.
  std::size_t refine(const std::vector<Entry>& entries, double shift, double least) {
    cut(entries, shift);
    std::vector<std::size_t> inserted(parts_.size());
    parallel::parallel_for(0, parts_.size(), 1, [&](std::size_t i) {
      inserted[i] = refine_part(static_cast<PartNumber>(i), least);
    });
    std::size_t sum = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      sum += inserted[i];
      free_.insert(free_.end(), parts_[i].slots.begin(), parts_[i].slots.end());
    }
    return sum;
  }

 private:
  using PartNumber = std::uint16_t;
  struct Part {
    std::vector<Entry> entries;
    std::vector<SimplexNumber> slots;
  };
  // What a part needs for its insertions.
  struct Work {
    HoleFinder<2> finder;
    StarFiller<2> filler;
    Hole<2> hole;
    std::vector<SimplexNumber> slots;
    std::vector<CornerNumber> star;
    std::vector<std::uint32_t> orphans;
    std::vector<Run> runs;
  };

  // A triangle goes where its lowest vertex lies.
  std::size_t part_of(const Grid& grid, SimplexNumber t) const {
    std::uint32_t lowest = kInfiniteVertex;
    for (unsigned k = 0; k < 3; ++k) lowest = std::min(lowest, terrain_.mesh_.vertex(t, k));
    return grid(terrain_.places_.points[lowest]);
  }

  void cut(const std::vector<Entry>& entries, double shift) {
    // Sampled by place: slots depend on threads.
    const std::size_t stride = entries.size() / kSamples + 1;
    std::vector<glm::dvec2> sample;
    for (const Entry& entry : entries) {
      if (entry.candidate.place % stride == 0)
        sample.push_back(terrain_.places_.points[entry.candidate.place]);
    }
    const auto columns = static_cast<std::size_t>(
        std::sqrt(static_cast<double>(entries.size()) / kCandidatesPerPart));
    const Grid grid(sample, std::clamp(columns, std::size_t{1}, kMostColumns), shift);
    parts_.assign(grid.size(), {});
    const std::size_t slots = make_room(kSlotsPerCandidate * entries.size());
    part_of_.resize(terrain_.mesh_.size());
    constexpr std::size_t kGrain = 4096;
    parallel::parallel_for(0, terrain_.access_.used(), kGrain, [&](std::size_t t) {
      const auto triangle = static_cast<SimplexNumber>(t);
      if (!terrain_.mesh_.is_dead(triangle))
        part_of_[t] = static_cast<PartNumber>(part_of(grid, triangle));
    });
    for (const Entry& entry : entries) parts_[part_of_[entry.triangle]].entries.push_back(entry);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      Part& part = parts_[i];
      const std::size_t wanted = slots / entries.size() * part.entries.size();
      part.slots.assign(free_.end() - static_cast<std::ptrdiff_t>(wanted), free_.end());
      free_.resize(free_.size() - wanted);
      for (const SimplexNumber t : part.slots) part_of_[t] = static_cast<PartNumber>(i);
    }
  }

  // Sees to so many free slots, or as many as leave enough for all places. Returns how many.
  std::size_t make_room(std::size_t wanted) {
    wanted = std::min(wanted, terrain_.mesh_.size() - 2 * terrain_.places_.points.size());
    if (free_.size() >= wanted) return wanted;
    const SimplexNumber used = terrain_.access_.used();
    const std::size_t end = used + wanted - free_.size();
    constexpr std::size_t kGrain = 8192;
    parallel::parallel_for(used, end, kGrain, [&](std::size_t t) {
      const auto slot = static_cast<SimplexNumber>(t);
      terrain_.mesh_.set_vertex(corner_of(slot, 0), kDeadVertex);
      terrain_.start_lists(slot);
    });
    for (std::size_t t = end; t-- > used;) free_.push_back(static_cast<SimplexNumber>(t));
    terrain_.access_ = SoleAccess(static_cast<SimplexNumber>(end));
    return wanted;
  }

  std::size_t refine_part(PartNumber number, double least) {
    Part& part = parts_[number];
    Work work;
    std::priority_queue<Entry> queue(std::less<Entry>(), std::move(part.entries));
    std::size_t inserted = 0;
    while (!queue.empty() && part.slots.size() >= 2) {
      const Entry entry = queue.top();
      queue.pop();
      if (terrain_.candidates_[entry.triangle] != entry.candidate) continue;
      if (!insert(entry, number, work)) continue;
      ++inserted;
      for (const CornerNumber corner : work.star) {
        const SimplexNumber t = simplex_of(corner);
        const Candidate& candidate = terrain_.candidates_[t];
        if (candidate.place != kNoPlace && candidate.error > least) queue.push({candidate, t});
      }
    }
    if (terrain_.progress_ != nullptr) terrain_.progress_->advance(inserted);
    return inserted;
  }

  // False, having written nothing, where the cavity or what is next to it is not the part's own.
  bool insert(const Entry& entry, PartNumber number, Work& work) {
    if (part_of_[entry.triangle] != number) return false;
    const std::uint32_t place = entry.candidate.place;
    const bool is_own = work.finder.find(terrain_.mesh_, entry.triangle, work.hole,
                                         [&](SimplexNumber t) -> std::optional<bool> {
                                           if (part_of_[t] != number) return std::nullopt;
                                           return space_.conflicts(terrain_.mesh_, t, place);
                                         });
    if (!is_own) return false;
    work.orphans.clear();
    for (const SimplexNumber t : work.hole.removed) terrain_.take_places(t, place, work.orphans);
    // Triangles and ghosts are a sphere: a star has two more than its hole.
    work.slots = work.hole.removed;
    assert(work.hole.star() == work.slots.size() + 2);
    std::vector<SimplexNumber>& free = parts_[number].slots;
    for (int i = 0; i < 2; ++i) {
      work.slots.push_back(free.back());
      free.pop_back();
    }
    work.filler.fill(terrain_.mesh_, work.hole, place, work.slots);
    terrain_.is_kept_[place] = 1;
    terrain_.find_star(place, work.slots.front(), work.star);
    terrain_.share_out(place, work.star, work.orphans, work.runs);
    return true;
  }

  Simplification& terrain_;
  const PointSpace<2>& space_;
  std::vector<Part> parts_;
  std::vector<PartNumber> part_of_;  // by triangle and free slot of a part
  std::vector<SimplexNumber> free_;  // dead
};

void Simplification::refine_in_parts() {
  refine(kEverything, kEnoughTriangles);
  SimplexNumber finite = 0;
  while (mesh_.is_ghost(finite)) ++finite;
  std::array<VertexNumber, 3> first{};
  for (unsigned k = 0; k < 3; ++k) first[k] = mesh_.vertex(finite, k);
  const PointSpace<2> space(places_.points, first);
  Parts parts(*this, space);
  double level = 0;
  for (const Entry& entry : candidates_above(kEverything)) {
    if (std::isfinite(entry.candidate.error)) level = std::max(level, entry.candidate.error);
  }
  for (int i = 1; level != kEverything; ++i) {
    level = i < kMostLevels && level / 2 > max_error_ ? level / 2 : kEverything;
    std::size_t inserted = std::numeric_limits<std::size_t>::max();
    for (int cut = 0; cut < kMostCuts; ++cut) {
      const std::vector<Entry> entries = candidates_above(level);
      if (entries.size() < kEnoughCandidates || inserted < entries.size() / 4) break;
      constexpr double kShifts[] = {0, 0.5, 0.25, 0.75};
      inserted = parts.refine(entries, kShifts[cut % 4], level);
    }
    refine(level, kMaximumSimplices);
  }
}

}  // namespace delray::delaunay::internal
