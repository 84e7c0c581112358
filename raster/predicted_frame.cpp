// Splits a replayed frame by what the ledger's phases and the ranks' own clocks say, and prices
// drawing by its counts.
//
// Processor time in the phases of drawing is the four clocks' of the rasterizer and, beyond them,
// preparation. The fit is non-negative least squares by cyclic coordinate descent (Franc, Hlavac
// and Navara 2005), on rows divided by their seconds. O(ranks) but for the replay.
//
// Degenerate: counts that are all 0 have the price 0; ranks that took no time are left out.
#include "raster/predicted_frame.h"

#include <algorithm>
#include <numeric>

#include "comm/replay.h"

namespace delray::raster {
namespace {

using comm::Phase;

double before_gather(const comm::ReplayedRank& rank) {
  double seconds = 0;
  for (int p = 0; p < comm::kPhases; ++p) {
    const auto& phase = rank.phases[static_cast<std::size_t>(p)];
    if (static_cast<Phase>(p) != Phase::gather) seconds += phase.work + phase.handling;
  }
  return seconds;
}

using Counts = std::array<double, 5>;

Counts counts_of(const RankStatistics& rank, int ranks, std::uint64_t primitives) {
  return {1, static_cast<double>(primitives) / ranks, static_cast<double>(rank.triangles_in),
          static_cast<double>(rank.triangles), static_cast<double>(rank.shaded)};
}

}  // namespace

const char* name(Part part) {
  constexpr std::array<const char*, kParts> kNames = {"transform", "estimate", "rasterize",
                                                      "shade",     "prepare",  "redistribute",
                                                      "compose",   "waiting",  "gather"};
  return kNames[static_cast<std::size_t>(part)];
}

PredictedFrame predict(const SimulatedFrame& frame, const comm::Network& network) {
  const std::vector<comm::ReplayedRank> ranks = comm::replay_phases(frame.ledger, network);
  PredictedFrame result;
  double most = -1;
  for (std::size_t k = 0; k < ranks.size(); ++k) {
    result.seconds = std::max(result.seconds, ranks[k].end);
    if (before_gather(ranks[k]) <= most) continue;
    most = before_gather(ranks[k]);
    result.busiest = static_cast<int>(k);
  }
  const auto at = static_cast<std::size_t>(result.busiest);
  const comm::ReplayedRank& rank = ranks[at];
  const Phases& clocks = frame.statistics.ranks[at].phases;
  const auto part = [&](Part one) -> double& {
    return result.parts[static_cast<std::size_t>(one)];
  };
  double drawing = 0;
  for (int p = 0; p < comm::kPhases; ++p) {
    const auto phase = static_cast<Phase>(p);
    const comm::PhaseSeconds& seconds = rank.in(phase);
    if (phase == Phase::gather) continue;
    part(Part::waiting) += seconds.waiting;
    const Part messages = phase == Phase::compose ? Part::compose : Part::redistribute;
    part(messages) += seconds.handling;
    (is_drawing(phase) ? drawing : part(messages)) += seconds.work;
  }
  // The clocks' readings may be a little more than what lies between two calls.
  const double clocked = clocks.transform + clocks.bin + clocks.rasterize + clocks.shade;
  const double scale = clocked > drawing ? drawing / clocked : 1;
  part(Part::transform) = clocks.transform * scale;
  part(Part::estimate) = clocks.bin * scale;
  part(Part::rasterize) = clocks.rasterize * scale;
  part(Part::shade) = clocks.shade * scale;
  part(Part::prepare) = drawing - clocked * scale;
  part(Part::gather) = result.seconds - (rank.end - rank.in(Phase::gather).all());
  return result;
}

DrawingPrices fit_prices(std::span<const SimulatedFrame> frames, std::uint64_t primitives) {
  constexpr std::size_t kPrices = std::tuple_size_v<Counts>;
  constexpr int kSweeps = 2000;
  std::array<Counts, kPrices> products{};  // of columns, each row divided by its seconds
  Counts wanted{};
  for (const SimulatedFrame& frame : frames) {
    const int ranks = static_cast<int>(frame.statistics.ranks.size());
    for (const RankStatistics& rank : frame.statistics.ranks) {
      const double seconds = frame.drawing[static_cast<std::size_t>(rank.rank)];
      if (!(seconds > 0)) continue;
      Counts row = counts_of(rank, ranks, primitives);
      for (double& value : row) value /= seconds;
      for (std::size_t i = 0; i < kPrices; ++i) {
        wanted[i] += row[i] / static_cast<double>(ranks);
        for (std::size_t j = 0; j < kPrices; ++j)
          products[i][j] += row[i] * row[j] / static_cast<double>(ranks);
      }
    }
  }
  DrawingPrices prices;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 0; i < kPrices; ++i) {
      if (!(products[i][i] > 0)) continue;
      double rest = wanted[i];
      for (std::size_t j = 0; j < kPrices; ++j)
        if (j != i) rest -= products[i][j] * prices.seconds[j];
      prices.seconds[i] = std::max(0.0, rest / products[i][i]);
    }
  }
  return prices;
}

double drawing_seconds(const DrawingPrices& prices, const RankStatistics& rank, int ranks,
                       std::uint64_t primitives) {
  const Counts counts = counts_of(rank, ranks, primitives);
  return std::inner_product(counts.begin(), counts.end(), prices.seconds.begin(), 0.0);
}

void apply_prices(const DrawingPrices& prices, std::uint64_t primitives, SimulatedFrame& frame) {
  const int ranks = static_cast<int>(frame.statistics.ranks.size());
  for (std::size_t k = 0; k < frame.ledger.ranks.size(); ++k) {
    RankStatistics& rank = frame.statistics.ranks[k];
    if (!(frame.drawing[k] > 0)) continue;
    const double factor =
        std::min(1.0, drawing_seconds(prices, rank, ranks, primitives) / frame.drawing[k]);
    frame.drawing[k] *= factor;
    for (comm::Event& event : frame.ledger.ranks[k]) {
      if (event.kind == comm::Event::Kind::work && is_drawing(event.phase))
        event.amount = static_cast<std::uint64_t>(static_cast<double>(event.amount) * factor + 0.5);
    }
    rank.busy *= factor;
    for (double* seconds :
         {&rank.phases.transform, &rank.phases.bin, &rank.phases.rasterize, &rank.phases.shade})
      *seconds *= factor;
  }
}

}  // namespace delray::raster
