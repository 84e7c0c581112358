// Access to the history's leaves during an insertion: the policies that tell the methods apart.
//
// A policy is a class with
//   Grant acquire({nodes})   before an operation, for all nodes that it writes or decides by
//   reserve(count)           so many slots will be created with consecutive numbers
//   NodeNumber create()      a slot that is acquired already
//   link(outside, inside)    makes two facets one; `outside` is of an older node, `inside` of a new
//   retire(node, children)   gives a leaf its children
//   kMayRetry                whether acquire may return kRetry
//   keep(node)               if it wants to know of leaves that an insertion leaves as they are
// All of it is small and called some ten times a point, so it is inlined into the loops of
// dag_flip_2d.h and flip_3d.h. An operation is a subdivision or a flip; between operations the
// leaves are a triangulation.
#pragma once

#include <cstdint>

namespace delray::delaunay::internal {

enum class Grant {
  kGranted,
  kRefused,  // nothing will come of it: undo everything
  kRetry,    // others may have changed acquired nodes meanwhile: look again
};

// Tells a policy that wants to know of a leaf that the insertion keeps, and as far as is known
// needs no more.
template <class Access>
void tell_kept(Access& access, std::uint32_t node) {
  if constexpr (requires { access.keep(node); }) access.keep(node);
}

// A history, its points and their orientation: dag_flip_2d.h, dag_flip_3d.h.
template <int D>
struct DagTriangulation;

}  // namespace delray::delaunay::internal
