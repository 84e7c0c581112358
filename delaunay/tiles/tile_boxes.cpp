// Boxes and extreme points of tiles, and trees over the boxes.
#include "delaunay/tiles/tile_boxes.h"

namespace delray::delaunay {
namespace {

template <class Point>
std::vector<geometry::Box<Point>> boxes_of(std::span<const TileSummary> summaries) {
  std::vector<geometry::Box<Point>> boxes;
  for (const TileSummary& each : summaries) {
    boxes.push_back({Point(each.box.low), Point(each.box.high)});
  }
  return boxes;
}

// Whether a comes before b along an axis; ties by the other coordinates, then the lower row, so
// that of equal points the one that represents them is first.
bool comes_before(const RowPoint& a, const RowPoint& b, int axis, int dim, bool descending) {
  for (int i = 0; i < dim; ++i) {
    const int k = (axis + i) % dim;
    if (a.position[k] != b.position[k]) {
      return (a.position[k] < b.position[k]) != (descending && i == 0);
    }
  }
  return a.row < b.row;
}

}  // namespace

void TileSummary::include(const RowPoint& point, int dim) {
  const glm::dvec3 place = dim == 2 ? glm::dvec3(glm::dvec2(point.position), 0) : point.position;
  bool inside = extreme_count > 0;
  for (int k = 0; k < dim; ++k) inside &= box.low[k] < place[k] && place[k] < box.high[k];
  if (inside) return;
  box.include(place);
  const bool first = extreme_count == 0;
  extreme_count = static_cast<std::uint64_t>(2 * dim);
  for (int axis = 0; axis < dim; ++axis) {
    for (const bool descending : {false, true}) {
      RowPoint& extreme = extremes[2 * axis + (descending ? 1 : 0)];
      if (first || comes_before(point, extreme, axis, dim, descending)) extreme = point;
    }
  }
}

void TileSummary::include(const TileSummary& other, int dim) {
  for (std::uint64_t i = 0; i < other.extreme_count; ++i) include(other.extremes[i], dim);
}

TileBoxes::TileBoxes(std::span<const TileSummary> summaries)
    : plane_(boxes_of<glm::dvec2>(summaries)), space_(boxes_of<glm::dvec3>(summaries)) {
  for (const TileSummary& each : summaries) boxes_.push_back(each.box);
}

}  // namespace delray::delaunay
