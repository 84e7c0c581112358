// Access to a mesh during an insertion: the policy of a thread that is alone with it.
#pragma once

#include "delaunay/mesh/flip_counter.h"
#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

// Alone with the mesh: everything is granted and nothing has to be undone.
//
// Other policies lock or refuse. A kernel acquires every simplex that it will write before its
// first write; if that is refused it returns at once, and the driver rolls back and tries again.
class SoleAccess : public FlipCounter {
 public:
  // Slots from `used` on are free.
  explicit SoleAccess(SimplexNumber used) : used_(used) {}

  bool acquire(SimplexNumber) const { return true; }
  SimplexNumber create() { return used_++; }
  void commit() const {}

  SimplexNumber used() const { return used_; }

 private:
  SimplexNumber used_;
};

}  // namespace delray::delaunay::internal
