// The loop over points that methods with threads of their own over a history share.
#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

#include "delaunay/history/dag_run.h"
#include "delaunay/insertion/insertion_phases.h"
#include "delaunay/insertion/point_supply.h"
#include "parallel/team.h"

namespace delray::delaunay::internal {

// Runs as many threads as the run has parts. Each makes itself a worker, make(team, thread), and
// for every point that the supply gives it calls insert(worker, vertex, suspects, phases); suspects
// are empty before the first call. When there are no more it calls finish(worker), one thread at a
// time.
//
// Errors: what a call throws; parallel::Interrupted.
template <int D, class Make, class Insert, class Finish>
void insert_with_team(DagRun<D>& run, PointSupply& supply, Make&& make, Insert&& insert,
                      Finish&& finish) {
  parallel::Team team;
  std::mutex finishing;
  team.run(run.parts(), [&](std::size_t thread) {
    auto worker = make(team, thread);
    InsertionPhases phases(run.options, run.statistics);
    std::vector<NodeNumber> suspects;
    supply.for_each(thread, [&](VertexNumber vertex) {
      team.check();
      phases.next_point();
      if (!run.is_first(vertex)) insert(worker, vertex, suspects, phases);
    });
    const std::lock_guard alone(finishing);
    phases.finish();
    finish(worker);
  });
}

// f.operator()<D, counted>() for the options' dimension, counted if anybody wants statistics.
template <class F>
auto with_dimension_and_counts(const Options& options, F&& f) {
  const bool counted = options.statistics;
  if (options.dim == 2) {
    return counted ? f.template operator()<2, true>() : f.template operator()<2, false>();
  }
  return counted ? f.template operator()<3, true>() : f.template operator()<3, false>();
}

}  // namespace delray::delaunay::internal
