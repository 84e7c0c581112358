// The batch method (Kohout 2004, 7.5): many threads locate points, one inserts them.
//
// Every searching thread descends the shared history for its points and puts (point, leaf) into a
// bounded queue of its own. The inserting thread takes requests from the queues in turn, descends
// from the noted leaf to the present one, subdivides and legalizes; when all queues are empty it
// locates and inserts a few points itself rather than wait. It also lets only as many threads
// search as it can keep up with, by the times of both (active_searchers.h). Expected O(n log n) in
// random or brio order, of which subdividing and legalizing are sequential.
//
// Degenerate: collinear points need no insertion. With one thread locating and inserting alternate,
// without queues.
#include "delaunay/history/batch.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "delaunay/history/active_searchers.h"
#include "delaunay/history/dag_location.h"
#include "delaunay/history/dag_run.h"
#include "delaunay/history/insert_in_leaf.h"
#include "delaunay/history/request_queue.h"
#include "delaunay/history/sole_dag_access.h"
#include "delaunay/insertion/insertion_phases.h"
#include "delaunay/mesh/add_counts.h"
#include "parallel/processor_time.h"
#include "parallel/team.h"

namespace delray::delaunay::internal {
namespace {

struct Claim {
  VertexNumber first, last;
};

// The points of a part that nobody has begun with.
struct alignas(64) Supply {
  std::atomic<std::size_t> next{0};
  std::size_t end = 0;

  Claim claim(std::size_t count) {
    const std::size_t first = std::min(next.fetch_add(count, std::memory_order_relaxed), end);
    return {static_cast<VertexNumber>(first),
            static_cast<VertexNumber>(std::min(first + count, end))};
  }
};

// The points of one run, and whoever locates and inserts them. One thread inserts at a time.
class BatchInsertion {
 public:
  BatchInsertion(DagRun<2>& run, std::size_t queue_length)
      : run_(run),
        triangulation_(run.triangulation()),
        queue_length_(queue_length),
        supplies_(run.parts()),
        searchers_(static_cast<int>(run.parts()), run.options.searching > 0) {
    // A queue per searching thread, so that every queue has one writer.
    for (std::size_t part = 0; part < run.parts(); ++part) {
      queues_.emplace_back(queue_length);
      supplies_[part].next.store(run.begin(part), std::memory_order_relaxed);
      supplies_[part].end = run.end(part);
    }
  }

  // Locates and inserts in turns. REQUIRES: one part.
  void insert_alone() {
    InsertionPhases phases(run_.options, run_.statistics);
    for (VertexNumber vertex = 0; vertex < run_.end(0); ++vertex) {
      phases.next_point();
      if (!run_.is_first(vertex)) insert({vertex, locate(vertex)}, phases);
    }
    phases.finish();
  }

  // With a searching thread for each part, and one that inserts.
  void insert_with_team() {
    std::mutex finishing;
    team_.run(run_.parts() + 1, [&](std::size_t thread) {
      InsertionPhases phases(run_.options, run_.statistics);
      if (thread < run_.parts()) {
        search(thread, phases);
      } else {
        insert_requests(phases);
      }
      const std::lock_guard alone(finishing);
      phases.finish();
    });
  }

  const FlipCounts& flips() const { return access_.flips(); }
  const std::vector<SearchingThreads>& searching() const { return searchers_.choices(); }

 private:
  static constexpr std::size_t kClaim = 32;
  static constexpr std::size_t kSample = 16;  // one turn of so many is timed

  NodeNumber locate(VertexNumber vertex) const {
    const Dag<2>& dag = triangulation_.dag;
    const glm::dvec2& q = run_.point(vertex);
    return descend(dag, triangulation_.orientation, root_of(dag, triangulation_.orientation, q), q);
  }

  void insert(const Request& request, InsertionPhases& phases) {
    const NodeNumber leaf = descend(triangulation_.dag, triangulation_.orientation, request.node,
                                    run_.point(request.vertex));
    phases.located();
    insert_in_leaf(run_, triangulation_, leaf, request.vertex, access_, suspects_, phases);
  }

