// Every simplex belongs to a region, and is read and written under the lock of that region alone. A
// thread waits for the lock of its own region while it holds no other; others it only tries, and
// where it does not get one it gives the insertion up for now. So there are no deadlocks. What
// could not be inserted after a few attempts waits for the next round; after the last, one thread
// inserts the rest.
//
// Simplices that fill a cavity go to the regions of those that they replace, so that borders move
// little. Rounds double, random among all points (Amenta, Choi and Rote 2003); before each, regions
// are cut as intervals of a Hilbert curve with as many points to insert.
//
// Degenerate: a cavity that reaches into all regions stops all threads but one.
#include "delaunay/cavity/chrisochoides.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <new>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "delaunay/cavity/hole.h"
#include "delaunay/cavity/insert_distinct.h"
#include "delaunay/cavity/point_space.h"
#include "delaunay/mesh/extract.h"
#include "delaunay/mesh/start_mesh.h"
#include "delaunay/mesh/stopwatch.h"
#include "delaunay/mesh/xorshift.h"
#include "parallel/progress.h"
#include "parallel/team.h"

namespace delray::delaunay::internal {
namespace {

using RegionNumber = std::uint16_t;

constexpr RegionNumber kNoRegion = 0xffff;
constexpr int kAttempts = 3;                   // in a round
constexpr std::size_t kCoarsePerThread = 100;  // points: a region is large beside a cavity

struct alignas(64) Region {
  std::mutex mutex;
  SimplexNumber entry = 0;  // one of its simplices; under the lock
  std::vector<VertexNumber> points;
  std::vector<SimplexNumber> slots;  // free ones of its thread
  std::vector<VertexNumber> left;    // for the next round
  Synchronization counts;
};

// What all threads share.
template <int D>
struct RegionMesh {
  PointSpace<D> space;
  Mesh<D> mesh;
  std::vector<RegionNumber> owners;     // per simplex
  std::vector<std::uint16_t> creators;  // per simplex, or none
  std::vector<Region> regions;
};

// Regions that a thread has locked.
class HeldRegions {
 public:
  HeldRegions(std::vector<Region>& regions, RegionNumber own) : regions_(regions), held_({own}) {
    regions_[own].mutex.lock();
  }
  ~HeldRegions() {
    for (const RegionNumber region : held_) regions_[region].mutex.unlock();
  }
  HeldRegions(const HeldRegions&) = delete;
  HeldRegions& operator=(const HeldRegions&) = delete;

  // Whether the region is held now.
  bool hold(RegionNumber region) {
    if (std::ranges::find(held_, region) != held_.end()) return true;
    Synchronization& counts = regions_[held_.front()].counts;
    ++counts.lock_calls;
    if (!regions_[region].mutex.try_lock()) {
      ++counts.waits;
      return false;
    }
    ++counts.free;
    held_.push_back(region);
    return true;
  }

 private:
  std::vector<Region>& regions_;
  std::vector<RegionNumber> held_;
};

// A thread and its region.
template <int D>
class RegionThread {
 public:
  RegionThread(RegionMesh<D>& shared, RegionNumber own, parallel::Progress* progress)
      : shared_(shared), own_(own), progress_(progress), random_(own * 2U + 1) {}

  void run(const parallel::Team& team) {
    Region& region = shared_.regions[own_];
    std::vector<VertexNumber> again = std::move(region.points);
    region.points.clear();
    for (int attempt = 0; attempt < kAttempts && !again.empty(); ++attempt) {
      std::vector<VertexNumber> refused;
      for (const VertexNumber v : again) {
        team.check();
        if (insert(v)) {
          if (progress_ != nullptr) progress_->advance();
        } else {
          refused.push_back(v);
          ++region.counts.rollbacks;
        }
      }
      again = std::move(refused);
    }
    region.left = std::move(again);
  }

 private:
  // Whether all regions were to be had, and slots enough.
  bool insert(VertexNumber v) {
    HeldRegions held(shared_.regions, own_);
    const SimplexNumber start = locate(v, held);
    if (start == kNoSimplex || !dig(start, v, held)) return false;
    if (!share_star_out()) return false;
    Region& region = shared_.regions[own_];
    std::vector<SimplexNumber> slots = hole_.removed;
    if (slots.size() + region.slots.size() < hole_.star()) return false;
    while (slots.size() < hole_.star()) {
      slots.push_back(region.slots.back());
      region.slots.pop_back();
    }
    filler_.fill(shared_.mesh, hole_, v, std::span(slots).first(hole_.star()));
    for (std::size_t i = 0; i < hole_.star(); ++i) {
      shared_.owners[slots[i]] = star_owners_[i];
      shared_.regions[star_owners_[i]].entry = slots[i];
      if (!shared_.creators.empty()) shared_.creators[slots[i]] = own_;
    }
    for (std::size_t i = hole_.star(); i < slots.size(); ++i) {
      shared_.mesh.set_vertex(corner_of(slots[i], 0), kDeadVertex);
      region.slots.push_back(slots[i]);
    }
    return true;
  }

