// Bounds the triangles of a cluster by vectors, one lane a triangle: boxes, areas, culling, as
// set_up.h does for one. Gathers corners, and needs nothing but 32 bits as long as corners are less
// than 128 pixels apart.
//
// Degenerate: wider triangles are left to the caller, as are large ones.
#include "raster/pipeline/triangle_boxes.h"

#include <algorithm>
#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/pipeline/triangle_boxes.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

#include "raster/pipeline/triangle_lanes.h"

#ifndef DELRAY_RASTER_TRIANGLE_BOXES
#define DELRAY_RASTER_TRIANGLE_BOXES
namespace delray::raster {

// Doubled areas fit 32 bits if coordinates differ by no more.
inline constexpr std::int32_t kWidest = 32766;
static_assert(std::int64_t{2} * kWidest * kWidest < INT32_MAX);

}  // namespace delray::raster
#endif

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void find_boxes(const ClusterOnScreen& of, TriangleBoxes& boxes) {
  const Ints d;
  const std::size_t lanes = hn::Lanes(d);
  const std::uint8_t* corners = of.block.corners.data() + of.cluster.first_corner;
  const std::size_t stride = of.cluster.corner_stride();
  const Origins origin = {hn::Set(d, of.screen.centre_x), hn::Set(d, of.screen.centre_y)};
  const I zero = hn::Zero(d), one = hn::Set(d, 1);
  Mask any_alone = hn::FirstN(d, 0);
  for (std::size_t place = 0; place < of.cluster.count; place += lanes) {
    const auto [a, b, c] = load_corners(corners, stride, place);
    const I ax = hn::GatherIndex(d, of.vertices.x, a), ay = hn::GatherIndex(d, of.vertices.y, a);
    const I bx = hn::GatherIndex(d, of.vertices.x, b), by = hn::GatherIndex(d, of.vertices.y, b);
    const I cx = hn::GatherIndex(d, of.vertices.x, c), cy = hn::GatherIndex(d, of.vertices.y, c);
    const Boxes box = boxes_of(of.screen.frame(), origin, ax, ay, bx, by, cx, cy);
    const I abx = hn::Sub(bx, ax), aby = hn::Sub(by, ay);
    const I acx = hn::Sub(cx, ax), acy = hn::Sub(cy, ay);
    const I widest =
        hn::Max(hn::Max(hn::Abs(abx), hn::Abs(aby)), hn::Max(hn::Abs(acx), hn::Abs(acy)));
    const I area = hn::Sub(hn::Mul(abx, acy), hn::Mul(acx, aby));
    const Mask clockwise = hn::Gt(area, zero), counter = hn::Lt(area, zero);
    const Mask shown = shown_of(of.draw.hidden_side, clockwise, counter);
    const I columns = hn::Add(hn::Sub(box.x1, box.x0), one);
    const I rows = hn::Add(hn::Sub(box.y1, box.y0), one);
    const I in_box = hn::Mul(columns, rows);
    const Mask in_range = hn::FirstN(d, std::min(lanes, of.cluster.count - place));
    const Mask touches = hn::And(hn::And(hn::Gt(columns, zero), hn::Gt(rows, zero)), in_range);
    const Mask alone = hn::And(touches, hn::Or(hn::Gt(widest, hn::Set(d, kWidest)),
                                               hn::Gt(in_box, hn::Set(d, kLargeBox))));
    const Mask kept = hn::AndNot(alone, hn::And(touches, shown));
    any_alone = hn::Or(any_alone, alone);
    const I covered = hn::Add(hn::ShiftRight<2 * kSubpixelBits + 1>(hn::Abs(area)), one);
    const I pixels = hn::IfThenElseZero(kept, hn::Min(covered, in_box));
    hn::Store(hn::IfThenElse(alone, hn::Set(d, TriangleBoxes::kAlone), pixels), d,
              boxes.pixels + place);
    const I first = hn::Set(d, INT32_MAX), last = hn::Set(d, INT32_MIN);
    hn::Store(hn::IfThenElse(kept, hn::Add(box.x0, origin.x), first), d, boxes.x0 + place);
    hn::Store(hn::IfThenElse(kept, hn::Add(box.y0, origin.y), first), d, boxes.y0 + place);
    hn::Store(hn::IfThenElse(kept, hn::Add(hn::Add(box.x1, origin.x), one), last), d,
              boxes.x1 + place);
    hn::Store(hn::IfThenElse(kept, hn::Add(hn::Add(box.y1, origin.y), one), last), d,
              boxes.y1 + place);
  }
  boxes.any_alone = !hn::AllFalse(d, any_alone);
}

