// How the strategies scale: frames at rest and on a turntable by number of ranks over each network,
// beyond the ranks that anybody measures here.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "apps/compare/scaling_limit.h"
#include "apps/compare/simulated_frames.h"
#include "raster/predicted_frame.h"

namespace delray::apps {

// At rest all is where it was for the frame before; turning, a turntable goes on by six degrees.
enum class Motion : std::uint8_t { at_rest, turning };
inline constexpr Motion kMotions[] = {Motion::at_rest, Motion::turning};
const char* name(Motion motion);

// A strategy on so many ranks.
struct ScaledStrategy {
  std::string strategy;
  int ranks = 0;
  // Whether drawing takes what its counts cost, at prices that are fitted to fewer ranks; else what
  // it took.
  bool is_priced = false;
  // Counted, of a turning frame.
  std::uint64_t triangles_max = 0, shaded_max = 0, bytes_total = 0, messages = 0;
  struct Over {
    std::string network;
    raster::PredictedFrame at_rest, turning;  // each the one with the median time
    const raster::PredictedFrame& of(Motion motion) const {
      return motion == Motion::at_rest ? at_rest : turning;
    }
  };
  std::vector<Over> over;
};

// A strategy on so many ranks that do not fit into memory together.
struct NotScaled {
  std::string strategy;
  int ranks = 0;
  std::uint64_t bytes = 0;  // that they may take, by what fewer took
};

struct StrategyScaling {
  double alone_at_rest = 0, alone_turning = 0;  // seconds of one rank, measured
  std::vector<ScaledStrategy> rows;             // by ascending ranks
  std::vector<NotScaled> left_out;
  std::vector<comm::NamedNetwork> networks;  // of `over` of the rows

  double alone(Motion motion) const {
    return motion == Motion::at_rest ? alone_at_rest : alone_turning;
  }
};

// Predicts frames of strategies, one number of ranks after the other, fewest first.
class ScalingRuns {
 public:
  ScalingRuns(std::uint64_t primitives, std::vector<comm::NamedNetwork> networks)
      : primitives_(primitives) {
    result_.networks = std::move(networks);
  }

  // REQUIRES: frames of a single rank, of which some turn.
  void alone(const SimulatedFrames& frames);
  // Ranks that were few enough to be timed. REQUIRES: some frames turn.
  void timed(const std::string& strategy, int ranks, const SimulatedFrames& frames);
  // Ranks of which only counts are taken, where any of the strategy were timed.
  void counted(const std::string& strategy, int ranks, SimulatedFrames&& frames);

  // Whether so many ranks of the strategy fit into three quarters of the machine's memory, by what
  // fewer took; notes it where they do not.
  bool fits(const std::string& strategy, int ranks);

  const StrategyScaling& result() const { return result_; }

 private:
  using Frames = std::vector<raster::SimulatedFrame>;
  void add(const std::string& strategy, int ranks, bool is_priced, const SimulatedFrames& frames);

  std::uint64_t primitives_;
  // By strategy: frames that were timed, without ledgers; what the last ranks took.
  struct Samples {
    Frames at_rest, turning;
    int ranks = 0;
    std::uint64_t bytes = 0;
  };
  std::map<std::string, Samples> samples_;
  StrategyScaling result_;
};

// Where a strategy stops gaining; parts are raster's. REQUIRES: there are rows of the strategy,
// over this network.
ScalingLimit limit_of(const StrategyScaling& scaling, std::string_view strategy,
                      std::string_view network, Motion motion);

// nullptr where the row has none.
const ScaledStrategy::Over* over(const ScaledStrategy& row, std::string_view network);

}  // namespace delray::apps
