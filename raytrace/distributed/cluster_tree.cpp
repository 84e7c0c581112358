// A bounding volume hierarchy over the boxes of clusters, in rows of eight boxes, built by median
// splits along the longest side of the centres (wide trees: Wald, Benthin and Boulos 2008).
//
// A query tests a row by vectors, descends in the order of entry, and gives up what lies behind the
// best hit so far or before the hit that it goes on from. Slabs are widened by what division rounds
// off. O(n log n) to build, O(log n) to search where a line meets little.
//
// Sixteen lines are searched for at once: first by intervals of what they start from and of their
// inverse directions, where they are close to each other (Boulos et al. 2006; rounding is monotone,
// so an interval holds what each line would have computed for itself), then side by side, those of
// them that enter a box (packets: Wald et al. 2001).
//
// Degenerate: equal centres are ordered by number; a line in the plane of a side is decided by the
// other axes; an empty tree is met by nothing.
#include "raytrace/distributed/cluster_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/distributed/cluster_tree.cpp"
#include <hwy/foreach_target.h>
// What is compiled per target comes after it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// What dividing and multiplying may round off.
constexpr float kLess = 1.0F - 0x1p-20F, kMore = 1.0F + 0x1p-20F;

// Of each lane of a row where the line enters the box, at least line.near, and where it leaves it;
// entries after exits: it misses. Lanes that are not used hold anything.
HWY_INLINE void enter_row(const ClusterTree::Row& row, const Line& line, float* entries,
                          float* exits) {
  const hn::CappedTag<float, ClusterTree::kWidth> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto zero = hn::Zero(d), less = hn::Set(d, kLess), more = hn::Set(d, kMore);
  for (int i = 0; i < ClusterTree::kWidth; i += lanes) {
    auto low = hn::Set(d, line.near), high = hn::Set(d, line.far);
    for (int k = 0; k < 3; ++k) {
      const auto origin = hn::Set(d, line.origin[k]), inverse = hn::Set(d, line.inverse[k]);
      const auto a = hn::Mul(hn::Sub(hn::LoadU(d, row.low[k] + i), origin), inverse);
      const auto b = hn::Mul(hn::Sub(hn::LoadU(d, row.high[k] + i), origin), inverse);
      const auto first = hn::Min(a, b), last = hn::Max(a, b);
      const auto in = hn::Mul(first, hn::IfThenElse(hn::Gt(first, zero), less, more));
      const auto out = hn::Mul(last, hn::IfThenElse(hn::Gt(last, zero), more, less));
      // A line in the plane of a side gives a number that is none, which decides nothing.
      const auto decides = hn::And(hn::Eq(a, a), hn::Eq(b, b));
      low = hn::IfThenElse(decides, hn::Max(low, in), low);
      high = hn::IfThenElse(decides, hn::Min(high, out), high);
    }
    hn::StoreU(low, d, entries + i);
    hn::StoreU(high, d, exits + i);
  }
}

// Of lines that all go to the same side: along an axis the least and the largest.
struct Interval {
  float low, high;
};

struct Beam {
  Interval origin[3], inverse[3];
  float near, far;  // the least and the largest
};

// Over the active lanes.
template <class Value>
HWY_INLINE Interval interval_of(std::uint32_t active, const Value& value) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const hn::CappedTag<float, LinePacket::kLines> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  auto low = hn::Set(d, kInfinity), high = hn::Set(d, -kInfinity);
  for (int i = 0; i < LinePacket::kLines; i += static_cast<int>(hn::Lanes(d))) {
    const auto bits = hn::Shl(hn::Set(du, 1U), hn::Iota(du, static_cast<std::uint32_t>(i)));
    const auto used = hn::RebindMask(d, hn::TestBit(hn::Set(du, active), bits));
    const auto v = value(d, i);
    low = hn::IfThenElse(used, hn::Min(low, v), low);
    high = hn::IfThenElse(used, hn::Max(high, v), high);
  }
  return {hn::GetLane(hn::MinOfLanes(d, low)), hn::GetLane(hn::MaxOfLanes(d, high))};
}

// Returns whether the lines make a beam: go into the same octant from places that are numbers.
bool make_beam(const LinePacket& lines, Beam& beam) {
  for (int k = 0; k < 3; ++k) {
    beam.origin[k] =
        interval_of(lines.active, [&](auto d, int i) { return hn::LoadU(d, lines.origin[k] + i); });
    beam.inverse[k] = interval_of(lines.active, [&](auto d, int i) {
      return hn::Div(hn::Set(d, 1.0F), hn::LoadU(d, lines.direction[k] + i));
    });
    const Interval o = beam.origin[k], v = beam.inverse[k];
    const bool one_side = v.low > 0.0F || v.high < 0.0F;
    const bool finite = std::isfinite(o.low) && std::isfinite(o.high) && std::isfinite(v.low) &&
                        std::isfinite(v.high);
    if (!one_side || !finite) return false;
  }
  const auto near = [&](auto d, int i) { return hn::LoadU(d, lines.near + i); };
  const auto far = [&](auto d, int i) { return hn::LoadU(d, lines.far + i); };
  beam.near = interval_of(lines.active, near).low;
  beam.far = interval_of(lines.active, far).high;
  return true;
}

