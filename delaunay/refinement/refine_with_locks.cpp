// Refinement by threads that share the mesh (Okusanya and Peraire 1996: remote simplices are
// locked, or access to them is denied).
//
// Each thread has triangles of its own and refines as if it were alone. It locks every triangle
// before it reads it; where another thread holds one, access is denied, the thread gives back what
// it holds and comes again later. So nobody waits, nothing is written before all of a cavity is
// held, and nothing has to be undone. After each round of some ten thousand points there is room
// for more, and the thread with most triangles shares them with that with fewest. What is left in
// the end, and what two threads denied each other, one thread does.
//
// Which points are added depends on who comes first; what holds of them does not.
#include <algorithm>
#include <atomic>
#include <deque>
#include <vector>

#include "delaunay/refinement/refinement_runs.h"
#include "delaunay/refinement/refiner.h"
#include "delaunay/triangulate.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay::internal {
namespace {

// Who holds which triangle, and numbers of new vertices with two triangles each.
class SharedMesh {
 public:
  SharedMesh(RefinementMesh& mesh, const RefinementLimits& limits) : mesh_(mesh), limits_(limits) {}

  // Room for so many vertices more, while nobody works. False if there may not be that many.
  bool make_room(std::size_t more) {
    const VertexNumber next = next_;
    if (next + more > limits_.most_vertices) return false;
    const std::size_t triangles = first_triangle_ + 2 * (next + more - first_vertex_);
    mesh_.vertices = next;
    mesh_.triangles = static_cast<SimplexNumber>(triangles - 2 * more);
    mesh_.reserve(more);
    end_ = static_cast<VertexNumber>(next + more);
    if (triangles > holders_.size()) {
      std::vector<std::atomic<std::uint16_t>> holders(mesh_.mesh.size());
      holders_.swap(holders);  // nobody holds any
    }
    return true;
  }
  void start() {
    next_ = first_vertex_ = mesh_.vertices;
    first_triangle_ = mesh_.triangles;
  }

  // The first of some vertices; none if there is no room.
  static constexpr VertexNumber kVertices = 64;
  VertexNumber take() {
    const VertexNumber first = next_.fetch_add(kVertices);
    if (first + kVertices <= end_) return first;
    next_.fetch_sub(kVertices);
    return kInfiniteVertex;
  }
  SimplexNumber triangle_of(VertexNumber vertex) const {
    return first_triangle_ + 2 * (vertex - first_vertex_);
  }

  bool lock(SimplexNumber t, std::uint16_t who) {
    std::uint16_t nobody = 0;
    return holders_[t].compare_exchange_strong(nobody, who, std::memory_order_acquire,
                                               std::memory_order_relaxed);
  }
  bool holds(SimplexNumber t, std::uint16_t who) const {
    return holders_[t].load(std::memory_order_relaxed) == who;
  }
  void unlock(SimplexNumber t) { holders_[t].store(0, std::memory_order_release); }

  void count_vertex() {
    if (limits_.progress != nullptr) limits_.progress->advance();
  }
  RefinementMesh& mesh() { return mesh_; }

  // All numbers that were taken are in use from now on, those of no vertex by dead triangles.
  void finish() {
    mesh_.vertices = next_;
    mesh_.triangles = triangle_of(next_);
  }

 private:
  RefinementMesh& mesh_;
  const RefinementLimits& limits_;
  std::atomic<VertexNumber> next_{0};
  VertexNumber first_vertex_ = 0, end_ = 0;
  SimplexNumber first_triangle_ = 0;
  std::vector<std::atomic<std::uint16_t>> holders_;
};

// What a thread holds in a step.
class LockingAccess {
 public:
  LockingAccess(SharedMesh& shared, std::uint16_t who) : shared_(&shared), who_(who) {}

  bool acquire(SimplexNumber t) {
    if (shared_->holds(t, who_)) return true;
    if (!shared_->lock(t, who_)) return false;
    held_.push_back(t);
    return true;
  }
  bool prepare() {
    if (next_ < end_) return true;
    const VertexNumber first = shared_->take();
    if (first == kInfiniteVertex) return false;
    next_ = first;
    end_ = first + SharedMesh::kVertices;
    return true;
  }
  static bool claim() { return true; }
  static bool keeps(SimplexNumber) { return true; }
  VertexNumber vertex() {
    shared_->count_vertex();
    triangle_ = shared_->triangle_of(next_);
    return next_++;
  }
  SimplexNumber triangle() {
    acquire(triangle_);
    return triangle_++;
  }
  void release() {
    for (const SimplexNumber t : held_) shared_->unlock(t);
    held_.clear();
  }
  // Vertices that were taken for nothing.
  std::pair<VertexNumber, VertexNumber> unused() const { return {next_, end_}; }