  // By a visibility walk from the own region.
  SimplexNumber locate(VertexNumber v, HeldRegions& held) {
    SimplexNumber here = shared_.regions[own_].entry;
    unsigned entered = D + 1;
    while (true) {
      unsigned exit = D + 1;
      const unsigned first = next_random(random_) % (D + 1);
      for (unsigned i = 0; i <= D && exit > D; ++i) {
        const unsigned k = (first + i) % (D + 1);
        if (k != entered && shared_.space.is_beyond(shared_.mesh, here, k, v)) exit = k;
      }
      if (exit > D) return here;
      const CornerNumber next = shared_.mesh.neighbour(corner_of(here, exit));
      here = simplex_of(next);
      entered = next & 3U;
      if (!held.hold(shared_.owners[here])) return kNoSimplex;
    }
  }

  bool dig(SimplexNumber start, VertexNumber v, HeldRegions& held) {
    return finder_.find(shared_.mesh, start, hole_, [&](SimplexNumber t) -> std::optional<bool> {
      if (!held.hold(shared_.owners[t])) return std::nullopt;
      return shared_.space.conflicts(shared_.mesh, t, v);
    });
  }

  // Gives each simplex of the star to the region of the one that it replaces, and one at least to
  // each that loses any, as regions must not be empty. False if the star is too small for that.
  bool share_star_out() {
    star_owners_.clear();
    for (const CornerNumber corner : hole_.border) {
      star_owners_.push_back(shared_.owners[simplex_of(corner)]);
    }
    for (const SimplexNumber t : hole_.removed) {
      const RegionNumber owner = shared_.owners[t];
      if (std::ranges::find(star_owners_, owner) != star_owners_.end()) continue;
      const auto spare = std::ranges::find_if(star_owners_, [&](RegionNumber region) {
        return std::ranges::count(star_owners_, region) > 1;
      });
      if (spare == star_owners_.end()) return false;
      *spare = owner;
    }
    return true;
  }

  static constexpr SimplexNumber kNoSimplex = 0xffffffffU;

  RegionMesh<D>& shared_;
  RegionNumber own_;
  parallel::Progress* progress_;
  std::uint32_t random_;
  Hole<D> hole_;
  HoleFinder<D> finder_;
  StarFiller<D> filler_;
  std::vector<RegionNumber> star_owners_;  // of the simplices of the star
};

// Rounds, and the regions of each.
template <int D>
class RegionRounds {
 public:
  RegionRounds(const std::vector<Position<D>>& points, const std::array<VertexNumber, D + 1>& first,
               const Options& options)
      : options_(options),
        shared_{PointSpace<D>(points, first), Mesh<D>(D + 2), {}, {}, {}},
        used_(D + 2) {
    start_mesh(shared_.mesh, first);
    for (VertexNumber v = 0; v < points.size(); ++v) {
      if (std::ranges::find(first, v) == first.end()) waiting_.push_back(v);
    }
    std::mt19937_64 random(options.seed);
    for (std::size_t i = waiting_.size(); i > 1; --i) {
      std::swap(waiting_[i - 1], waiting_[random() % i]);
    }
  }

  void run() {
    Stopwatch watch;
    const auto threads = static_cast<std::size_t>(options_.threads);
    std::size_t done = 0;
    for (std::size_t next = kCoarsePerThread * threads; done < waiting_.size(); next *= 2) {
      const std::size_t end = std::min(next, waiting_.size());
      left_.insert(left_.end(), waiting_.begin() + static_cast<std::ptrdiff_t>(done),
                   waiting_.begin() + static_cast<std::ptrdiff_t>(end));
      insert_round(done == 0 ? 1 : threads);
      done = end;
    }
    while (!left_.empty()) insert_round(1);
    subdivide_seconds_ = watch.lap();
  }

  Result extract_with(std::span<const std::uint32_t> rows) {
    shared_.mesh.shrink(used_);
    if (!shared_.creators.empty()) shared_.creators.resize(used_);
    Result result =
        extract(std::move(shared_.mesh), rows, options_.threads, std::move(shared_.creators));
    result.statistics.synchronization = counts_;
    result.statistics.subdivide = subdivide_seconds_;
    return result;
  }

