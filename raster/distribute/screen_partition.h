// Which part of the screen is whose, where primitives go to the ranks whose regions they touch.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "loadbalance/cost_model.h"
#include "loadbalance/kept_partition.h"
#include "raster/distribute/agreement.h"
#include "raster/distribute/coverage.h"
#include "raster/pipeline/draws.h"
#include "raster/render.h"

namespace delray::raster {

struct RankContext;

// The pieces cut into groups of at most so many neighbouring triangles. Groups of a piece follow
// each other.
std::vector<Piece> groups_of(std::span<const Piece> pieces, std::uint32_t triangles);

// What boxes_of expects to be seen of each group, in samples, and what one costs: where a group is
// drawn by one rank as a whole, its large triangles belong to its cost.
struct SeenSamples {
  double price = 1;  // in the unit of the boxes' costs
  std::vector<double> all, large;
};

// Cuts the screen frame after frame, by what the frames before have taught. One per rank.
class ScreenPartition {
 public:
  // The triangles to take together for `parts` regions, of so many in the scene.
  static std::uint32_t group_triangles(std::uint64_t triangles, int parts);

  // The box of every group on the screen, in pixels, and what it may cost: its triangles, and the
  // part of its pixels that is seen if all groups lie behind each other at random; cut() knows of
  // those of large triangles, more exactly than by a box. Empty boxes cost nothing. Collective:
  // unless nothing has changed for any rank since the last frame, a grid of 16 x 16 pixels is
  // summed over ranks and, where costs are measured, every rank says what it did.
  std::vector<loadbalance::WeightedBox> boxes_of(RankContext& rank, std::span<const Piece> groups,
                                                 SeenSamples* seen_samples = nullptr);

  // Whether boxes_of gave on all ranks what it gave the last time; never for measured costs.
  bool unchanged() const { return unchanged_; }

  // The frame cut by options.partition for `parts` owners, of about equal cost over all ranks'
  // boxes, or as it was cut for the last frame. Collective; nothing travels if all is unchanged.
  // Valid until the next call. Owner k is
  // rank first_rank + k.
  const loadbalance::Partition& cut(RankContext& rank,
                                    std::span<const loadbalance::WeightedBox> boxes, int parts,
                                    int first_rank = 0);

  // The costs of all primitives, to be cut into so many regions. REQUIRES: a single rank.
  loadbalance::Costs costs(RankContext& rank, int regions);

  // Of the last cut, on rank 0 where options.report_partition asked for it.
  const std::optional<PartitionStatistics>& statistics() const { return statistics_; }

  // Remembers what the rank did in this frame, for the costs of the next.
  void measure(const RankContext& rank);

 private:
  // What decides whether a partition may be kept at all.
  struct Kind {
    std::string partition;
    int ranks, parts, regions_per_rank;
    double keep_factor;
    bool operator==(const Kind&) const = default;
  };

  // What this rank puts into the costs of a frame, and what came out for its groups.
  struct Contribution {
    int rank = -1, ranks = 0;
    geometry::Rect frame;
    int samples_per_pixel = 0;
    loadbalance::RasterCostModel model;
    bool tells_seen = false;
    std::vector<loadbalance::WeightedBox> boxes;
    std::vector<double> samples, large_samples;
    std::vector<Coverage::Square> squares;
    bool operator==(const Contribution&) const = default;
  };
  struct Answer {
    std::vector<loadbalance::WeightedBox> boxes;
    SeenSamples seen;
  };

  Agreement agreement_;
  Contribution last_;
  Answer answer_;
  bool unchanged_ = false;
  bool cut_before_ = false, reported_ = false;  // since the ranks agreed
  Kind kind_{};
  std::optional<loadbalance::KeptPartition> kept_;
  std::optional<PartitionStatistics> statistics_;
  std::vector<loadbalance::WeightedBox> large_;     // on rank 0: large triangles' pixels
  loadbalance::RasterSample sample_;                // this rank's last frame
  std::vector<loadbalance::RasterSample> samples_;  // all ranks'
};

}  // namespace delray::raster
