// A node rises while its priority is higher than its parent's, and sinks to a leaf to be removed.
#include "delaunay/construction/beach_line.h"

namespace delray::delaunay::internal {

void BeachLine::rise(ArcNumber child) {
  const ArcNumber parent = arcs_[child].parent;
  link_to(parent) = child;
  arcs_[child].parent = arcs_[parent].parent;
  arcs_[parent].parent = child;
  const bool was_lower = arcs_[parent].lower == child;
  ArcNumber& given = was_lower ? arcs_[parent].lower : arcs_[parent].higher;
  ArcNumber& kept = was_lower ? arcs_[child].higher : arcs_[child].lower;
  given = kept;
  if (given != kNoArc) arcs_[given].parent = parent;
  kept = parent;
}

ArcNumber BeachLine::insert_after(ArcNumber arc, VertexNumber site) {
  ArcNumber made = static_cast<ArcNumber>(arcs_.size());
  if (free_.empty()) {
    arcs_.emplace_back();
  } else {
    made = free_.back();
    free_.pop_back();
    arcs_[made] = {};
  }
  Arc& node = arcs_[made];
  node.site = site;
  node.priority = next_random(random_);
  renew(made);
  if (arc == kNoArc) {
    root_ = made;
    return made;
  }
  node.previous = arc;
  node.next = arcs_[arc].next;
  if (node.next != kNoArc) arcs_[node.next].previous = made;
  arcs_[arc].next = made;
  if (arcs_[arc].higher == kNoArc) {
    arcs_[arc].higher = made;
    node.parent = arc;
  } else {
    // The arc that came after it has no lower child.
    arcs_[node.next].lower = made;
    node.parent = node.next;
  }
  while (node.parent != kNoArc && arcs_[node.parent].priority < node.priority) rise(made);
  return made;
}

void BeachLine::remove(ArcNumber arc) {
  const Arc& node = arcs_[arc];
  if (node.previous != kNoArc) arcs_[node.previous].next = node.next;
  if (node.next != kNoArc) arcs_[node.next].previous = node.previous;
  while (node.lower != kNoArc || node.higher != kNoArc) {
    const bool lower =
        node.higher == kNoArc ||
        (node.lower != kNoArc && arcs_[node.lower].priority > arcs_[node.higher].priority);
    rise(lower ? node.lower : node.higher);
  }
  link_to(arc) = kNoArc;
  renew(arc);
  free_.push_back(arc);
}

}  // namespace delray::delaunay::internal
