// Predicts each strategy's frames over each network, and finds where more ranks gain nothing.
//
// Up to kMostMeasuredRanks a rank's drawing takes the processor time that it took. Of more ranks
// drawing is counted, and costs what least squares make of those timed before (raster::fit_prices).
// All other work is timed and all messages are those of the strategy's own code.
//
// Degenerate: where no fewer ranks were timed, drawing takes what it took.
#include "apps/compare/partition/strategy_scaling.h"

#include <algorithm>

#include "comm/network.h"
#include "files/memory_budget.h"

namespace delray::apps {
namespace {

// Ranks that draw for less than some milliseconds tell most of what many ranks will take.
constexpr int kFewestSampled = 4;

raster::PredictedFrame median_of(const std::vector<raster::SimulatedFrame>& frames,
                                 const comm::Network& network) {
  std::vector<raster::PredictedFrame> predicted;
  for (const raster::SimulatedFrame& frame : frames)
    predicted.push_back(raster::predict(frame, network));
  const auto middle = predicted.begin() + static_cast<std::ptrdiff_t>(predicted.size() / 2);
  std::nth_element(predicted.begin(), middle, predicted.end(),
                   [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
  return *middle;
}

std::vector<raster::SimulatedFrame> without_ledgers(
    const std::vector<raster::SimulatedFrame>& frames) {
  std::vector<raster::SimulatedFrame> result;
  for (const raster::SimulatedFrame& frame : frames)
    result.push_back({frame.statistics, {}, frame.drawing});
  return result;
}

void append(std::vector<raster::SimulatedFrame>& to, std::vector<raster::SimulatedFrame>&& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

const char* name(Motion motion) { return motion == Motion::at_rest ? "at rest" : "turning"; }

void ScalingRuns::alone(const SimulatedFrames& frames) {
  const comm::Network none;
  result_.alone_at_rest = median_of(frames.next, none).seconds;
  result_.alone_turning = median_of(frames.turning, none).seconds;
}

void ScalingRuns::timed(const std::string& strategy, int ranks, const SimulatedFrames& frames) {
  if (ranks >= kFewestSampled) {
    Samples& samples = samples_[strategy];
    append(samples.at_rest, without_ledgers(frames.next));
    append(samples.turning, without_ledgers(frames.turning));
  }
  add(strategy, ranks, false, frames);
}

void ScalingRuns::counted(const std::string& strategy, int ranks, SimulatedFrames&& frames) {
  Samples& samples = samples_[strategy];
  const std::uint64_t before = files::resident_set();
  samples.ranks = ranks;
  samples.bytes = frames.resident_bytes - std::min(frames.resident_bytes, before);
  const bool is_priced = !samples.turning.empty();
  if (is_priced) {
    const auto price = [&](const Frames& sampled, Frames& priced) {
      const raster::DrawingPrices prices = raster::fit_prices(sampled, primitives_);
      for (raster::SimulatedFrame& frame : priced) raster::apply_prices(prices, primitives_, frame);
    };
    price(samples.at_rest, frames.next);
    price(samples.turning, frames.turning);
  }
  add(strategy, ranks, is_priced, frames);
}

bool ScalingRuns::fits(const std::string& strategy, int ranks) {
  const Samples& samples = samples_[strategy];
  if (samples.ranks == 0) return true;
  const double more = static_cast<double>(ranks) / samples.ranks;
  const auto bytes = static_cast<std::uint64_t>(static_cast<double>(samples.bytes) * more);
  if (bytes <= files::MemoryBudget(files::machine_memory() / 4 * 3).left()) return true;
  result_.left_out.push_back({strategy, ranks, bytes});
  return false;
}

void ScalingRuns::add(const std::string& strategy, int ranks, bool is_priced,
                      const SimulatedFrames& frames) {
  ScaledStrategy row;
  row.strategy = strategy;
  row.ranks = ranks;
  row.is_priced = is_priced;
  for (const raster::RankStatistics& rank : frames.turning.front().statistics.ranks) {
    row.triangles_max = std::max(row.triangles_max, rank.triangles);
    row.shaded_max = std::max(row.shaded_max, rank.shaded);
    row.bytes_total += rank.bytes_sent;
    row.messages += rank.messages;
  }
  for (const comm::NamedNetwork& named : result_.networks) {
    row.over.push_back({named.name, median_of(frames.next, named.network),
                        median_of(frames.turning, named.network)});
  }
  result_.rows.push_back(std::move(row));
}

const ScaledStrategy::Over* over(const ScaledStrategy& row, std::string_view network) {
  const auto at =
      std::find_if(row.over.begin(), row.over.end(),
                   [&](const ScaledStrategy::Over& one) { return one.network == network; });
  return at == row.over.end() ? nullptr : &*at;
}

ScalingLimit limit_of(const StrategyScaling& scaling, std::string_view strategy,
                      std::string_view network, Motion motion) {
  std::vector<ScaledFrame> frames;
  for (const ScaledStrategy& row : scaling.rows) {
    if (row.strategy != strategy) continue;
    const raster::PredictedFrame& frame = over(row, network)->of(motion);
    frames.push_back(
        {row.ranks, frame.seconds, std::vector<double>(frame.parts.begin(), frame.parts.end())});
  }
  return limit_of(frames, scaling.alone(motion));
}

}  // namespace delray::apps
