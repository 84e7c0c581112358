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

// The primitives that are bounded and shared out in groups of at most so many triangles.
struct Grouping {
  std::uint64_t begin = 0, end = 0;
  std::uint32_t triangles = 1;
  bool operator==(const Grouping&) const = default;
};

// How many samples of each group are expected to be seen: all, and those of its large triangles,
// which belong to a group's cost where one rank draws the whole group.
struct VisibleSamples {
  double price = 1;  // of a sample, in the unit of the boxes' costs
  std::vector<double> all, large;
};

// This rank's groups; element i of each vector is of group i.
struct CostedGroups {
  std::vector<Piece> groups;
  // The box on the screen, in pixels, and what the group may cost: its triangles, and the part of
  // its pixels that is seen if all groups lie behind each other at random. Without the pixels of
  // large triangles, of which cut() knows more exactly than by a box. Empty boxes cost nothing.
  std::vector<loadbalance::WeightedBox> boxes;
  VisibleSamples seen;  // if asked for
};

// Cuts the screen frame after frame, by what the frames before have taught. One per rank.
class ScreenPartition {
 public:
  // The triangles to take together for `parts` regions, of so many in the scene.
  static std::uint32_t group_triangles(std::uint64_t triangles, int parts);

  // The groups and their costs. Collective: unless nothing has changed for any rank since the last
  // frame (view, options, grouping), which is asked before anything is bounded, a grid of 16 x 16
  // pixels is summed over ranks and, where costs are measured, every rank says what it did. Valid
  // until the next call.
  const CostedGroups& groups(RankContext& rank, const Grouping& grouping,
                             bool with_visible = false);

  // Primitives are elsewhere than in the last frame. To be told on all ranks.
  void forget_places() {
    last_inputs_.reset();
    grouping_.reset();
  }

  // A number for what groups() and cut() gave last: another one where it may not be what they gave
  // before. It changes on all ranks or on none.
  std::uint64_t version() const { return version_; }

  // The frame cut by its displays where their owners draw, else by options.partition for `parts`
  // owners, of about equal cost over all ranks'
  // groups, or as it was cut for the last frame. Collective; nothing travels if all is unchanged.
  // Valid until the next call. Owner k is rank first_rank + k.
  const loadbalance::Partition& cut(RankContext& rank, int parts, int first_rank = 0);

  // The costs of all primitives, to be cut into so many regions. REQUIRES: a single rank.
  loadbalance::Costs costs(RankContext& rank, int regions);

  // Statistics of the last cut, on rank 0 where options.report_partition asked for it.
  const std::optional<PartitionStatistics>& statistics() const { return statistics_; }

  // Remembers what the rank did in this frame, for the costs of the next.
  void measure(const RankContext& rank);

 private:
  // A partition may be kept only while these stay.
  struct Kind {
    std::string partition;
    int ranks, parts, regions_per_rank;
    double keep_factor;
    std::vector<loadbalance::Region> displays;  // that are the regions
    bool operator==(const Kind&) const = default;
  };

  // All that a rank's groups and their costs depend on besides the scene.
  struct CostInputs {
    int rank, ranks;
    scenes::View view;
    int supersampling;
    Lighting lighting;
    CostSource costs;
    bool cull_single_sided, with_visible;
    bool operator==(const CostInputs& other) const;
  };
  // By group, before other ranks' groups are known: the samples that its triangles cover, how many
  // of these large triangles cover, and what they hide.
  struct GroupBounds {
    std::vector<double> samples, large_samples;
    std::vector<Coverage::Surface> surfaces;
  };

  loadbalance::RasterCostModel model_of(RankContext& rank);
  void group(RankContext& rank, const Grouping& grouping);
  GroupBounds bound(RankContext& rank, const loadbalance::RasterCostModel& model,
                    Coverage& coverage);
  void add_seen(const loadbalance::RasterCostModel& model, const Coverage& coverage,
                const GroupBounds& bounds, bool with_visible);
  void report(const loadbalance::Costs& costs, const loadbalance::Partition& partition, int parts);

  Agreement agreement_;
  std::optional<CostInputs> last_inputs_;
  std::optional<Grouping> grouping_;
  CostedGroups costed_;
  DrawList list_;                       // of the groups
  std::vector<std::uint32_t> draw_of_;  // by group
  bool unchanged_ = false;
  std::uint64_t version_ = 0;
  bool cut_before_ = false, reported_ = false;  // since the ranks agreed
  Kind kind_{};
  std::optional<loadbalance::KeptPartition> kept_;
  loadbalance::Partition by_displays_;
  std::optional<PartitionStatistics> statistics_;
  std::vector<loadbalance::WeightedBox> large_;     // on rank 0: large triangles' pixels
  loadbalance::RasterSample sample_;                // this rank's last frame
  std::vector<loadbalance::RasterSample> samples_;  // all ranks'
};

}  // namespace delray::raster
