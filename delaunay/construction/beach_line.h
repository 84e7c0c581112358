// The beach line of a sweep: a row of arcs, from left to right, that is searched.
#pragma once

#include <cstdint>
#include <vector>

#include "delaunay/mesh/mesh.h"
#include "delaunay/mesh/xorshift.h"

namespace delray::delaunay::internal {

using ArcNumber = std::uint32_t;
constexpr ArcNumber kNoArc = 0xffffffffU;

// A treap (Seidel and Aragon 1996) whose nodes are also a list. Numbers of arcs that were removed
// are used again.
class BeachLine {
 public:
  ArcNumber next(ArcNumber arc) const { return arcs_[arc].next; }
  ArcNumber previous(ArcNumber arc) const { return arcs_[arc].previous; }
  VertexNumber site(ArcNumber arc) const { return arcs_[arc].site; }
  // One for every life of a number.
  std::uint64_t life(ArcNumber arc) const { return arcs_[arc].life; }
  // From now on another life: what was said about the arc does not hold any more.
  void renew(ArcNumber arc) { arcs_[arc].life = ++lives_; }
  bool empty() const { return root_ == kNoArc; }

  // The first arc for which ends_before(arc, next arc) is false, or the last. REQUIRES: not empty.
  // O(log arcs) expected.
  template <class EndsBefore>
  ArcNumber find(const EndsBefore& ends_before) const {
    ArcNumber found = kNoArc, at = root_;
    ArcNumber last = root_;
    while (at != kNoArc) {
      last = at;
      const ArcNumber right = arcs_[at].next;
      if (right != kNoArc && ends_before(at, right)) {
        at = arcs_[at].higher;
      } else {
        found = at;
        at = arcs_[at].lower;
      }
    }
    return found != kNoArc ? found : last;
  }

  // A new arc after another, or the only one after kNoArc.
  ArcNumber insert_after(ArcNumber arc, VertexNumber site);
  void remove(ArcNumber arc);

 private:
  struct Arc {
    VertexNumber site = 0;
    std::uint32_t priority = 0;
    ArcNumber parent = kNoArc, lower = kNoArc, higher = kNoArc;
    ArcNumber previous = kNoArc, next = kNoArc;
    std::uint64_t life = 0;
  };

  ArcNumber& link_to(ArcNumber arc) {
    const ArcNumber parent = arcs_[arc].parent;
    if (parent == kNoArc) return root_;
    return arcs_[parent].lower == arc ? arcs_[parent].lower : arcs_[parent].higher;
  }
  // Puts a child in the place of its parent.
  void rise(ArcNumber child);

  std::vector<Arc> arcs_;
  std::vector<ArcNumber> free_;
  ArcNumber root_ = kNoArc;
  std::uint64_t lives_ = 0;
  std::uint32_t random_ = 1;
};

}  // namespace delray::delaunay::internal
