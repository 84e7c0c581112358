// The rank that has an area knows all points in it, so it sees which are equal: the first to come
// stays in the triangulation under its row, and if one with a lower row follows, the row is
// replaced when the result is extracted.
//
// Degenerate: points wait until there are D + 1 that are not in one line or plane.
#include "delaunay/distributed/online_insertion.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <optional>
#include <unordered_map>

#include "comm/collectives.h"
#include "delaunay/distributed/first_simplex.h"
#include "delaunay/distributed/remote_insertion.h"

namespace delray::delaunay {
namespace {

template <int D>
struct PlaceHash {
  std::size_t operator()(const Position<D>& place) const {
    std::uint64_t hash = 0;
    for (int k = 0; k < D; ++k) {
      // -0 equals 0.
      hash = (hash ^ std::bit_cast<std::uint64_t>(place[k] + 0.0)) * 0x9e3779b97f4a7c15U;
      hash ^= hash >> 31;
    }
    return static_cast<std::size_t>(hash);
  }
};

template <int D>
class OnlineInsertion final : public OnlineTriangulation {
 public:
  using Make = std::unique_ptr<RankInserter<D>> (*)(const InsertionSite<D>& site);

  OnlineInsertion(comm::Communicator& communicator, const DistributedOptions& options, int spared,
                  Make make)
      : communicator_(communicator), options_(options), spared_(spared), make_(make) {}

  void insert(std::span<const RowPoint> points) override {
    if (!areas_) {
      if (comm::all_reduce_value(communicator_, points.size(), std::plus<>()) == 0) return;
      areas_.emplace(communicator_, points, options_, spared_);
    }
    take_in(areas_->own_points(communicator_, points, D));
    if (!inserter_) {
      first_ = find_first_simplex<D>(communicator_, waiting_);
      if (!first_) return;
      std::erase_if(waiting_, [&](const RowPoint& point) {
        return std::ranges::find(*first_, point.row, &RowPoint::row) != first_->end();
      });
      inserter_ =
          make_({communicator_, *areas_, *first_, options_.triangulate.progress, statistics_});
    }
    const std::uint64_t seed =
        options_.triangulate.seed + static_cast<std::uint64_t>(communicator_.rank());
    inserter_->insert(in_insertion_order<D>(std::exchange(waiting_, {}), seed));
  }

  DistributedTriangulation extract() override {
    DistributedTriangulation result;
    result.part.dim = D;
    if (inserter_) {
      result.part = extract_simplices(inserter_->nodes());
      statistics_.shared_simplices = count_shared(inserter_->nodes(), *areas_);
    }
    result.part.distinct = rows_.size();
    replace_rows(result.part.vertices);
    result.statistics = statistics_;
    return result;
  }

 private:
  // A row in the triangulation, and the lower one of an equal point that came later.
  struct Replaced {
    std::uint64_t row = 0, lowest = 0;
  };

  // Keeps the points that are not there yet for insertion.
  void take_in(const std::vector<RowPoint>& points) {
    for (const RowPoint& point : points) {
      const auto [at, is_new] = rows_.emplace(Position<D>(point.position), point.row);
      if (is_new) {
        waiting_.push_back(point);
        continue;
      }
      const auto [lowest, is_first] = lowest_.emplace(at->second, at->second);
      lowest->second = std::min(lowest->second, point.row);
    }
  }

  void replace_rows(std::vector<std::uint64_t>& vertices) {
    std::vector<Replaced> mine;
    for (const auto& [row, lowest] : lowest_) {
      if (row != lowest) mine.push_back({row, lowest});
    }
    std::unordered_map<std::uint64_t, std::uint64_t> replaced;
    for (const comm::Buffer& each :
         comm::all_gather(communicator_, comm::Buffer::of(std::span<const Replaced>(mine)))) {
      for (const Replaced& one : each.as<Replaced>()) replaced[one.row] = one.lowest;
    }
    if (replaced.empty()) return;
    for (std::uint64_t& row : vertices) {
      if (const auto at = replaced.find(row); at != replaced.end()) row = at->second;
    }
  }

  comm::Communicator& communicator_;
  DistributedOptions options_;
  int spared_;
  Make make_;
  std::optional<Areas> areas_;
  std::optional<FirstSimplex<D>> first_;
  std::vector<RowPoint> waiting_;
  // Of this rank's area: the row of each place in the triangulation, and lower ones that came
  // later.
  std::unordered_map<Position<D>, std::uint64_t, PlaceHash<D>> rows_;
  std::unordered_map<std::uint64_t, std::uint64_t> lowest_;
  DistributedStatistics statistics_;
  std::unique_ptr<RankInserter<D>> inserter_;
};

}  // namespace

std::unique_ptr<OnlineTriangulation> insert_on_line(comm::Communicator& communicator,
                                                    const DistributedOptions& options,
                                                    const InsertionMethod& method) {
  const int spared = method.spared(communicator.size());
  if (options.triangulate.dim == 2) {
    return std::make_unique<OnlineInsertion<2>>(communicator, options, spared, method.in_plane);
  }
  return std::make_unique<OnlineInsertion<3>>(communicator, options, spared, method.in_space);
}

DistributedTriangulation insert_all(comm::Communicator& communicator,
                                    std::span<const RowPoint> points,
                                    const DistributedOptions& options,
                                    const InsertionMethod& method) {
  const auto triangulation = insert_on_line(communicator, options, method);
  triangulation->insert(points);
  return triangulation->extract();
}

}  // namespace delray::delaunay
