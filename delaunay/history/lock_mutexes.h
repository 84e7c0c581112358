// Mutexes of the operating system in place of an atomic instruction, to compare the two.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string_view>
#include <vector>

#include "delaunay/flip/dag.h"

namespace delray::delaunay::internal {

// The critical sections in which threads look at the lock of a simplex and set it (Kohout 2004,
// 7.7.1 and Figure 7.9). A thread leaves the section at once; the lock itself it keeps.
class LockMutexes {
 public:
  struct Counts {
    std::uint64_t entered = 0;
    std::uint64_t contended = 0;  // found another thread inside, and waited
  };

  // By kind, one of lock_kinds(): none for "atomic", one for "mutex".
  explicit LockMutexes(std::string_view kind)
      : sections_(kind == "striped" ? kStripes
                  : kind == "mutex" ? 1
                                    : 0) {}

  bool empty() const { return sections_.empty(); }
  std::size_t bytes() const { return sections_.size() * sizeof(Section); }

  // As Dag::try_lock(). REQUIRES: not empty.
  template <int D>
  std::uint32_t try_lock(Dag<D>& dag, NodeNumber node, RecordNumber record, std::uint32_t thread,
                         Counts& counts) {
    std::unique_lock inside(sections_[record % sections_.size()].mutex, std::try_to_lock);
    ++counts.entered;
    if (!inside) {
      ++counts.contended;
      inside.lock();
    }
    const std::uint32_t before = dag.owner(node, record);
    if (before == 0) dag.set_owner(node, record, thread);
    return before;
  }

 private:
  // So many that threads seldom need the same one at a time.
  static constexpr std::size_t kStripes = 1024;
  static constexpr std::size_t kCacheLine = 64;

  struct alignas(kCacheLine) Section {
    std::mutex mutex;
  };

  std::vector<Section> sections_;
};

}  // namespace delray::delaunay::internal
