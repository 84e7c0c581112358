// Divides before it triangulates (Hardwick 1997; Blelloch, Hardwick, Miller and Talmor 1999; Kohout
// 2004, 5.3.3): a line through about the median, the path of Delaunay edges that it crosses, and
// half of the ranks go on with what lies on either side of the path, by x and by y in turn. A rank
// that is alone triangulates. Nothing is merged.
//
// The median is that of the ranks' medians, the path the hull of their hulls (dividing_path.h).
// ceil(log2 ranks) rounds; points on a path are on both sides. In the plane only, as published
// ("limited to E2 only", Kohout 2004, 5.3.3): in space a plane would be crossed by a surface, a
// weighted triangulation of the projected points.
#include <algorithm>
#include <vector>

#include "comm/collectives.h"
#include "delaunay/distributed/areas.h"
#include "delaunay/distributed/dividing_path.h"
#include "delaunay/distributed/method_sources.h"

namespace delray::delaunay {
namespace {

// Below and above which there are about as many points as ranks. Collective.
CutLine median_line(comm::Communicator& group, std::vector<RowPoint>& points, int axis,
                    double share) {
  std::vector<double> own;
  if (!points.empty()) {
    const auto middle = points.begin() +
                        static_cast<std::ptrdiff_t>(share * static_cast<double>(points.size() - 1));
    std::ranges::nth_element(points, middle, {},
                             [axis](const RowPoint& p) { return p.position[axis]; });
    own.push_back(middle->position[axis]);
  }
  std::vector<double> medians;
  for (const comm::Buffer& each :
       comm::all_gather(group, comm::Buffer::of(std::span<const double>(own)))) {
    for (const double median : each.as<double>()) medians.push_back(median);
  }
  std::ranges::sort(medians);
  return {axis, medians.empty() ? 0 : medians[(medians.size() - 1) / 2]};
}

// What a rank gives to either half of its group, each half's ranks in turn. Collective.
std::vector<RowPoint> divide(comm::Communicator& group, const DividingPath& path,
                             const std::vector<RowPoint>& points, int low_ranks) {
  std::vector<RowPoint> kept;
  std::vector<int> ranks;
  std::vector<std::uint64_t> next = {static_cast<std::uint64_t>(group.rank()),
                                     static_cast<std::uint64_t>(group.rank())};
  const int high_ranks = group.size() - low_ranks;
  for (const RowPoint& point : points) {
    const int side = path.side_of(point.position);
    if (side == 0) continue;
    kept.push_back(point);
    ranks.push_back(side < 0 ? static_cast<int>(next[0]++ % static_cast<std::uint64_t>(low_ranks))
                             : low_ranks + static_cast<int>(
                                               next[1]++ % static_cast<std::uint64_t>(high_ranks)));
  }
  std::vector<RowPoint> received = send_points(group, kept, ranks);
  if (group.rank() == 0 || group.rank() == low_ranks) {
    received.insert(received.end(), path.vertices().begin(), path.vertices().end());
  }
  return received;
}

}  // namespace

DistributedTriangulation hardwick(comm::Communicator& communicator,
                                  std::span<const RowPoint> points,
                                  const DistributedOptions& options) {
  std::vector<RowPoint> own(points.begin(), points.end());
  std::vector<DividingPath> paths;
  std::vector<int> sides;
  std::unique_ptr<comm::Communicator> split;
  comm::Communicator* group = &communicator;
  int round = 0;
  for (; group->size() > 1; ++round) {
    communicator.mark(comm::Phase::redistribute, round);
    const int low_ranks = group->size() / 2;
    const CutLine line =
        median_line(*group, own, round % 2, static_cast<double>(low_ranks) / group->size());
    std::vector<RowPoint> hulls;
    const std::vector<RowPoint> hull = lower_hull(line, own);
    for (const comm::Buffer& each :
         comm::all_gather(*group, comm::Buffer::of(std::span<const RowPoint>(hull)))) {
      const auto some = each.as<RowPoint>();
      hulls.insert(hulls.end(), some.begin(), some.end());
    }
    paths.emplace_back(line, lower_hull(line, std::move(hulls)));
    own = divide(*group, paths.back(), own, low_ranks);
    sides.push_back(group->rank() < low_ranks ? -1 : 1);
    auto half = group->split(group->rank() < low_ranks ? 0 : 1, group->rank());
    split = std::move(half);  // the group lives until its half is there
    group = split.get();
  }
  own = distinct_points(std::move(own), 2);
  DistributedTriangulation result =
      triangulate_between(communicator, own, paths, sides, options.triangulate);
  result.part.rounds =
      comm::all_reduce_value(communicator, round, [](int a, int b) { return std::max(a, b); });
  return result;
}

}  // namespace delray::delaunay