 private:
  // Of the points that are left; those that could not be inserted are left again.
  void insert_round(std::size_t threads) {
    std::ranges::sort(left_);
    make_room(threads);
    cut_regions(threads);
    parallel::Team team;
    team.run(threads, [&](std::size_t thread) {
      RegionThread<D>(shared_, static_cast<RegionNumber>(thread), options_.progress).run(team);
    });
    left_.clear();
    free_.clear();
    for (Region& region : shared_.regions) {
      left_.insert(left_.end(), region.left.begin(), region.left.end());
      free_.insert(free_.end(), region.slots.begin(), region.slots.end());
      counts_.lock_calls += region.counts.lock_calls;
      counts_.free += region.counts.free;
      counts_.waits += region.counts.waits;
      counts_.rollbacks += region.counts.rollbacks;
    }
  }

  // Slots for twice as many simplices as points have on average; more where a round found too few.
  void make_room(std::size_t threads) {
    const std::size_t wanted = (D == 2 ? 4 : 14) * left_.size() + 64 * threads;
    if (free_.size() < wanted) {
      const std::size_t first = used_;
      const std::size_t size = first + std::max(wanted - free_.size(), first / 2);
      if (size > kMaximumSimplices) throw std::bad_alloc();
      shared_.mesh.grow(size);
      shared_.owners.resize(size, kNoRegion);
      if (options_.created_by && options_.threads > 1) shared_.creators.resize(size);
      used_ = static_cast<SimplexNumber>(size);
      for (std::size_t t = size; t-- > first;) {
        shared_.mesh.set_vertex(corner_of(static_cast<SimplexNumber>(t), 0), kDeadVertex);
        free_.push_back(static_cast<SimplexNumber>(t));
      }
    }
    shared_.regions = std::vector<Region>(threads);
    for (std::size_t r = 0; r < threads; ++r) {
      const auto at = [&](std::size_t i) {
        return free_.begin() + static_cast<std::ptrdiff_t>(free_.size() * i / threads);
      };
      shared_.regions[r].slots.assign(at(r), at(r + 1));
    }
  }

  // By the lowest vertex of each simplex, which are numbered along a curve.
  void cut_regions(std::size_t threads) {
    std::vector<VertexNumber> ends;  // of all regions but the last
    for (std::size_t r = 0; r < threads; ++r) {
      const std::size_t first = left_.size() * r / threads, last = left_.size() * (r + 1) / threads;
      shared_.regions[r].points.assign(left_.begin() + static_cast<std::ptrdiff_t>(first),
                                       left_.begin() + static_cast<std::ptrdiff_t>(last));
      if (r + 1 < threads) ends.push_back(last < left_.size() ? left_[last] : kInfiniteVertex);
    }
    std::vector<std::size_t> sizes(threads);
    for (SimplexNumber t = 0; t < used_; ++t) {
      if (shared_.mesh.is_dead(t)) continue;
      VertexNumber lowest = kInfiniteVertex;
      for (unsigned k = 0; k <= D; ++k) lowest = std::min(lowest, shared_.mesh.vertex(t, k));
      const auto region =
          static_cast<RegionNumber>(std::ranges::upper_bound(ends, lowest) - ends.begin());
      shared_.owners[t] = region;
      shared_.regions[region].entry = t;
      ++sizes[region];
    }
    give_empty_regions_one(sizes);
  }

  void give_empty_regions_one(std::vector<std::size_t>& sizes) {
    SimplexNumber t = 0;
    for (std::size_t r = 0; r < sizes.size(); ++r) {
      if (sizes[r] > 0) continue;
      while (shared_.mesh.is_dead(t) || sizes[shared_.owners[t]] < 2 ||
             shared_.regions[shared_.owners[t]].entry == t) {
        ++t;
      }
      --sizes[shared_.owners[t]];
      shared_.owners[t] = static_cast<RegionNumber>(r);
      shared_.regions[r].entry = t;
      ++sizes[r];
    }
  }

  const Options& options_;
  RegionMesh<D> shared_;
  SimplexNumber used_;
  std::vector<SimplexNumber> free_;
  std::vector<VertexNumber> waiting_, left_;
  Synchronization counts_;
  double subdivide_seconds_ = 0;
};

}  // namespace

Result insert_in_regions(PointView<double> points, const Options& options) {
  return insert_distinct<RegionRounds>(points, options);
}

}  // namespace delray::delaunay::internal
