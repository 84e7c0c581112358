// delray compare schedule: every schedule handing out the tiles of one ray traced picture.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/compare/scaling_limit.h"
#include "apps/compare/scene_comparison.h"
#include "apps/compare/spread.h"
#include "comm/network.h"
#include "image/image.h"
#include "loadbalance/schedule.h"
#include "raytrace/simulated_frames.h"

namespace delray::apps {

struct ScheduleRequest : SceneComparison {
  std::vector<std::string> schedules;  // empty: all
  // Of a scene that no rank has all of; empty: all of them, none with `quick`.
  std::vector<std::string> distributions;
  int tile = 16;  // pixels, the side
  // Heights at which the hierarchy of a scene that is distributed is cut (cut_levels.h), on most of
  // the ranks that distributions run on.
  std::vector<int> cut_levels;
};

// A schedule on the simulated machine, of whose ranks each has a core: counted there.
struct ScheduleOver {
  std::string network;
  std::uint64_t requests = 0, steals = 0, tasks_stolen = 0, messages = 0, bytes = 0;
  std::uint64_t rays_stolen = 0;  // of tiles that other ranks had begun
  double ray_imbalance = 1;       // rays of the rank that sends most over the mean
  double time_imbalance = 1;      // the same of the time at tiles
  double seconds = 0;             // until the last tile is done
  // The spread of `seconds`, over what tiles took in single frames, brought to the same time for
  // all of them: that of schedules differs where one is better in every frame.
  Spread spread;
  double idle = 0;  // of the ranks' time until then, the part spent waiting or at messages
  // Until rank 0 has the picture, and what the rank that traces longest spends of it: their sum.
  double frame_seconds = 0;
  std::array<double, 4> parts{};  // indexed by kScheduleParts
};

// Messages: the schedule's. Waiting: for tiles. Gather: from the last tile's end until rank 0 has
// the picture.
inline constexpr std::array<const char*, 4> kScheduleParts = {"trace", "messages", "waiting",
                                                              "gather"};

// Frames of ranks that are threads of this process.
struct TracedFrames {
  Spread seconds;  // whole frames
  std::uint64_t requests = 0, steals = 0, rays_stolen = 0, messages = 0;
  double ray_imbalance = 1;
  std::string hash;
};

struct ComparedSchedule {
  std::string schedule;
  int ranks = 0;
  std::vector<ScheduleOver> over;  // the request's network first
  std::optional<TracedFrames> traced;
};

// The cost of a tile, whoever traces it.
struct Tile {
  geometry::Rect pixels;
  std::uint64_t rays = 0;
  Spread seconds;  // of processor time
};

// A distribution of the scene on the simulated machine, with the renderer's default schedule: every
// rank has a part of the geometry. Of frames after the first.
struct ComparedDistribution {
  std::string distribution;
  int ranks = 0;
  struct Over {
    std::string network;
    raytrace::SimulatedFrame frame;
  };
  std::vector<Over> over;  // the request's network first; none that all ranks share
};

// A height of the cut, on the simulated machine. Of a frame after the first.
struct CutLevel {
  int level = 0, ranks = 0;
  std::string network;
  raytrace::SimulatedFrame frame;
};

// A run over the request's network, of shown_ranks(request) or the fewest.
struct ShownSchedule {
  std::string name;
  std::vector<int> owners;  // of tile i
  std::vector<loadbalance::RankReport> ranks;
};

struct ScheduleComparison {
  std::vector<Tile> tiles;
  std::uint64_t rays = 0;
  double seconds = 0;                               // processor time for all tiles
  Spread frame;                                     // that of single frames
  std::vector<ComparedSchedule> rows;               // by ranks
  std::vector<ComparedDistribution> distributions;  // by ranks, few enough to run here
  std::vector<CutLevel> cut_levels;
  std::vector<ShownSchedule> shown;
  image::Image8 picture;
  bool unfinished = false;
};

int shown_ranks(const ScheduleRequest& request);

// On more ranks than this distributions are not run: with `ring` what travels grows with the ranks.
inline constexpr int kMostDistributedRanks = 16;

// Told to stop, gives what is finished. Throws parallel::Interrupted where nothing is finished.
ScheduleComparison compare_schedule(const Session& session, const ScheduleRequest& request,
                                    const Prepared& prepared, parallel::Progress& progress);

// The schedule that is done first with so many ranks over the i-th network of the rows, and those
// that cannot be told from it (winners() in verdict.h). REQUIRES: there are such rows.
std::vector<const ComparedSchedule*> best_schedules(const std::vector<ComparedSchedule>& rows,
                                                    int ranks, std::size_t network = 0);
// Where the schedule stops gaining, over the i-th network of the rows. REQUIRES: it has rows.
ScalingLimit limit_of(const ScheduleComparison& comparison, const std::string& schedule,
                      std::size_t network);
ScalingLimit limit_of_distribution(const ScheduleComparison& comparison,
                                   const std::string& distribution, std::size_t network);
// The best schedules by frames that were traced; empty if none were with so many ranks.
std::vector<const ComparedSchedule*> best_traced(const std::vector<ComparedSchedule>& rows,
                                                 int ranks);

}  // namespace delray::apps
