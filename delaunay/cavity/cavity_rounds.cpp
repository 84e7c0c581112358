// Insertion of ordered points into a 3D Delaunay mesh, by one thread or by several without locks.
//
// A round is inserted in up to three passes. Each pass cuts the points that are left at medians,
// along another axis than the pass before, into one box for each thread; a kernel changes only
// simplices whose finite vertices all lie in its box (cavity.h). Points whose cavity reaches beyond
// the box wait for the next pass, and the last of them for a single thread. Expected O(n log n) for
// evenly spread points; a pass adds O(points left * threads) tests against boxes.
//
// Degenerate: a round with too few points for two boxes is inserted by one thread, and so is the
// rest of a round once a pass has inserted few of its points.
#include "delaunay/cavity/cavity_rounds.h"

#include <algorithm>
#include <array>
#include <deque>
#include <new>
#include <numeric>
#include <utility>
#include <vector>

#include "delaunay/cavity/cavity_inserter.h"
#include "delaunay/cavity/regions.h"
#include "delaunay/mesh/slot_pool.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay::internal {
namespace {

// A pass costs a region so many points to be worth while: starting a thread takes some tens
// of microseconds, and most of the points of a small region are at its boundary.
constexpr std::size_t kPointsPerRegion = 500;
// The part of a pass's points that must have been inserted for another pass to be tried.
constexpr double kWorthwhile = 0.25;
constexpr int kPasses = 3;
constexpr std::size_t kMaximumParts = std::size_t{1} << Box3Region::kMaximumCuts;

using Kernel = CavityInserter<Box3Region>;

template <class Region>
void collect(const CavityInserter<Region>& inserter, Inserted& sum) {
  sum.distinct += inserter.inserted();
  sum.locate_seconds += inserter.locate_seconds();
  sum.subdivide_seconds += inserter.subdivide_seconds();
}

class ParallelInsertion {
 public:
  ParallelInsertion(const CavityInput& input, const Options& options)
      : input_(input),
        vertices_(input.order.vertices.data()),
        pool_(input.used, input.mesh.size()),
        threads_(static_cast<std::size_t>(options.threads)) {
    for (std::size_t t = 0; t < threads_; ++t) {
      kernels_.emplace_back(input.mesh, vertices_, input.tests, pool_, options.progress,
                            options.statistics);
    }
    if (options.created_by) created_by_.assign(input.mesh.size(), 0);
    const glm::dvec3 size = input.range.high * 0.5 - input.range.low * 0.5;
    std::iota(axes_.begin(), axes_.end(), 0);
    std::sort(axes_.begin(), axes_.end(), [&](int i, int j) { return size[i] > size[j]; });
  }

  void insert_round(VertexNumber first, VertexNumber last) {
    std::vector<VertexNumber> waiting;
    for (VertexNumber vertex = first; vertex < last; ++vertex) {
      if (std::ranges::find(input_.start, vertex) == input_.start.end()) waiting.push_back(vertex);
    }
    for (int pass = 0; pass < kPasses; ++pass) {
      const std::size_t parts =
          std::min({threads_, waiting.size() / kPointsPerRegion, kMaximumParts});
      if (parts < 2) break;
      const std::size_t before = waiting.size();
      insert_pass(waiting, parts, pass);
      if (static_cast<double>(before - waiting.size()) < kWorthwhile * static_cast<double>(before))
        break;
    }
    insert_rest(waiting);
  }

  Inserted finish() {
    Inserted result;
    result.distinct = input_.start.size();
    for (Kernel& inserter : kernels_) {
      inserter.kernel().retire_unused_slots();
      collect(inserter, result);
    }
    input_.mesh.shrink(pool_.used());
    result.created_by = std::move(created_by_);
    return result;
  }

 private:
  const glm::dvec3& at(VertexNumber vertex) const { return vertices_[vertex + 1U].position; }

  void grow_mesh() {
    grow(input_.mesh);
    pool_.extend(input_.mesh.size());
    if (!created_by_.empty()) created_by_.resize(input_.mesh.size(), 0);
  }
  // Before the calling thread inserts with a kernel.
  void note_creator(Kernel& inserter) {
    if (created_by_.empty()) return;
    const auto thread = static_cast<std::uint16_t>(parallel::arena_thread());
    inserter.kernel().note_creator(created_by_.data(), thread);
  }

