// Polygons are triangulated by a sweep (Hertel & Mehlhorn, Fast triangulation of the plane with
// respect to simple polygons, 1985).
//
// A line goes down over the corners. Of every part of it inside of the polygon it keeps the chain
// of corners above that are not cut off yet, concave on either side of the lowest. A new corner
// cuts off all triangles that it sees at the chain's end; a triangle is made once and no corner is
// seen in vain more than once, so that only the order and the search for the part above a corner
// cost log n. Signs are exact. O(n log n) time, O(n) memory.
//
// Corners that repeat are taken out first, and so are edges that are passed in both directions, by
// which files join holes to their outline: the outline and the holes are swept together. Where the
// polygon crosses itself the sweep may end in contradictions; ears are clipped then (Meisters 1975)
// with bounded effort.
#include "scenes/geometry/polygon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>

#include "scenes/geometry/orientation.h"

namespace delray::scenes::internal {
namespace {

constexpr std::uint32_t kNothing = 0xFFFFFFFFU;
constexpr std::size_t kTestsPerCorner = 256;  // of corners against ears: some microseconds

// The corners in the plane of the two axes in which the polygon is largest, counter-clockwise. The
// coordinates are those of single precision.
std::vector<glm::dvec2> flatten(std::span<const std::uint32_t> corners,
                                std::span<const glm::vec3> positions) {
  const glm::dvec3 origin(positions[corners[0]]);
  const auto corner = [&](std::size_t i) {
    return glm::dvec3(positions[corners[i % corners.size()]]);
  };
  glm::dvec3 normal(0);  // Newell's: the sum over the edges
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += glm::cross(corner(i) - origin, corner(i + 1) - origin);
  int axis = 2;
  for (const int k : {0, 1}) {
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  }
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::vector<glm::dvec2> flat;
  flat.reserve(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 p = corner(i);
    flat.push_back(normal[axis] < 0 ? glm::dvec2(p[v], p[u]) : glm::dvec2(p[u], p[v]));
  }
  return flat;
}

// Convex, and once around: all turns are to the left and the edges go up and down once.
bool is_convex(const std::vector<glm::dvec2>& flat) {
  const std::size_t n = flat.size();
  int changes = 0, last = 0, first = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const glm::dvec2 &a = flat[i], &b = flat[(i + 1) % n];
    if (orientation(a, b, flat[(i + 2) % n]) < 0) return false;
    const int up = a.y < b.y || (a.y == b.y && a.x > b.x) ? 1 : a == b ? 0 : -1;
    if (up == 0) continue;
    if (last != 0 && up != last) ++changes;
    if (first == 0) first = up;
    last = up;
  }
  if (last != first) ++changes;
  return changes <= 2;
}

// The rest of the polygon: corner i is followed by next[i]; of corners taken out it is
// kNothing.
struct Outline {
  const std::vector<glm::dvec2>& at;
  std::vector<std::uint32_t> next, previous;

  explicit Outline(const std::vector<glm::dvec2>& flat)
      : at(flat), next(flat.size()), previous(flat.size()) {
    for (std::uint32_t i = 0; i < next.size(); ++i) {
      next[i] = i + 1 < next.size() ? i + 1 : 0;
      previous[next[i]] = i;
    }
  }
  bool has(std::uint32_t i) const { return next[i] != kNothing; }
  void link(std::uint32_t i, std::uint32_t j) {
    next[i] = j;
    previous[j] = i;
  }
  void take_out(std::uint32_t i) { next[i] = previous[i] = kNothing; }

