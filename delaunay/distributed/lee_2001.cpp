// Divides into slabs in one step (Lee, Park and Park 2001; Kohout 2004, 5.3.3): as hardwick, but
// all lines at once, parallel, one fewer than ranks. A rank triangulates what lies between two
// paths.
//
// Lines are where a histogram of x says that slabs have about as many points. Every path is the
// hull of the ranks' hulls, joined on one rank each and told to all. Paths do not cross, as a
// triangle is on the side of a line on which its circumcentre lies, so a point is found among them
// by bisection. One round; every rank holds all paths, about sqrt(n) vertices each. In the plane
// only, as hardwick.
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "comm/collectives.h"
#include "delaunay/distributed/areas.h"
#include "delaunay/distributed/dividing_path.h"
#include "delaunay/distributed/method_sources.h"

namespace delray::delaunay {
namespace {

constexpr std::size_t kCellsPerSlab = 64, kMostCells = std::size_t{1} << 20;

// Ascending, one fewer than ranks. Collective.
std::vector<CutLine> slab_lines(comm::Communicator& communicator,
                                std::span<const RowPoint> points) {
  std::array<double, 2> bounds = {std::numeric_limits<double>::lowest(),
                                  std::numeric_limits<double>::lowest()};  // -low, high
  for (const RowPoint& point : points) {
    bounds[0] = std::max(bounds[0], -point.position.x);
    bounds[1] = std::max(bounds[1], point.position.x);
  }
  comm::all_reduce(communicator, std::span<double>(bounds),
                   [](double a, double b) { return std::max(a, b); });
  const double low = -bounds[0], high = bounds[1];
  // Halved, as the difference of large numbers may be infinite.
  const double size = high * 0.5 - low * 0.5;
  const auto slabs = static_cast<std::size_t>(communicator.size());
  const std::size_t cells = std::min(kMostCells, kCellsPerSlab * slabs);
  std::vector<std::uint64_t> counts(cells);
  for (const RowPoint& point : points) {
    const double share = size > 0 ? (point.position.x * 0.5 - low * 0.5) / size : 0;
    ++counts[static_cast<std::size_t>(
        std::clamp(share * static_cast<double>(cells), 0.0, static_cast<double>(cells - 1)))];
  }
  comm::all_reduce(communicator, std::span<std::uint64_t>(counts), std::plus<>());
  std::uint64_t all = 0, below = 0;
  for (const std::uint64_t count : counts) all += count;
  std::vector<CutLine> lines;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    below += counts[cell];
    const double share = static_cast<double>(cell + 1) / static_cast<double>(cells);
    while (lines.size() + 1 < slabs && below * slabs >= all * (lines.size() + 1)) {
      lines.push_back({0, low * (1 - share) + high * share});
    }
  }
  return lines;
}

// The path of each line, of the points of all ranks, on all ranks. Collective. Empty without
// points.
std::vector<DividingPath> find_paths(comm::Communicator& communicator,
                                     const std::vector<CutLine>& lines,
                                     const std::vector<RowPoint>& points) {
  std::vector<comm::Parcel> parcels;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::vector<RowPoint> hull = lower_hull(lines[i], points);
    parcels.push_back({static_cast<int>(i), comm::Buffer::of(std::span<const RowPoint>(hull))});
  }
  std::vector<RowPoint> hulls;
  for (const comm::Parcel& parcel : comm::exchange(communicator, std::move(parcels))) {
    const auto some = parcel.message.as<RowPoint>();
    hulls.insert(hulls.end(), some.begin(), some.end());
  }
  const auto rank = static_cast<std::size_t>(communicator.rank());
  if (rank < lines.size()) hulls = lower_hull(lines[rank], std::move(hulls));
  std::vector<DividingPath> paths;
  const auto all =
      comm::all_gather(communicator, comm::Buffer::of(std::span<const RowPoint>(hulls)));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto vertices = all[i].as<RowPoint>();
    if (vertices.empty()) return {};
    paths.emplace_back(lines[i], std::vector<RowPoint>(vertices.begin(), vertices.end()));
  }
  return paths;
}

// The slab of a point, or -1 if it equals a vertex of a path next to it.
int slab_of(const std::vector<DividingPath>& paths, const RowPoint& point) {
  const auto first = std::ranges::partition_point(
      paths, [&](const DividingPath& path) { return path.side_of(point.position) > 0; });
  if (first != paths.end() && first->side_of(point.position) == 0) return -1;
  return static_cast<int>(first - paths.begin());
}

}  // namespace

DistributedTriangulation lee_2001(comm::Communicator& communicator,
                                  std::span<const RowPoint> points,
                                  const DistributedOptions& options) {
  const std::vector<RowPoint> all(points.begin(), points.end());
  const std::vector<CutLine> lines = slab_lines(communicator, all);
  const std::vector<DividingPath> paths = find_paths(communicator, lines, all);
  std::vector<RowPoint> kept;
  std::vector<int> ranks;
  for (const RowPoint& point : all) {
    const int slab = slab_of(paths, point);
    if (slab < 0) continue;
    kept.push_back(point);
    ranks.push_back(slab);
  }
  std::vector<RowPoint> own = send_points(communicator, kept, ranks);
  std::vector<DividingPath> beside;
  std::vector<int> sides;
  const auto rank = static_cast<std::size_t>(communicator.rank());
  for (const int side : {1, -1}) {
    // The path on the low side of the slab, which lies on its high side, then the other.
    const std::size_t path = rank - (side > 0 ? 1 : 0);
    if ((side > 0 && rank == 0) || path >= paths.size()) continue;
    beside.push_back(paths[path]);
    sides.push_back(side);
    const auto vertices = paths[path].vertices();
    own.insert(own.end(), vertices.begin(), vertices.end());
  }
  own = distinct_points(std::move(own), 2);
  DistributedTriangulation result =
      triangulate_between(communicator, own, beside, sides, options.triangulate);
  result.part.rounds = 1;
  return result;
}

}  // namespace delray::delaunay