  // Cuts the region of `sample` into `parts`.
  void cut(std::span<glm::dvec3> sample, std::size_t parts, int depth, const Box3Region& region,
           std::vector<Box3Region>& regions, int pass) const {
    if (parts == 1) return regions.push_back(region);
    // Another axis in every pass; the shift is for cuts along all axes at once.
    constexpr std::array<double, kPasses> kShift = {0, -0.1, 0.1};
    const std::size_t low = parts / 2;
    const double share = static_cast<double>(low) / static_cast<double>(parts) +
                         (parts > 2 ? kShift[static_cast<std::size_t>(pass)] : 0);
    const auto middle = static_cast<std::ptrdiff_t>(share * static_cast<double>(sample.size()));
    const int axis = axes_[static_cast<std::size_t>(pass + depth) % 3];
    std::nth_element(sample.begin(), sample.begin() + middle, sample.end(),
                     [axis](const auto& p, const auto& q) { return p[axis] < q[axis]; });
    const double plane = sample[static_cast<std::size_t>(middle)][axis];
    const auto below = static_cast<std::size_t>(middle);
    cut(sample.first(below), low, depth + 1, region.cut(axis, plane, true), regions, pass);
    cut(sample.subspan(below), parts - low, depth + 1, region.cut(axis, plane, false), regions,
        pass);
  }

  std::vector<Box3Region> cut_regions(std::span<const VertexNumber> waiting, std::size_t parts,
                                      int pass) const {
    constexpr std::size_t kSamplesPerPart = 1024;
    std::vector<glm::dvec3> sample(std::min(waiting.size(), parts * kSamplesPerPart));
    for (std::size_t i = 0; i < sample.size(); ++i) {
      sample[i] = at(waiting[i * waiting.size() / sample.size()]);
    }
    std::vector<Box3Region> regions;
    cut(sample, parts, 0, {}, regions, pass);
    return regions;
  }

  // Simplices of the region from which searches may start: place i, if there is one, is near
  // vertices at a share of i / size of the way through `waiting`.
  using Starts = std::array<SimplexNumber, 128>;
  static constexpr SimplexNumber kNone = 0xffffffffU;

  Starts find_starts(Kernel& inserter, const Box3Region& region,
                     std::span<const VertexNumber> waiting) const {
    Starts starts;
    Cavity<Box3Region>& kernel = inserter.kernel();
    SimplexNumber from = some_simplex_;
    for (std::size_t i = 0; i < starts.size(); ++i) {
      starts[i] = kNone;
      const VertexNumber vertex = waiting[(2 * i + 1) * waiting.size() / (2 * starts.size())];
      if (!region.contains(at(vertex))) continue;
      kernel.set_region({});
      kernel.start_at(from);
      SimplexNumber place = 0;
      kernel.locate(vertex, place);
      if (input_.mesh.is_ghost(place)) {
        place = simplex_of(input_.mesh.neighbour(corner_of(place, 3)));
      }
      from = place;
      kernel.set_region(region);
      if (kernel.owns(place)) starts[i] = place;
    }
    return starts;
  }

  // Inserts the vertices of the region as far as it can, and notes which. False if slots are
  // missing.
  bool insert_region(Kernel& inserter, const Box3Region& region, const Starts& starts,
                     std::span<const VertexNumber> waiting, std::vector<std::uint8_t>& done) const {
    // A search that gets nowhere may be shut in by simplices of others; so many in a row are not
    // all hindered by where they go.
    constexpr std::size_t kFailures = 4;
    const auto first = std::ranges::find_if(starts, [](auto start) { return start != kNone; });
    if (first == starts.end()) return true;
    inserter.kernel().start_at(*first);
    std::size_t failures = 0;
    for (std::size_t i = 0; i < waiting.size(); ++i) {
      if (!region.contains(at(waiting[i]))) continue;
      Insertion result = inserter.insert(waiting[i]);
      if (result == Insertion::kElsewhere && failures++ % kFailures == 0) {
        const SimplexNumber start = starts[i * starts.size() / waiting.size()];
        if (start == kNone || input_.mesh.is_dead(start) || input_.mesh.is_ghost(start)) continue;
        inserter.kernel().start_at(start);
        result = inserter.insert(waiting[i]);
      }
      if (result == Insertion::kFull) return false;
      if (result == Insertion::kElsewhere) continue;
      failures = 0;
      done[i] = 1;
    }
    return true;
  }