  // Locates points, as long as there are any, and puts them into the queue of the thread.
  void search(std::size_t thread, InsertionPhases& phases) {
    for (std::size_t turn = 0;; ++turn) {
      searchers_.wait(thread, team_);
      const Claim claim = claim_for(thread, turn);
      if (claim.first == claim.last) return;
      if (!searchers_.fixed() && turn % kSample == 0) {
        search_timed(claim, thread, phases);
        continue;
      }
      for (VertexNumber vertex = claim.first; vertex < claim.last; ++vertex) {
        phases.next_point();
        if (run_.is_first(vertex)) continue;
        const Request request = {vertex, locate(vertex)};
        phases.located();
        put(request, thread);
      }
    }
  }
  // Likewise, and tells how long locating takes, without waiting for places in between.
  void search_timed(Claim claim, std::size_t thread, InsertionPhases& phases) {
    std::array<Request, kClaim> requests;
    std::size_t count = 0;
    const std::int64_t before = parallel::processor_nanoseconds();
    for (VertexNumber vertex = claim.first; vertex < claim.last; ++vertex) {
      phases.next_point();
      if (run_.is_first(vertex)) continue;
      requests[count++] = {vertex, locate(vertex)};
      phases.located();
    }
    searchers_.located(count, parallel::processor_nanoseconds() - before);
    for (std::size_t i = 0; i < count; ++i) put(requests[i], thread);
  }
  // The next points of the thread's own part, and in turn of those whose threads are not active;
  // then of any.
  Claim claim_for(std::size_t thread, std::size_t turn) {
    const std::size_t parts = supplies_.size(), active = searchers_.active();
    const std::size_t own = thread < active ? (parts - thread + active - 1) / active : 1;
    const std::size_t first = thread + turn % own * active;
    for (std::size_t i = 0; i < parts; ++i) {
      const Claim claim = supplies_[(first + i) % parts].claim(kClaim);
      if (claim.first < claim.last) return claim;
    }
    return {0, 0};
  }
  void put(const Request& request, std::size_t thread) {
    // Together the queues have the length that was asked for.
    const std::size_t places = (queue_length_ + thread) / searchers_.active();
    while (!queues_[thread].put(request, places)) {
      team_.check();
      std::this_thread::yield();
    }
  }

  // Inserts what is in the queues, until all points are in, and searches too rather than wait.
  void insert_requests(InsertionPhases& phases) {
    const struct WakesAll {
      ActiveSearchers& searchers;
      ~WakesAll() { searchers.wake_all(); }
    } at_end{searchers_};
    const std::size_t all = run_.end(run_.parts() - 1) - 3;
    std::size_t left = all, turn = 0;
    while (left > 0) {
      const std::size_t taken = empty_queues(phases);
      left -= taken;
      searchers_.choose(all - left);
      team_.check();
      if (taken > 0) continue;
      const std::size_t inserted = insert_own(supplies_[turn++ % supplies_.size()], phases);
      left -= inserted;
      if (inserted == 0) std::this_thread::yield();
    }
  }
  // Inserts a few points from each queue in turn, so that no searching thread waits long. Returns
  // how many.
  std::size_t empty_queues(InsertionPhases& phases) {
    constexpr std::size_t kTurn = 16;
    const bool timed = !searchers_.fixed() && turns_++ % kSample == 0;
    const std::int64_t before = timed ? parallel::processor_nanoseconds() : 0;
    std::size_t inserted = 0;
    for (RequestQueue& queue : queues_) {
      Request request;
      for (std::size_t i = 0; i < kTurn && queue.take(request); ++i, ++inserted) {
        phases.resume();
        insert(request, phases);
      }
    }
    // A turn of few spends its time looking into queues.
    if (timed && inserted >= kTurn) {
      searchers_.inserted(inserted, parallel::processor_nanoseconds() - before);
    }
    return inserted;
  }
  // Locates and inserts a few points that no searching thread has begun with. Returns how many.
  std::size_t insert_own(Supply& supply, InsertionPhases& phases) {
    constexpr std::size_t kFew = 4;
    std::size_t inserted = 0;
    const Claim claim = supply.claim(kFew);
    for (VertexNumber vertex = claim.first; vertex < claim.last; ++vertex) {
      phases.next_point();
      if (run_.is_first(vertex)) continue;
      insert({vertex, locate(vertex)}, phases);
      ++inserted;
    }
    return inserted;
  }

  DagRun<2>& run_;
  DagTriangulation<2> triangulation_;
  SoleDagAccess<2> access_{triangulation_.dag, 0};  // marks at the end the slots it did not use
  std::vector<NodeNumber> suspects_;
  std::size_t queue_length_;
  std::deque<RequestQueue> queues_;
  std::vector<Supply> supplies_;
  ActiveSearchers searchers_;
  std::size_t turns_ = 0;
  parallel::Team team_;
};

}  // namespace

std::size_t default_queue(std::size_t points) {
  if (points <= 1000) return 64;
  if (points <= 5000) return 256;
  return points <= 10000 ? 512 : 1024;
}

Result insert_in_batches(PointView<double> points, const Options& options) {
  const int most = std::max(options.threads - 1, 1);
  const auto searching = static_cast<std::size_t>(options.searching > 0 ? options.searching : most);
  DagRun<2> run(points, options, searching);
  if (run.is_flat()) return run.finish();
  {
    BatchInsertion insertion(run, options.queue > 0 ? options.queue : default_queue(points.size()));
    if (options.threads == 1) {
      insertion.insert_alone();
    } else {
      insertion.insert_with_team();
    }
    if (options.statistics) {
      add(run.statistics.flips, insertion.flips());
      if (options.threads > 1) run.statistics.searching = insertion.searching();
    }
  }
  return run.finish();
}

}  // namespace delray::delaunay::internal