  // Whether the sweep comes to the first of two corners before the second.
  bool above(std::uint32_t i, std::uint32_t j) const {
    return at[i].y != at[j].y ? at[i].y > at[j].y : at[i].x < at[j].x;
  }
};

using Emit = std::vector<glm::uvec3>;  // places in the polygon

// All but the last of corners at one place that follow each other. They may differ in space: a
// triangle to the neighbours takes the place of each.
void take_out_repeated(Outline& outline, Emit& triangles) {
  for (std::uint32_t i = 0; i < outline.at.size(); ++i) {
    const std::uint32_t j = outline.next[i], h = outline.previous[i];
    if (outline.at[i] != outline.at[j]) continue;
    if (h != j) triangles.emplace_back(h, i, j);
    if (i != j) outline.link(h, j);
    outline.take_out(i);
  }
}

// Edges that are passed in both directions: the polygon falls into an outline and its holes.
void take_out_bridges(Outline& outline) {
  struct Edge {
    glm::dvec2 top, bottom;
    std::uint32_t from;
    bool down;
  };
  std::vector<Edge> sorted;
  for (std::uint32_t i = 0; i < outline.at.size(); ++i) {
    if (!outline.has(i)) continue;
    const glm::dvec2 &a = outline.at[i], &b = outline.at[outline.next[i]];
    const bool down = outline.above(i, outline.next[i]);
    sorted.push_back({down ? a : b, down ? b : a, i, down});
  }
  const auto key = [](const Edge& e) {
    return std::array{e.top.x, e.top.y, e.bottom.x, e.bottom.y};
  };
  std::sort(sorted.begin(), sorted.end(), [&](const Edge& a, const Edge& b) {
    return key(a) != key(b) ? key(a) < key(b) : a.from < b.from;
  });
  std::vector<Edge> open;
  for (std::size_t e = 0; e < sorted.size(); ++e) {
    if (e == 0 || key(sorted[e]) != key(sorted[e - 1])) open.clear();
    if (open.empty() || open.back().down == sorted[e].down) {
      open.push_back(sorted[e]);
      continue;
    }
    const std::uint32_t i = open.back().from, j = sorted[e].from;
    open.pop_back();
    const std::uint32_t after_i = outline.next[i], after_j = outline.next[j];
    const std::uint32_t before_i = outline.previous[i], before_j = outline.previous[j];
    if (before_i != j) outline.link(before_i, after_j);
    if (before_j != i) outline.link(before_j, after_i);
    outline.take_out(i);
    outline.take_out(j);
    for (const std::uint32_t alone : {after_i, after_j}) {
      if (outline.next[alone] == alone) outline.take_out(alone);
    }
  }
}

// The sweep. A link is a corner in a chain; chains run from left to right.
class Sweep {
 public:
  Sweep(const Outline& outline, Emit& triangles)
      : outline_(outline),
        triangles_(triangles),
        edges_(Less{this}),
        place_(outline.at.size(), edges_.end()) {}

