// The access policy of a thread that is alone with the leaves, always or for the moment.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>

#include "delaunay/flip/dag.h"
#include "delaunay/flip/dag_access.h"
#include "delaunay/history/node_cache.h"
#include "delaunay/mesh/flip_counter.h"

namespace delray::delaunay::internal {

// Grants everything. Others may go down the graph meanwhile.
template <int D>
class SoleDagAccess : public FlipCounter {
 public:
  static constexpr bool kMayRetry = false;

  SoleDagAccess(Dag<D>& dag, std::uint32_t thread) : dag_(dag), cache_(dag, thread) {}

  Grant acquire(std::initializer_list<NodeNumber>) const { return Grant::kGranted; }
  void reserve(NodeNumber count) { cache_.reserve(count); }
  NodeNumber create(const std::array<VertexNumber, D + 1>& vertices) {
    ++created_;
    return cache_.create(vertices, 0);
  }
  void link(CornerNumber outside, CornerNumber inside) {
    dag_.set_neighbour(outside, inside);
    dag_.set_neighbour(inside, outside);
  }
  void retire(NodeNumber node, const std::array<NodeNumber, D + 1>& children) {
    const RecordNumber record = dag_.record_of(node);
    dag_.set_children(node, children);
    cache_.recycle(record);
  }
  std::uint64_t created() const { return created_; }

 private:
  Dag<D>& dag_;
  NodeCache<D> cache_;
  std::uint64_t created_ = 0;
};

}  // namespace delray::delaunay::internal