// The lanes of a row whose boxes some line of the beam may enter.
HWY_INLINE std::uint32_t lanes_in_beam(const ClusterTree::Row& row, const Beam& beam) {
  const hn::CappedTag<float, ClusterTree::kWidth> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto zero = hn::Zero(d), less = hn::Set(d, kLess), more = hn::Set(d, kMore);
  std::uint32_t in_beam = 0;
  for (int i = 0; i < ClusterTree::kWidth; i += lanes) {
    auto low = hn::Set(d, beam.near), high = hn::Set(d, beam.far);
    for (int k = 0; k < 3; ++k) {
      const auto least = hn::Set(d, beam.inverse[k].low), most = hn::Set(d, beam.inverse[k].high);
      const bool up = beam.inverse[k].low > 0.0F;
      const auto first = hn::LoadU(d, (up ? row.low[k] : row.high[k]) + i);
      const auto last = hn::LoadU(d, (up ? row.high[k] : row.low[k]) + i);
      // The line that enters first starts closest to the side, the one that leaves last furthest.
      const auto to_first =
          hn::Sub(first, hn::Set(d, up ? beam.origin[k].high : beam.origin[k].low));
      const auto to_last = hn::Sub(last, hn::Set(d, up ? beam.origin[k].low : beam.origin[k].high));
      const auto in = hn::Mul(to_first, hn::IfThenElse(hn::Ge(to_first, zero), least, most));
      const auto out = hn::Mul(to_last, hn::IfThenElse(hn::Ge(to_last, zero), most, least));
      low = hn::Max(low, hn::Mul(in, hn::IfThenElse(hn::Gt(in, zero), less, more)));
      high = hn::Min(high, hn::Mul(out, hn::IfThenElse(hn::Gt(out, zero), more, less)));
    }
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Le(low, high), bits);
    in_beam |= static_cast<std::uint32_t>(bits[0]) << i;
  }
  return in_beam & row.used;
}

// Whether some line of the beam may have a hit.
bool may_hit(std::span<const ClusterTree::Row> rows, const Beam& beam) {
  std::uint32_t stack[ClusterTree::kWidth * 32];
  int height = 0;
  stack[height++] = 0;
  while (height > 0) {
    const ClusterTree::Row& row = rows[stack[--height]];
    const std::uint32_t in_beam = lanes_in_beam(row, beam);
    if ((in_beam & row.leaves) != 0) return true;
    for (std::uint32_t rest = in_beam; rest != 0; rest &= rest - 1)
      stack[height++] = row.child[std::countr_zero(rest)];
  }
  return false;
}

struct alignas(64) Inverses {
  float of[3][LinePacket::kLines];
};

// The lines that enter box `i` of a row, by the arithmetic of enter_row.
HWY_INLINE std::uint32_t lines_in_box(const ClusterTree::Row& row, int box, const LinePacket& lines,
                                      const Inverses& inverses) {
  const hn::CappedTag<float, LinePacket::kLines> d;
  const auto zero = hn::Zero(d), less = hn::Set(d, kLess), more = hn::Set(d, kMore);
  std::uint32_t in_box = 0;
  for (int i = 0; i < LinePacket::kLines; i += static_cast<int>(hn::Lanes(d))) {
    auto enter = hn::LoadU(d, lines.near + i), leave = hn::LoadU(d, lines.far + i);
    for (int k = 0; k < 3; ++k) {
      const auto origin = hn::LoadU(d, lines.origin[k] + i);
      const auto inverse = hn::Load(d, inverses.of[k] + i);
      const auto a = hn::Mul(hn::Sub(hn::Set(d, row.low[k][box]), origin), inverse);
      const auto b = hn::Mul(hn::Sub(hn::Set(d, row.high[k][box]), origin), inverse);
      const auto first = hn::Min(a, b), last = hn::Max(a, b);
      const auto in = hn::Mul(first, hn::IfThenElse(hn::Gt(first, zero), less, more));
      const auto out = hn::Mul(last, hn::IfThenElse(hn::Gt(last, zero), more, less));
      const auto decides = hn::And(hn::Eq(a, a), hn::Eq(b, b));
      enter = hn::IfThenElse(decides, hn::Max(enter, in), enter);
      leave = hn::IfThenElse(decides, hn::Min(leave, out), leave);
    }
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Le(enter, leave), bits);
    in_box |= (static_cast<std::uint32_t>(bits[0]) | static_cast<std::uint32_t>(bits[1]) << 8) << i;
  }
  return in_box;
}