  // False if the polygon crosses itself in a way that leaves the sweep without a result.
  bool run() {
    const std::size_t n = outline_.at.size();
    std::vector<std::uint32_t> order;
    std::vector<std::uint8_t> ending(n, 0);  // edges that end at the corner, seen from above
    for (std::uint32_t i = 0; i < n; ++i) {
      if (!outline_.has(i)) continue;
      order.push_back(i);
      ending[i] = static_cast<std::uint8_t>((outline_.above(outline_.previous[i], i) ? 1 : 0) +
                                            (outline_.above(outline_.next[i], i) ? 1 : 0));
    }
    // Corners at one place are sorted: those that end parts of the line come first.
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
      if (outline_.at[i] != outline_.at[j]) return outline_.above(i, j);
      return ending[i] != ending[j] ? ending[i] > ending[j] : i < j;
    });
    for (const std::uint32_t v : order) {
      const bool done = ending[v] == 0 ? begin(v) : ending[v] == 1 ? go_on(v) : end(v);
      if (!done) return false;
    }
    return edges_.empty();
  }

 private:
  // Corners of the chain to the right of an edge, or none if that is outside.
  struct Chain {
    std::uint32_t first = kNothing, lowest = kNothing, last = kNothing;
  };
  // An edge that the line crosses, named by its lower end's corner and its upper end's. Both ends
  // move down while the line passes corners with one edge above and one below.
  struct Edge {
    mutable std::uint32_t top, bottom;
    mutable std::uint32_t owner;  // the edge's corner of which it is next
    mutable Chain chain;
    mutable bool inside;  // the polygon is to the right
  };
  struct Less {
    const Sweep* sweep;
    bool operator()(const Edge& a, const Edge& b) const { return sweep->left_of(a, b); }
  };
  using Edges = std::multiset<Edge, Less>;
  using Place = Edges::iterator;
  struct Link {
    std::uint32_t corner, left, right;
  };

  // `b` begins at the line, which crosses `a`, or the other way round.
  bool left_of(const Edge& a, const Edge& b) const {
    return sweeps_past(a, b) ? side(a, b) > 0 : side(b, a) < 0;
  }
  bool sweeps_past(const Edge& a, const Edge& b) const { return !outline_.above(b.top, a.top); }
  // On which side of `edge`, +1 for the right, `other` begins or else goes.
  int side(const Edge& edge, const Edge& other) const {
    const glm::dvec2 &from = outline_.at[edge.top], &to = outline_.at[edge.bottom];
    // Seen downwards the right of the plane is to the left.
    const int at_top = orientation(from, to, outline_.at[other.top]);
    return at_top != 0 ? at_top : orientation(from, to, outline_.at[other.bottom]);
  }

  Edge edge_to(std::uint32_t v, std::uint32_t end) const {
    return {v, end, outline_.next[v] == end ? v : end, {}, false};
  }

  std::uint32_t new_link(std::uint32_t corner) {
    links_.push_back({corner, kNothing, kNothing});
    return static_cast<std::uint32_t>(links_.size() - 1);
  }
  void connect(std::uint32_t left, std::uint32_t right) {
    links_[left].right = right;
    links_[right].left = left;
  }
  const glm::dvec2& at(std::uint32_t link) const { return outline_.at[links_[link].corner]; }

  // Cuts off what `v` sees along the chain from `from` on to the right, resp. left, and returns the
  // link that it sees last. With `all` nothing is in the way.
  std::uint32_t cut_rightwards(std::uint32_t v, std::uint32_t from, bool all) {
    for (std::uint32_t next = links_[from].right; next != kNothing; next = links_[from].right) {
      if (!all && orientation(outline_.at[v], at(next), at(from)) <= 0) break;
      triangles_.emplace_back(v, links_[next].corner, links_[from].corner);
      from = next;
    }
    return from;
  }
  std::uint32_t cut_leftwards(std::uint32_t v, std::uint32_t from) {
    for (std::uint32_t next = links_[from].left; next != kNothing; next = links_[from].left) {
      if (orientation(outline_.at[v], at(from), at(next)) <= 0) break;
      triangles_.emplace_back(v, links_[from].corner, links_[next].corner);
      from = next;
    }
    return from;
  }

  // Both edges of `v` lie below: a part of the line begins, or one is split.
  bool begin(std::uint32_t v) {
    Edge left = edge_to(v, outline_.previous[v]), right = edge_to(v, outline_.next[v]);
    if (side(left, right) < 0) std::swap(left, right);
    const Place after = edges_.lower_bound(left);
    const bool splits = after != edges_.begin() && std::prev(after)->inside;
    if (splits) {
      Chain& whole = std::prev(after)->chain;
      const std::uint32_t on_left = new_link(v), on_right = new_link(v);
      const std::uint32_t middle = whole.lowest;
      const std::uint32_t far_left = cut_leftwards(v, middle);
      const std::uint32_t far_right = cut_rightwards(v, middle, false);
      const bool same = far_left == far_right;
      // A link that both sides keep becomes two.
      const std::uint32_t start_right = same ? new_link(links_[far_right].corner) : far_right;
      if (same) {
        const std::uint32_t beyond = links_[far_right].right;
        if (beyond != kNothing) connect(start_right, beyond);
      }
      right.chain = {on_right, on_right,
                     same && whole.last == far_right ? start_right : whole.last};
      connect(far_left, on_left);
      connect(on_right, start_right);
      whole = {whole.first, on_left, on_left};
      right.inside = true;
    } else {
      const std::uint32_t only = new_link(v);
      left.chain = {only, only, only};
      left.inside = true;
    }
    const Place first = edges_.insert(after, left);
    const Place second = edges_.insert(std::next(first), right);
    place_[left.owner] = first;
    place_[right.owner] = second;
    return std::next(first) == second;
  }

  // One edge above, one below.
  bool go_on(std::uint32_t v) {
    const bool down = outline_.above(outline_.previous[v], v);
    const std::uint32_t old_owner = down ? outline_.previous[v] : v;
    const Place edge = place_[old_owner];
    if (edge == edges_.end()) return false;
    const Edge below = edge_to(v, down ? outline_.next[v] : outline_.previous[v]);
    const std::uint32_t link = new_link(v);
    if (edge->inside) {
      Chain& chain = edge->chain;
      const std::uint32_t far = cut_rightwards(v, chain.first, false);
      connect(link, far);
      links_[link].left = kNothing;
      chain = {link, link, chain.last};
    } else {
      if (edge == edges_.begin() || !std::prev(edge)->inside) return false;
      Chain& chain = std::prev(edge)->chain;
      const std::uint32_t far = cut_leftwards(v, chain.last);
      connect(far, link);
      links_[link].right = kNothing;
      chain = {chain.first, link, link};
    }
    place_[old_owner] = edges_.end();
    edge->top = below.top;
    edge->bottom = below.bottom;
    edge->owner = below.owner;
    place_[below.owner] = edge;
    return true;
  }

  // Both edges of `v` lie above: a part of the line ends, or two become one.
  bool end(std::uint32_t v) {
    Place left = place_[outline_.previous[v]], right = place_[v];
    if (left == edges_.end() || right == edges_.end()) return false;
    if (std::next(left) != right) std::swap(left, right);
    if (std::next(left) != right) return false;
    if (left->inside) {
      cut_rightwards(v, left->chain.first, true);
    } else {
      if (left == edges_.begin() || !right->inside || !std::prev(left)->inside) return false;
      Chain& chain = std::prev(left)->chain;
      const Chain other = right->chain;
      const std::uint32_t far_left = cut_leftwards(v, chain.last);
      const std::uint32_t far_right = cut_rightwards(v, other.first, false);
      const std::uint32_t link = new_link(v);
      connect(far_left, link);
      connect(link, far_right);
      chain = {chain.first, link, other.last};
    }
    place_[outline_.previous[v]] = place_[v] = edges_.end();
    edges_.erase(left);
    edges_.erase(right);
    return true;
  }

  const Outline& outline_;
  Emit& triangles_;
  std::vector<Link> links_;
  Edges edges_;               // from left to right
  std::vector<Place> place_;  // of the edge from a corner to its next
};

