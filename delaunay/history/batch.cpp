// The batch method (Kohout 2004, 7.5): many threads locate points, one inserts them.
//
// Every searching thread descends the shared history for its points and puts (point, leaf) into a
// bounded queue of its own. The inserting thread takes requests from the queues in turn, descends
// from the noted leaf to the present one, subdivides and legalizes; when all queues are empty it
// locates and inserts a few points itself rather than wait. Expected O(n log n) in random or brio
// order, of which subdividing and legalizing are sequential.
//
// Degenerate: collinear points need no insertion. With one thread locating and inserting alternate,
// without queues.
#include "delaunay/history/batch.h"

#include <algorithm>
#include <atomic>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "delaunay/history/dag_location.h"
#include "delaunay/history/dag_run.h"
#include "delaunay/history/insert_in_leaf.h"
#include "delaunay/history/request_queue.h"
#include "delaunay/history/sole_dag_access.h"
#include "delaunay/insertion/insertion_phases.h"
#include "delaunay/mesh/team.h"

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

}  // namespace

std::size_t default_queue(std::size_t points) {
  if (points <= 1000) return 64;
  if (points <= 5000) return 256;
  return points <= 10000 ? 512 : 1024;
}

Triangulation insert_in_batches(PointView<double> points, const Options& options) {
  const auto searching = static_cast<std::size_t>(options.threads > 1 ? options.threads - 1 : 1);
  DagRun<2> run(points, options, searching);
  if (run.is_flat()) return run.finish();
  const DagTriangulation<2> triangulation = run.triangulation();
  const Dag<2>& dag = triangulation.dag;
  const Orientation<2>& orientation = triangulation.orientation;
  std::optional<SoleDagAccess<2>> access(std::in_place, triangulation.dag, 0);
  std::vector<NodeNumber> suspects;
  const auto locate = [&](VertexNumber vertex) {
    const glm::dvec2& q = run.point(vertex);
    return descend(dag, orientation, root_of(dag, orientation, q), q);
  };
  const auto insert = [&](const Request& request, InsertionPhases& phases) {
    const NodeNumber leaf = descend(dag, orientation, request.node, run.point(request.vertex));
    phases.located();
    insert_in_leaf(run, triangulation, leaf, request.vertex, *access, suspects, phases);
  };

  if (options.threads == 1) {
    InsertionPhases phases(options);
    for (VertexNumber vertex = 0; vertex < run.end(0); ++vertex) {
      phases.next_point();
      if (!run.is_first(vertex)) insert({vertex, locate(vertex)}, phases);
    }
    phases.finish();
    access.reset();  // it marks the slots that it did not use
    return run.finish();
  }

  // A queue per searching thread, so that every queue has one writer; together they have the
  // length that was asked for.
  const std::size_t length = options.queue > 0 ? options.queue : default_queue(points.size());
  std::deque<RequestQueue> queues;
  for (std::size_t i = 0; i < searching; ++i) queues.emplace_back((length + i) / searching);
  std::vector<Supply> supplies(searching);
  for (std::size_t part = 0; part < searching; ++part) {
    supplies[part].next.store(run.begin(part), std::memory_order_relaxed);
    supplies[part].end = run.end(part);
  }
  Team team;
  std::mutex finishing;
  const auto search = [&](std::size_t part, InsertionPhases& phases) {
    constexpr std::size_t kClaim = 32;
    for (Claim claim = supplies[part].claim(kClaim); claim.first < claim.last;
         claim = supplies[part].claim(kClaim)) {
      for (VertexNumber vertex = claim.first; vertex < claim.last; ++vertex) {
        phases.next_point();
        if (run.is_first(vertex)) continue;
        const Request request = {vertex, locate(vertex)};
        phases.located();
        while (!queues[part].put(request)) {
          team.check();
          std::this_thread::yield();
        }
      }
    }
  };
  // Searches too rather than wait. Returns the number of points inserted.
  const auto insert_own = [&](Supply& supply, InsertionPhases& phases) {
    constexpr std::size_t kClaim = 4;
    std::size_t inserted = 0;
    const Claim claim = supply.claim(kClaim);
    for (VertexNumber vertex = claim.first; vertex < claim.last; ++vertex) {
      phases.next_point();
      if (run.is_first(vertex)) continue;
      insert({vertex, locate(vertex)}, phases);
      ++inserted;
    }
    return inserted;
  };
  const auto insert_requests = [&](InsertionPhases& phases) {
    std::size_t left = run.end(run.parts() - 1) - 3, turn = 0;
    while (left > 0) {
      bool idle = true;
      for (RequestQueue& queue : queues) {
        // A few from each in turn, so that no searching thread waits long.
        constexpr int kTurn = 16;
        Request request;
        for (int i = 0; i < kTurn && queue.take(request); ++i, --left) {
          phases.resume();
          insert(request, phases);
          idle = false;
        }
      }
      team.check();
      if (!idle) continue;
      const std::size_t inserted = insert_own(supplies[turn++ % searching], phases);
      left -= inserted;
      if (inserted == 0) std::this_thread::yield();
    }
  };
  team.run(searching + 1, [&](std::size_t thread) {
    InsertionPhases phases(options);
    if (thread < searching) {
      search(thread, phases);
    } else {
      insert_requests(phases);
    }
    const std::lock_guard alone(finishing);
    phases.finish();
  });
  access.reset();
  return run.finish();
}

}  // namespace delray::delaunay::internal
