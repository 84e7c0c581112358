// delray compare partition: every partition of the screen on one scene, and the strategies that use
// them beside those that do not.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/compare/partition/strategy_scaling.h"
#include "apps/compare/scene_comparison.h"
#include "apps/compare/spread.h"
#include "image/image.h"
#include "loadbalance/partition.h"
#include "loadbalance/wall.h"

namespace delray::apps {

struct PartitionRequest : SceneComparison {
  std::vector<std::string> partitions;  // empty: all
  std::vector<int> regions = {1, 4};    // per rank; other than the first for shown_ranks alone
};

// The time that a frame would take on a machine with a core for each rank.
struct PredictedFrame {
  std::string network;
  double seconds = 0;        // the median of frames after the first
  Spread spread;             // of these
  double first_seconds = 0;  // when the screen is cut and primitives travel
};

// Ranks that drew frames. Counts are of the first frame, times of those after it.
struct DrawnFrames {
  std::uint64_t bytes_total = 0, messages = 0;
  std::uint64_t bytes_next = 0;  // of a frame after the first
  std::uint64_t triangles_total = 0, triangles_max = 0, shaded_max = 0;
  // Triangles and samples at the renderer's prices (raster::cost_model), in samples.
  std::vector<double> work;  // by rank
  double work_imbalance = 1;
  double work_over_share = 1;  // the most over an equal share of what one rank alone does
  Spread busiest;              // processor time of the busiest rank, seconds
  Spread imbalance;            // its processor time over the mean
  std::vector<double> busy;    // medians, by rank
  std::vector<PredictedFrame> predicted;
  std::string hash;  // of the picture
};

struct ComparedPartition {
  std::string partition;
  int ranks = 0, regions_per_rank = 1;
  std::size_t regions = 0;
  std::uint64_t primitives = 0, shared = 0;  // in the frame; of those, in several ranks' regions
  double overlap = 1;                        // ranks that get a primitive, on average
  Spread cut_seconds;
  double predicted_imbalance = 1, predicted_over_share = 1;  // of the costs that it was cut by
  std::optional<DrawnFrames> drawn;                          // sort-first
  // Of a wall: pixels that are drawn by another rank than the one that shows them.
  std::optional<loadbalance::PixelTraffic> to_displays;
  // Until the busiest rank is done if the screen is cut anew: what cutting takes and, predicted
  // from counts, the busiest rank.
  double finish_seconds = 0;
};

struct ComparedStrategy {
  std::string strategy;
  int ranks = 0;
  DrawnFrames drawn;
};

// A wall of displays shown by so many ranks. Pixels are counted, sent and received, of the rank
// that has most of them, without those that bezels hide.
struct ComparedWall {
  int ranks = 0;
  std::uint64_t gathered = 0;  // were all brought to rank 0, as without a wall
  // Each display drawn by the rank that shows it (--draw-at-home): no pixel travels, and displays
  // are as uneven as the scene makes them, as the costs foretell it.
  double predicted_over_share = 1, overlap = 1;
};

// Lines that are drawn over the picture.
struct ShownPartition {
  std::string name;
  loadbalance::Partition partition;
  // By rank: what the costs foretold; as DrawnFrames.
  std::vector<double> predicted, work, busy;
};

struct PartitionComparison {
  // The work of one rank alone: processor time of a frame; as DrawnFrames::work.
  double alone_seconds = 0, alone_work = 0;
  Spread alone;                              // of alone_seconds
  std::vector<ComparedPartition> rows;       // by ranks and regions
  std::vector<ComparedStrategy> strategies;  // with the first partition of the table
  StrategyScaling scaling;                   // of these and of more ranks
  std::vector<ComparedWall> walls;           // by ranks, where there is a wall
  std::vector<ShownPartition> shown;         // of shown_ranks(request)
  image::Image8 picture;
  std::vector<comm::NamedNetwork> networks;  // of predictions
  bool unfinished = false;
};

// Few enough that their regions can be told apart.
int shown_ranks(const PartitionRequest& request);

// Told to stop, gives what is finished. Throws as render does, parallel::Interrupted where nothing
// is finished.
PartitionComparison compare_partition(const PartitionRequest& request, const Prepared& prepared,
                                      parallel::Progress& progress);

// Shares that are so little less even are as good: on another scene the order would change.
inline constexpr double kAsEven = 1.05;

// The most work that a rank does over an equal share of what one does alone: counted, or of more
// ranks than are drawn as the costs foretell it.
double over_share(const ComparedPartition& row);

// Whether the busiest rank takes longer by more than kAsEven, and that can be told (differ()).
bool takes_longer(const Spread& seconds, const Spread& least);

// Which partition to take, by what is counted and by processor time.
struct PartitionChoice {
  // The partitions whose over_share is the least or within kAsEven of it.
  std::vector<const ComparedPartition*> even;
  // The partitions whose busiest rank takes least processor time, or not takes_longer() than that,
  // by ascending medians; empty of ranks that are not drawn.
  std::vector<const ComparedPartition*> quick;
  // The partitions that are both, or `even` where none is, that are cut soonest or cannot be told
  // from it.
  std::vector<const ComparedPartition*> best;
  // Whether `best` are among `quick`; true where nothing was drawn.
  bool agree = true;
};

// Among rows of so many ranks with as many regions each as in the first row; all members are empty
// if there is none.
PartitionChoice choose_partition(const std::vector<ComparedPartition>& rows, int ranks);

}  // namespace delray::apps