// Clips ears in turn. For each corner so many others are tested; what is left then is cut anyhow.
void clip_ears(Outline outline, Emit& triangles) {
  const std::vector<glm::dvec2>& at = outline.at;
  std::size_t left = at.size(), tests = kTestsPerCorner * left;
  const auto is_ear = [&](std::uint32_t i) {
    const glm::dvec2 &a = at[outline.previous[i]], &b = at[i], &c = at[outline.next[i]];
    if (orientation(a, b, c) <= 0) return false;
    const std::uint32_t last = outline.previous[i];
    for (std::uint32_t k = outline.next[outline.next[i]]; k != last; k = outline.next[k]) {
      if (tests-- == 1) return true;
      const glm::dvec2& p = at[k];
      if (p == a || p == b || p == c) continue;
      if (orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0)
        return false;
    }
    return true;
  };
  std::uint32_t i = 1;
  for (; left > 2; --left) {
    for (std::size_t tried = 0; tried < left && tests > 0 && !is_ear(i); ++tried)
      i = outline.next[i];
    triangles.emplace_back(outline.previous[i], i, outline.next[i]);
    outline.link(outline.previous[i], outline.next[i]);
    i = outline.next[i];
  }
}

}  // namespace

void triangulate_polygon(std::span<const std::uint32_t> corners,
                         std::span<const glm::vec3> positions, std::vector<glm::uvec3>& triangles) {
  const std::size_t n = corners.size();
  if (n < 3) return;
  const std::vector<glm::dvec2> flat =
      n == 3 ? std::vector<glm::dvec2>{} : flatten(corners, positions);
  if (n == 3 || is_convex(flat)) {
    for (std::size_t i = 1; i + 1 < n; ++i)
      triangles.emplace_back(corners[0], corners[i], corners[i + 1]);
    return;
  }
  Emit cut;
  cut.reserve(n);
  const Outline whole(flat);
  Outline outline = whole;
  take_out_repeated(outline, cut);
  take_out_bridges(outline);
  if (!Sweep(outline, cut).run()) {
    cut.clear();
    clip_ears(whole, cut);
  }
  for (const glm::uvec3& t : cut) triangles.emplace_back(corners[t.x], corners[t.y], corners[t.z]);
}

}  // namespace delray::scenes::internal