 private:
  SharedMesh* shared_;
  std::uint16_t who_;
  VertexNumber next_ = 0, end_ = 0;
  SimplexNumber triangle_ = 0;
  std::vector<SimplexNumber> held_;
};

using LockingRefiner = Refiner<LockingAccess>;

// Takes the vertices out that no thread used, and their triangles.
void close_gaps(RefinementMesh& mesh, SharedMesh& shared, std::deque<LockingRefiner>& refiners) {
  std::vector<bool> is_unused(mesh.vertices);
  for (LockingRefiner& refiner : refiners) {
    const auto [first, end] = refiner.access().unused();
    for (VertexNumber v = first; v < end; ++v) {
      is_unused[v] = true;
      for (const SimplexNumber t : {shared.triangle_of(v), shared.triangle_of(v) + 1}) {
        mesh.mesh.set_vertex(t, 0, kDeadVertex);
        mesh.mesh.set_vertex(t, 1, kDeadVertex);
        mesh.mesh.set_vertex(t, 2, kDeadVertex);
        mesh.set_marks(t, 0);
      }
    }
  }
  std::vector<VertexNumber> number(mesh.vertices);
  VertexNumber next = 0;
  for (VertexNumber v = 0; v < mesh.vertices; ++v) {
    number[v] = next;
    if (is_unused[v]) continue;
    mesh.points[next] = mesh.points[v];
    mesh.acute[next] = mesh.acute[v];
    mesh.ends[next++] = mesh.ends[v];
  }
  mesh.vertices = next;
  // Ends are vertices from before.
  for (SimplexNumber t = 0; t < mesh.triangles; ++t) {
    for (unsigned k = 0; k < 3; ++k) {
      const VertexNumber v = mesh.mesh.vertex(t, k);
      if (v < number.size()) mesh.mesh.set_vertex(t, k, number[v]);
    }
  }
}

void balance(std::deque<LockingRefiner>& refiners) {
  const auto fewer = [](const LockingRefiner& a, const LockingRefiner& b) {
    return a.triangles() < b.triangles();
  };
  for (std::size_t i = 0; i + 1 < refiners.size(); ++i) {
    const auto [fewest, most] = std::minmax_element(refiners.begin(), refiners.end(), fewer);
    if (most->triangles() < 2 * fewest->triangles() + 2) return;
    most->share(*fewest);
  }
}

}  // namespace

void refine_with_locks(RefinementMesh& mesh, const TriangleBounds& bounds,
                       const RefinementLimits& limits, RefineCounts& counts) {
  const auto threads = static_cast<std::size_t>(std::clamp(limits.threads, 1, kMostThreads));
  SharedMesh shared(mesh, limits);
  shared.start();
  std::deque<LockingRefiner> refiners;
  for (std::size_t i = 0; i < threads; ++i) {
    refiners.emplace_back(mesh, bounds, LockingAccess(shared, static_cast<std::uint16_t>(i + 1)));
  }
  const std::size_t share = mesh.triangles / threads + 1;
  parallel::parallel_for(0, threads, 1, [&](std::size_t i) {
    const auto first = static_cast<SimplexNumber>(i * share);
    const auto last =
        static_cast<SimplexNumber>(std::min<std::size_t>(mesh.triangles, first + share));
    suspect_all(mesh, refiners[i], first, last);
  });
  constexpr std::size_t kPointsOfRound = 1 << 15;  // of each thread: some ten milliseconds
  constexpr std::size_t kFewest = 1 << 10;         // that are worth a round
  while (threads > 1 && shared.make_room(kPointsOfRound * threads)) {
    std::atomic<std::size_t> steps = 0;
    parallel::parallel_for(0, threads, 1, [&](std::size_t i) {
      std::size_t done = 0;
      while (done < kPointsOfRound && refiners[i].step()) ++done;
      steps += done;
    });
    for (LockingRefiner& refiner : refiners) refiner.retry();
    balance(refiners);
    if (steps < kFewest * threads) break;
  }
  shared.finish();
  close_gaps(mesh, shared, refiners);
  for (const LockingRefiner& refiner : refiners) {
    counts.on_segments += refiner.counts().on_segments;
    counts.inside += refiner.counts().inside;
    counts.denied += refiner.counts().denied;
  }
  refine_alone(mesh, bounds, limits, counts);
}

}  // namespace delray::delaunay::internal
