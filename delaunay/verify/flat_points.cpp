// Looks for D + 1 points that are not on one line or plane.
#include "delaunay/verify/flat_points.h"

#include <array>
#include <string>
#include <vector>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "delaunay/predicates.h"
#include "delaunay/verify/local_checks.h"
#include "delaunay/verify/read_again.h"

namespace delray::delaunay::internal {
namespace {

// The first D + 1 points that are not flat, as far as there are such.
template <int D>
class FlatFrame {
 public:
  using Point = glm::vec<D, double>;
  void add(const RowPoint& point) {
    const auto at = [&](std::size_t i) { return Point(frame_[i].position); };
    const Point p(point.position);
    bool independent = frame_.empty();
    if (frame_.size() == 1) independent = p != at(0);
    if (frame_.size() == 2) independent = !collinear(at(0), at(1), p);
    if constexpr (D == 3) {
      if (frame_.size() == 3) independent = orient3d(at(0), at(1), at(2), p) != 0;
    }
    if (independent && frame_.size() <= D) frame_.push_back(point);
  }
  const std::vector<RowPoint>& get() const { return frame_; }

 private:
  std::vector<RowPoint> frame_;
};

}  // namespace

template <int D>
bool check_flat(comm::Communicator& communicator, const PointParts& points, PiecesVerdict& verdict,
                Findings& findings) {
  constexpr std::size_t kMost = D + 1;
  struct Told {
    std::uint64_t points = 0, count = 0;
    std::array<std::uint64_t, kMost> rows{};
  };
  const Told mine = comm::all_or_none(communicator, comm::Phase::other, [&] {
    Told told;
    if (communicator.rank() != 0) return told;
    FlatFrame<D> flat;
    for_points(points, {0, points.parts()}, 0, [&](const RowPoint& point, bool) {
      ++told.points;
      flat.add(point);
    });
    for (const RowPoint& point : flat.get()) told.rows[told.count++] = point.row;
    return told;
  });
  const comm::Buffer shared = comm::broadcast(communicator, 0, comm::Buffer::of_value(mine));
  const Told told = shared.template as<Told>()[0];
  verdict.points = told.points;
  if (told.count <= D) return true;
  std::string rows;
  for (std::size_t k = 0; k <= D; ++k) {
    rows += (k == 0 ? "" : k < D ? ", " : " and ") + std::to_string(told.rows[k]);
  }
  return findings.refuse({}, std::string("there are no ") + Words<D>::simplices + ", but rows " +
                                 rows + " are not " + Words<D>::flat);
}

template bool check_flat<2>(comm::Communicator&, const PointParts&, PiecesVerdict&, Findings&);
template bool check_flat<3>(comm::Communicator&, const PointParts&, PiecesVerdict&, Findings&);

}  // namespace delray::delaunay::internal
