// The table of distributed methods, and what is common to their calls: checks, counts.
#include "delaunay/distributed.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "comm/agree_on_failure.h"
#include "delaunay/distributed/counting.h"
#include "delaunay/distributed/method_sources.h"
#include "delaunay/mesh/arguments.h"
#include "files/find_named.h"
#include "files/similar_name.h"
#include "loadbalance/partition.h"

namespace delray::delaunay {
namespace {

const DistributedMethod& method_of(const DistributedOptions& options) {
  const DistributedMethod* method = files::find_named(distributed_methods(), options.method);
  const int dim = options.triangulate.dim;
  if (method != nullptr && std::ranges::find(method->dims, dim) != method->dims.end()) {
    return *method;
  }
  std::string text = "there is no distributed method \"" + options.method + "\" in " +
                     std::to_string(dim) + "D; methods:";
  std::vector<std::string> names;
  for (const std::string_view name : distributed_methods_for(dim)) {
    text += (names.empty() ? " " : ", ") + std::string(name);
    names.emplace_back(name);
  }
  throw std::invalid_argument(text + files::did_you_mean(options.method, names));
}

void check_points(std::span<const RowPoint> points, int dim) {
  for (const RowPoint& point : points) {
    for (int k = 0; k < dim; ++k) {
      if (!std::isfinite(point.position[k])) {
        throw std::invalid_argument("row " + std::to_string(point.row) +
                                    " has a coordinate that is not finite");
      }
    }
  }
}

DistributedTriangulation with_counts(DistributedTriangulation result, const MessageCounts& counts) {
  result.statistics.messages = counts.messages;
  result.statistics.bytes = counts.bytes;
  result.statistics.waiting_seconds = counts.waiting_seconds;
  return result;
}

const DistributedMethod& checked_method(comm::Communicator& communicator,
                                        const DistributedOptions& options,
                                        std::span<const RowPoint> points, bool on_line) {
  return *comm::all_or_none(communicator, comm::Phase::other, [&] {
    internal::check_dim(options.triangulate.dim);
    const DistributedMethod& method = method_of(options);
    if (on_line && method.on_line == nullptr) {
      throw std::invalid_argument("distributed method \"" + options.method +
                                  "\" needs all points from the start");
    }
    if (loadbalance::find_partitioner(options.partition) == nullptr) {
      throw std::invalid_argument("'" + options.partition + "' is no partition");
    }
    check_points(points, options.triangulate.dim);
    return &method;
  });
}

// What callers see: counts what is sent, and agrees on bad points.
class CountedOnline final : public OnlineTriangulation {
 public:
  CountedOnline(comm::Communicator& communicator, const DistributedOptions& options,
                const DistributedMethod& method)
      : dim_(options.triangulate.dim),
        counting_(communicator, counts_),
        inner_(method.on_line(counting_, options)) {}

  void insert(std::span<const RowPoint> points) override {
    comm::all_or_none(counting_, comm::Phase::other, [&] { check_points(points, dim_); });
    inner_->insert(points);
  }
  DistributedTriangulation extract() override { return with_counts(inner_->extract(), counts_); }

 private:
  int dim_;
  MessageCounts counts_;
  Counting counting_;
  std::unique_ptr<OnlineTriangulation> inner_;
};

}  // namespace

std::span<const DistributedMethod> distributed_methods() {
  static const std::vector<DistributedMethod> table = {
      {.name = "tiles",
       .description = "each rank triangulates the points of its tile and those of others that its "
                      "simplices could meet; two exchanges as a rule",
       .dims = {2, 3},
       .triangulates_parts = true,
       .triangulate = triangulate_by_tiles,
       .count_shared = count_shared_rows},
      {.name = "virtual-shared-memory",
       .description = "the optimistic method over nodes that ranks read through a cache and lock "
                      "at the rank that has them",
       .dims = {2, 3},
       .triangulate = virtual_shared_memory,
       .on_line = virtual_shared_memory_on_line},
      {.name = "interface-workers",
       .description = "one rank keeps the simplices that areas share and changes them for the "
                      "others, which go on meanwhile",
       .dims = {2, 3},
       .ranks_without_area = 1,
       .triangulate = interface_workers,
       .on_line = interface_workers_on_line},
      {.name = "administrators",
       .description = "each simplex has one rank that changes it; points are sent on, and changes "
                      "are told to those that share it",
       .dims = {2, 3},
       .triangulate = administrators,
       .on_line = administrators_on_line},
      {.name = "chen",
       .description =
           "each rank triangulates its area and builds on at its border, with the points "
           "of the areas beside it",
       .dims = {2},
       .triangulates_parts = true,
       .triangulate = chen},
      {.name = "lee-1997",
       .description = "every rank knows all points, and makes the triangles at edges that rank 0 "
                      "collects and shares out, in rounds",
       .dims = {2},
       .cuts_areas = false,
       .triangulate = lee_1997,
       .count_shared = count_shared_rows},
      {.name = "hardwick",
       .description =
           "halves the points along paths of Delaunay edges, found as lower hulls, until "
           "each rank has a part to triangulate",
       .dims = {2},
       .cuts_areas = false,
       .triangulates_parts = true,
       .triangulate = hardwick},
      {.name = "lee-2001",
       .description = "as hardwick, but cuts into as many slabs as ranks in one step",
       .dims = {2},
       .cuts_areas = false,
       .triangulates_parts = true,
       .triangulate = lee_2001},
  };
  return table;
}

std::vector<std::string_view> distributed_methods_for(int dim) {
  std::vector<std::string_view> names;
  for (const DistributedMethod& method : distributed_methods()) {
    if (std::ranges::find(method.dims, dim) != method.dims.end()) names.push_back(method.name);
  }
  return names;
}

DistributedTriangulation triangulate_distributed(comm::Communicator& communicator,
                                                 std::span<const RowPoint> points,
                                                 const DistributedOptions& options) {
  const DistributedMethod& method = checked_method(communicator, options, points, false);
  MessageCounts counts;
  Counting counting(communicator, counts);
  DistributedTriangulation result =
      with_counts(method.triangulate(counting, points, options), counts);
  if (options.triangulate.statistics && method.count_shared != nullptr) {
    result.statistics.shared_simplices =
        method.count_shared(communicator, points, options, result.part);
  }
  return result;
}

std::unique_ptr<OnlineTriangulation> make_online_triangulation(comm::Communicator& communicator,
                                                               const DistributedOptions& options) {
  const DistributedMethod& method = checked_method(communicator, options, {}, true);
  return std::make_unique<CountedOnline>(communicator, options, method);
}

}  // namespace delray::delaunay