void sum_boxes(const TriangleBoxes& boxes, std::size_t begin, std::size_t end, SumOfBoxes& sum) {
  const Ints d;
  const std::size_t lanes = hn::Lanes(d);
  const I zero = hn::Zero(d), one = hn::Set(d, 1);
  const I first = hn::Set(d, INT32_MAX), last = hn::Set(d, INT32_MIN);
  I x0 = first, y0 = first, x1 = last, y1 = last, pixels = zero, triangles = zero;
  for (std::size_t place = begin; place < end; place += lanes) {
    const Mask here = hn::FirstN(d, std::min(lanes, end - place));
    const auto load = [&](const std::int32_t* values, I otherwise) HWY_ATTR {
      return hn::IfThenElse(here, hn::LoadU(d, values + place), otherwise);
    };
    x0 = hn::Min(x0, load(boxes.x0, first));
    y0 = hn::Min(y0, load(boxes.y0, first));
    x1 = hn::Max(x1, load(boxes.x1, last));
    y1 = hn::Max(y1, load(boxes.y1, last));
    const I pixels_here = hn::Max(load(boxes.pixels, zero), zero);
    pixels = hn::Add(pixels, pixels_here);
    triangles = hn::Add(triangles, hn::Min(pixels_here, one));
  }
  sum.triangles = static_cast<std::uint64_t>(hn::GetLane(hn::SumOfLanes(d, triangles)));
  if (sum.triangles == 0) return;
  sum.pixels = static_cast<std::uint64_t>(hn::GetLane(hn::SumOfLanes(d, pixels)));
  sum.box = {hn::GetLane(hn::MinOfLanes(d, x0)), hn::GetLane(hn::MinOfLanes(d, y0)),
             hn::GetLane(hn::MaxOfLanes(d, x1)), hn::GetLane(hn::MaxOfLanes(d, y1))};
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(find_boxes);
HWY_EXPORT(sum_boxes);

namespace {

void find_splat_boxes(const ClusterOnScreen& cluster, TriangleBoxes& boxes) {
  boxes.any_alone = false;
  const std::uint32_t padded = cluster.cluster.corner_stride();
  for (std::uint32_t place = 0; place < padded; ++place) {
    boxes.pixels[place] = TriangleBoxes::kCulled;
    boxes.x0[place] = boxes.y0[place] = INT32_MAX;
    boxes.x1[place] = boxes.y1[place] = INT32_MIN;
    if (place >= cluster.cluster.count) continue;
    const geometry::Rect pixels =
        make_splat(cluster.screen, cluster.draw.splats, *cluster.draw.draw->mesh,
                   cluster.cluster.first + place, 0)
            .pixels;
    if (pixels.empty()) continue;
    const bool large = pixels.area() > kLargeBox;
    boxes.pixels[place] = large ? TriangleBoxes::kAlone : static_cast<std::int32_t>(pixels.area());
    boxes.any_alone |= large;
    if (large) continue;
    boxes.x0[place] = pixels.x0, boxes.y0[place] = pixels.y0;
    boxes.x1[place] = pixels.x1, boxes.y1[place] = pixels.y1;
  }
}

}  // namespace

void find_boxes(const ClusterOnScreen& cluster, TriangleBoxes& boxes) {
  assert(!cluster.vertices.any_outside);
  if (cluster.draw.splats.any()) {
    find_splat_boxes(cluster, boxes);
    return;
  }
  HWY_DYNAMIC_DISPATCH(find_boxes)(cluster, boxes);
}

SumOfBoxes sum_of(const TriangleBoxes& boxes, std::uint32_t begin, std::uint32_t end) {
  SumOfBoxes sum;
  HWY_DYNAMIC_DISPATCH(sum_boxes)(boxes, begin, end, sum);
  return sum;
}

}  // namespace delray::raster
#endif