  // Leaves in `waiting`, in the same order, what could not be inserted.
  void insert_pass(std::vector<VertexNumber>& waiting, std::size_t parts, int pass) {
    const std::vector<Box3Region> regions = cut_regions(waiting, parts, pass);
    std::vector<std::uint8_t> done(waiting.size(), 0);
    std::vector<Starts> starts;
    for (std::size_t t = 0; t < parts; ++t) {
      starts.push_back(find_starts(kernels_[t], regions[t], waiting));
    }
    std::vector<std::uint8_t> has_room(parts), has_inserted(parts);
    parallel::parallel_for(0, parts, 1, [&](std::size_t t) {
      const std::uint64_t before = kernels_[t].inserted();
      note_creator(kernels_[t]);
      has_room[t] = insert_region(kernels_[t], regions[t], starts[t], waiting, done) ? 1 : 0;
      has_inserted[t] = kernels_[t].inserted() > before ? 1 : 0;
    });
    for (std::size_t t = 0; t < parts; ++t) {
      // Only the kernel itself could have removed the simplex that it made last.
      if (has_inserted[t] != 0) some_simplex_ = kernels_[t].kernel().last_simplex();
    }
    std::size_t left = 0;
    for (std::size_t i = 0; i < waiting.size(); ++i) {
      if (done[i] == 0) waiting[left++] = waiting[i];
    }
    waiting.resize(left);
    if (std::ranges::find(has_room, 0) != has_room.end()) grow_mesh();
  }

  void insert_rest(std::span<const VertexNumber> waiting) {
    Kernel& inserter = kernels_.front();
    inserter.kernel().set_region({});
    inserter.kernel().start_at(some_simplex_);
    note_creator(inserter);
    for (const VertexNumber vertex : waiting) {
      while (inserter.insert(vertex) == Insertion::kFull) {
        grow_mesh();
        note_creator(inserter);
      }
    }
    some_simplex_ = inserter.kernel().last_simplex();
  }

  const CavityInput& input_;
  SpaceVertex* vertices_;
  SlotPool pool_;
  std::size_t threads_;
  std::vector<std::uint16_t> created_by_;  // by slot; empty if nobody wants to know
  std::deque<Kernel> kernels_;
  std::array<int, 3> axes_;         // longest extent first
  SimplexNumber some_simplex_ = 0;  // finite and alive
};

}  // namespace

void grow(Mesh<3>& mesh) {
  const std::size_t size = std::min(mesh.size() + mesh.size() / 2, kMaximumSimplices);
  if (size == mesh.size()) throw std::bad_alloc();
  mesh.grow(size);
}

Inserted insert_alone(const CavityInput& input, const Options& options) {
  SlotPool pool(input.used, input.mesh.size());
  CavityInserter<Everywhere> inserter(input.mesh, input.order.vertices.data(), input.tests, pool,
                                      options.progress, options.statistics);
  inserter.kernel().start_at(0);
  for (VertexNumber vertex = 0; vertex + 1 < input.order.vertices.size(); ++vertex) {
    if (std::ranges::find(input.start, vertex) != input.start.end()) continue;
    while (inserter.insert(vertex) == Insertion::kFull) {
      grow(input.mesh);
      pool.extend(input.mesh.size());
    }
  }
  inserter.kernel().retire_unused_slots();
  input.mesh.shrink(pool.used());
  Inserted result;
  result.distinct = input.start.size();
  collect(inserter, result);
  return result;
}

Inserted insert_in_parallel(const CavityInput& input, const Options& options) {
  ParallelInsertion insertion(input, options);
  const std::vector<std::uint32_t>& rounds = input.order.rounds;
  for (std::size_t round = 0; round + 1 < rounds.size(); ++round) {
    insertion.insert_round(rounds[round], rounds[round + 1]);
  }
  return insertion.finish();
}

}  // namespace delray::delaunay::internal