std::uint32_t hit_lines(std::span<const ClusterTree::Row> rows, const LinePacket& lines) {
  if (rows.empty() || lines.active == 0) return 0;
  Beam beam;
  if (make_beam(lines, beam) && !may_hit(rows, beam)) return 0;
  const hn::CappedTag<float, LinePacket::kLines> d;
  Inverses inverses;
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < LinePacket::kLines; i += static_cast<int>(hn::Lanes(d))) {
      hn::Store(hn::Div(hn::Set(d, 1.0F), hn::LoadU(d, lines.direction[k] + i)), d,
                inverses.of[k] + i);
    }
  }
  struct Open {
    std::uint32_t row, lines;
  };
  Open stack[ClusterTree::kWidth * 32];
  int height = 0;
  stack[height++] = {0, lines.active};
  std::uint32_t hits = 0;
  while (height > 0 && hits != lines.active) {
    const Open open = stack[--height];
    const std::uint32_t searching = open.lines & ~hits;
    if (searching == 0) continue;
    const ClusterTree::Row& row = rows[open.row];
    for (std::uint32_t rest = row.used; rest != 0; rest &= rest - 1) {
      const int box = std::countr_zero(rest);
      const std::uint32_t in_box = lines_in_box(row, box, lines, inverses) & searching;
      if (in_box == 0) continue;
      if ((row.leaves >> box & 1) != 0) {
        hits |= in_box;
      } else {
        stack[height++] = {row.child[box], in_box};
      }
    }
  }
  return hits;
}

ClusterHit next_hit(std::span<const ClusterTree::Row> rows, const Line& line,
                    const ClusterHit& after) {
  ClusterHit best{std::numeric_limits<float>::infinity(), kNoCluster};
  if (rows.empty()) return best;
  constexpr int kWidth = ClusterTree::kWidth;
  // Eight a level, and no tree is that deep.
  struct Open {
    float entry;
    std::uint32_t row;
  };
  Open stack[kWidth * 32];
  int height = 0;
  stack[height++] = {line.near, 0};
  while (height > 0) {
    const Open open = stack[--height];
    if (open.entry > best.entry) continue;
    const ClusterTree::Row& row = rows[open.row];
    alignas(32) float entries[kWidth], exits[kWidth];
    enter_row(row, line, entries, exits);
    const int first = height;
    for (std::uint32_t rest = row.used; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      if (!(entries[i] <= exits[i]) || entries[i] > best.entry) continue;
      if ((row.leaves >> i & 1) != 0) {
        const ClusterHit hit{entries[i], row.child[i]};
        if (after < hit && hit < best) best = hit;
      } else if (exits[i] >= after.entry) {
        // The nearest one is searched first: sorted by insertion, it comes last.
        int at = height++;
        for (; at > first && stack[at - 1].entry < entries[i]; --at) stack[at] = stack[at - 1];
        stack[at] = {entries[i], row.child[i]};
      }
    }
  }
  return best;
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {

HWY_EXPORT(next_hit);
HWY_EXPORT(hit_lines);

ClusterTree::ClusterTree(std::vector<ClusterBox> boxes) {
  if (!boxes.empty()) build(boxes);
  rows_.shrink_to_fit();
}

namespace {

// The halves of boxes by their centres along the longest side of those. REQUIRES: two boxes.
std::size_t halve(std::span<ClusterBox> boxes) {
  geometry::Box3 centres;
  for (const ClusterBox& box : boxes) centres.include(box.box.centre());
  const glm::vec3 size = centres.high - centres.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t half = boxes.size() / 2;
  std::nth_element(boxes.begin(), boxes.begin() + static_cast<std::ptrdiff_t>(half), boxes.end(),
                   [axis](const ClusterBox& a, const ClusterBox& b) {
                     const float x = a.box.centre()[axis], y = b.box.centre()[axis];
                     return x != y ? x < y : a.cluster < b.cluster;
                   });
  return half;
}

}  // namespace

std::uint32_t ClusterTree::build(std::span<ClusterBox> boxes) {
  std::vector<std::span<ClusterBox>> parts = {boxes};
  while (parts.size() < kWidth) {
    const auto largest =
        std::max_element(parts.begin(), parts.end(),
                         [](const auto& a, const auto& b) { return a.size() < b.size(); });
    if (largest->size() < 2) break;
    const std::span<ClusterBox> part = *largest;
    const std::size_t half = halve(part);
    *largest = part.first(half);
    parts.push_back(part.subspan(half));
  }
  const auto index = static_cast<std::uint32_t>(rows_.size());
  rows_.emplace_back();
  Row row{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    geometry::Box3 box;
    for (const ClusterBox& each : parts[i]) box.include(each.box);
    for (int k = 0; k < 3; ++k) row.low[k][i] = box.low[k], row.high[k][i] = box.high[k];
    const bool leaf = parts[i].size() == 1;
    row.child[i] = leaf ? parts[i].front().cluster : build(parts[i]);
    row.used |= 1U << i;
    row.leaves |= leaf ? 1U << i : 0U;
  }
  rows_[index] = row;
  return index;
}

ClusterHit ClusterTree::next(const Line& line, const ClusterHit& after) const {
  return HWY_DYNAMIC_DISPATCH(next_hit)(rows_, line, after);
}

std::uint32_t ClusterTree::hit_lines(const LinePacket& lines) const {
  return HWY_DYNAMIC_DISPATCH(hit_lines)(rows_, lines);
}

}  // namespace delray::raytrace
#endif
