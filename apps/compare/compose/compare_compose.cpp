// Runs every compositing scheme on the same layers, then predicts each from a model of the machine.
//
// Up to kMostMeasuredRanks ranks are measured as threads: schemes take turns in a random order,
// since a machine becomes faster and slower while it is measured. More ranks are simulated: the
// scheme's own code exchanges layers without pixels. The model of this machine is fitted to one
// half of the schemes and predicts the other half, so that no scheme is predicted from its own
// times. Under mpirun its processes are measured instead of threads.
//
// Degenerate: a stop between two runs keeps what is finished; codecs whose messages depend on what
// pixels show are not predicted.
#include "apps/compare/compose/compare_compose.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <thread>

#include "apps/compare/compose/composed_shares.h"
#include "apps/compare/compose/shown_scheme.h"
#include "apps/compare/verdict.h"
#include "apps/render/scene_facts.h"
#include "apps/share_layers.h"
#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "comm/handshake.h"
#include "comm/network.h"
#include "composite/fit_machine.h"
#include "composite/scheme.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::apps {
namespace {

using composite::MachineModel;
using composite::MetadataOnlyImages;

// Samples for the model of this machine are taken with this many ranks at most.
constexpr int kMostFittedRanks = 16;
// Pictures of more ranks would not fit a page.
constexpr int kMostShownPictures = 8;
// A scheme is predicted from the times of the schemes of the other half.
constexpr std::size_t kHalves = 2;
// Steps of the progress bar for a prediction; a run is one step.
constexpr std::size_t kStepsOfPrediction = 10;
// Simulating this many takes long, and nobody has so many on one machine.
constexpr int kMostRanksHere = 256;

std::vector<std::string> schemes_of(const CompareRequest& request) {
  if (!request.schemes.empty()) return request.schemes;
  std::vector<std::string> names;
  for (const composite::Scheme& scheme : composite::schemes()) names.emplace_back(scheme.name);
  return names;
}

int cores_here() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

// The costs of messages between so many threads of this process, before they are fitted.
comm::Network network_here(int ranks) {
  comm::Network network;
  // The latency is that of waking a thread that waits; threads that have a core each stay awake.
  network.latency = ranks <= cores_here() ? 1e-6 : 20e-6;
  network.overhead = 1e-6;
  network.seconds_per_byte = 0;
  network.shared_cores = cores_here();
  return network;
}

// Seconds of each run.
std::vector<double> totals(const MeasuredScheme& measured) {
  std::vector<double> result = measured.compose_seconds;
  for (std::size_t i = 0; i < std::min(result.size(), measured.gather_seconds.size()); ++i)
    result[i] += measured.gather_seconds[i];
  return result;
}

// Appends the schemes that were timed at least once.
void append(const std::vector<MeasuredScheme>& all, int ranks, std::vector<ComparedScheme>& rows) {
  for (const MeasuredScheme& measured : all) {
    if (measured.compose_seconds.empty()) continue;
    rows.push_back({measured.scheme,
                    measured.codec,
                    ranks,
                    measured.compose,
                    measured.gather,
                    spread_of(measured.compose_seconds),
                    spread_of(measured.gather_seconds),
                    spread_of(totals(measured)),
                    measured.hash,
                    {}});
  }
}

// Whether a simulation sends too many messages: by those of fewer ranks, which grow with their
// square at most.
bool takes_long(const CompareRequest& request, const std::vector<ComparedScheme>& rows,
                const std::string& scheme, const std::string& codec, int ranks) {
  if (request.most_messages == 0) return false;
  const ComparedScheme* known = nullptr;
  for (const ComparedScheme& row : rows) {
    if (row.scheme == scheme && row.codec == codec && row.ranks < ranks &&
        (known == nullptr || row.ranks > known->ranks))
      known = &row;
  }
  if (known == nullptr) return false;
  const double growth = static_cast<double>(ranks) / known->ranks;
  return static_cast<double>(known->counts.messages) * growth * growth >
         static_cast<double>(request.most_messages);
}

// The half of the table that a scheme is in; the two take turns.
std::size_t half_of(const CompareRequest& request, const std::string& scheme) {
  const std::vector<std::string> names = schemes_of(request);
  const auto at = std::find(names.begin(), names.end(), scheme);
  return static_cast<std::size_t>(at - names.begin()) % kHalves;
}

// The machine as the schemes of the other half show it, so that no scheme is predicted from its
// own times. Ranks that have a core each and ranks that take turns tell nothing about each other.
MachineModel fit_to_others(const CompareRequest& request, const MachineModel& here,
                           const std::vector<composite::TimedScheme>& samples, int ranks,
                           std::size_t half) {
  std::vector<composite::TimedScheme> others;
  for (const composite::TimedScheme& sample : samples) {
    const auto count = sample.images.count();
    if (half_of(request, sample.scheme) == half ||
        (count <= cores_here()) != (ranks <= cores_here()))
      continue;
    // Ranks that share cores as these do tell most.
    const double octaves = std::log2(static_cast<double>(count) / ranks);
    others.push_back(sample);
    others.back().weight = 1 / (1 + 16 * octaves * octaves);
  }
  return fit_machine(here, others);
}

// Transparent layers are lists of surfaces, for which there is one codec.
std::vector<std::string> codecs_of(const CompareRequest& request, bool are_transparent) {
  return are_transparent ? std::vector<std::string>{"deep"} : request.codecs;
}

// The numbers of ranks that are predicted, ascending: those of the rows, and without MPI those that
// are too many to be measured.
std::vector<int> predicted_ranks(const CompareRequest& request,
                                 const std::vector<ComparedScheme>& rows, bool under_mpi) {
  std::vector<int> ranks;
  for (const ComparedScheme& row : rows) ranks.push_back(row.ranks);
  if (!under_mpi) {
    for (const int count : request.ranks) {
      if (count > kMostMeasuredRanks) ranks.push_back(count);
    }
  }
  std::sort(ranks.begin(), ranks.end());
  ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  return ranks;
}

class SchemeRuns {
 public:
  SchemeRuns(const Session& session, const CompareRequest& request, const Prepared& prepared,
             parallel::Progress& progress)
      : session_(session), request_(request), prepared_(prepared), steps_(progress) {}

  ComposeComparison run() {
    // Each scheme and codec is run several times where it can be, then predicted.
    std::size_t steps = 0;
    for (const int ranks : session_.under_mpi ? std::vector<int>{2} : request_.ranks) {
      steps += kStepsOfPrediction;
      if (ranks <= kMostMeasuredRanks) steps += static_cast<std::size_t>(repeats(ranks)) + 1;
    }
    steps_.start(steps * schemes_of(request_).size() * request_.codecs.size());
    try {
      if (session_.under_mpi) {
        measure_processes();
        if (!session_.first_process) return {};
      } else {
        for (const int ranks : request_.ranks) {
          spdlog::info("{} ranks", ranks);
          if (ranks <= kMostMeasuredRanks) measure_threads(ranks);
        }
      }
      predict();
    } catch (const parallel::Interrupted&) {
      if (rows_.empty()) throw;
      result_.unfinished = true;
    }
    std::stable_sort(rows_.begin(), rows_.end(),
                     [](const auto& a, const auto& b) { return a.ranks < b.ranks; });
    result_.rows = std::move(rows_);
    result_.cores = cores_here();
    return std::move(result_);
  }

 private:
  using Machines = std::vector<std::pair<std::string, MachineModel>>;

  int repeats(int ranks) const { return request_.quick ? 3 : ranks > 16 ? 3 : ranks > 4 ? 9 : 15; }

  composite::ComposeOptions options() const { return {.interlace = request_.interlace}; }

  MetadataOnlyImages metadata_only(int ranks, const std::string& codec) {
    return shapes(ranks).metadata_only(codec, request_.render.width);
  }

  // On every rank. All schemes and codecs take turns, so that none has the better minutes of the
  // machine.
  void measure_all(comm::Communicator& communicator, const raster::PartialImage& share) {
    const int ranks = communicator.size();
    const bool root = communicator.rank() == 0;
    ShareLayers layers(share);
    std::vector<MeasuredScheme> all;
    for (const std::string& codec : codecs_of(request_, is_transparent(share))) {
      for (const std::string& scheme : schemes_of(request_))
        all.push_back({scheme, codec, {}, {}, {}, {}, {}});
    }
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (int turn = 0; turn <= repeats(ranks); ++turn) {
      // In another order each time, the same on all ranks: what ran before leaves its traces in
      // caches.
      std::shuffle(order.begin(), order.end(), std::mt19937(static_cast<unsigned>(turn)));
      for (const std::size_t i : order) {
        MeasuredScheme& measured = all[i];
        // All ranks stop before the same scheme.
        const bool stop = root && steps_.stop_requested();
        if (comm::all_reduce_value(communicator, stop ? 1 : 0, std::plus<>()) > 0) {
          if (root) append(all, ranks, rows_);
          throw parallel::Interrupted{};
        }
        measure(communicator, layers, request_, prepared_, turn == 0, measured);
        if (root) steps_.done();
      }
    }
    if (root) append(all, ranks, rows_);
    if (!request_.output.empty() && ranks == shown_ranks()) show_fastest(communicator, share);
  }

  // The largest measured number of ranks that is small enough for pictures of each.
  int shown_ranks() const {
    return session_.under_mpi ? session_ranks_ : shown_ranks_of(request_.ranks, kMostShownPictures);
  }

  void show_fastest(comm::Communicator& communicator, const raster::PartialImage& share) {
    std::string name;
    if (communicator.rank() == 0) {
      const ComparedScheme& best = *fastest(rows_, communicator.size()).front();
      name = best.scheme + '\n' + best.codec;
    }
    const comm::Buffer message =
        comm::broadcast(communicator, 0, comm::Buffer::of(std::span<const char>(name)));
    const std::span<const char> letters = message.as<char>();
    const std::string all(letters.begin(), letters.end());
    const std::size_t end = all.find('\n');
    ShownScheme shown = show_scheme(communicator, share, all.substr(0, end), all.substr(end + 1),
                                    request_, prepared_);
    if (communicator.rank() == 0)
      result_.shown = std::make_shared<const ShownScheme>(std::move(shown));
  }

  void measure_threads(int ranks) {
    std::vector<raster::PartialImage> shares;
    parallel::Arena(parallel::arena_threads()).execute([&] {
      ShareDrawer drawer(request_, prepared_, steps_.inside());
      for (int rank = 0; rank < ranks; ++rank) {
        shares.push_back(drawer.draw(rank, ranks));
        shapes_[ranks].add(shares.back());
      }
    });
    Launch launch = request_.render.launch;
    launch.ranks = ranks;
    run_ranks(session_, launch, {}, [&](comm::Communicator& communicator) {
      measure_all(communicator, shares[static_cast<std::size_t>(communicator.rank())]);
    });
  }

  void measure_processes() {
    const std::vector<std::string> inputs = {request_.render.scene.file.path};
    run_ranks(session_, request_.render.launch, inputs, [&](comm::Communicator& communicator) {
      comm::handshake(communicator, scene_facts(prepared_));
      session_ranks_ = communicator.size();
      communicator.mark(comm::Phase::rasterize, 0);
      const raster::PartialImage share =
          comm::all_or_none(communicator, comm::Phase::rasterize, [&] {
            ShareDrawer drawer(request_, prepared_, steps_.inside());
            if (communicator.rank() == 0 && communicator.size() <= kMostMeasuredRanks) {
              shapes_.emplace(communicator.size(), drawer.shapes(communicator.size()));
            }
            return drawer.draw(communicator.rank(), communicator.size());
          });
      measure_all(communicator, share);
    });
  }

  const ShareShapes& shapes(int ranks) {
    if (shapes_.count(ranks) == 0) {
      parallel::Arena(parallel::arena_threads()).execute([&] {
        shapes_.emplace(ranks, ShareDrawer(request_, prepared_, steps_.inside()).shapes(ranks));
      });
    }
    return shapes_.at(ranks);
  }

  // Counts what was not measured, and predicts everything.
  void predict() {
    const std::vector<int> counts = predicted_ranks(request_, rows_, session_.under_mpi);
    if (counts.empty()) return;
    const bool are_transparent = shapes(counts.front()).are_transparent();
    if (are_transparent && request_.codecs != CompareRequest().codecs)
      spdlog::warn("something is transparent: lists of surfaces travel, whatever --codec says");
    for (const std::string& codec : codecs_of(request_, are_transparent)) predict(codec, counts);
  }

  void predict(const std::string& codec, const std::vector<int>& counts) {
    if (!composite::metadata_only_of(codec)) {
      spdlog::warn("nothing is predicted of codec {}, whose messages depend on what pixels show",
                   codec);
      return;
    }
    const composite::Codec* flat = composite::find_codec(codec);
    const composite::LayerCosts costs =
        flat != nullptr ? measure_layer_costs(*flat) : composite::measure_deep_layer_costs();
    const std::vector<composite::TimedScheme> samples = samples_of(codec);
    for (const int ranks : counts) {
      const MetadataOnlyImages images = metadata_only(ranks, codec);
      std::array<Machines, kHalves> machines;  // by the half that a scheme is in
      for (std::size_t half = 0; half < kHalves; ++half) {
        for (const comm::NamedNetwork& named : request_.networks) {
          machines[half].emplace_back(named.name, MachineModel{named.network, costs});
        }
        if (ranks > kMostRanksHere) continue;
        machines[half].emplace_back(
            kThisMachine,
            fit_to_others(request_, {network_here(ranks), costs}, samples, ranks, half));
      }
      if (ranks > kMostMeasuredRanks) {
        for (const std::string& scheme : schemes_of(request_)) {
          if (takes_long(request_, rows_, scheme, codec, ranks)) {
            result_.left_out.push_back({scheme, codec, ranks});
            steps_.done(kStepsOfPrediction);
          } else {
            rows_.push_back(
                simulated_row(scheme, codec, images, machines[half_of(request_, scheme)]));
          }
        }
      } else {
        for (ComparedScheme& row : rows_) {
          if (row.codec != codec || row.ranks != ranks) continue;
          steps_.stop_if_asked();
          steps_.done(kStepsOfPrediction);
          predict(row, images, machines[half_of(request_, row.scheme)]);
        }
      }
      if (ranks > kMostFittedRanks) shapes_.erase(ranks);
    }
  }

  // Counted and predicted at once.
  ComparedScheme simulated_row(const std::string& scheme, const std::string& codec,
                               const MetadataOnlyImages& images, const Machines& machines) {
    ComparedScheme row;
    row.scheme = scheme;
    row.codec = codec;
    row.ranks = images.count();
    const composite::Simulated run = predict(row, images, machines);
    row.counts = run.compose;
    row.gather = run.gather;
    steps_.done(kStepsOfPrediction);
    return row;
  }

  // The machines at the same time. Returns any one, as what is counted is the same on all.
  composite::Simulated predict(ComparedScheme& row, const MetadataOnlyImages& images,
                               const Machines& machines) {
    std::vector<composite::Simulated> runs(machines.size());
    parallel::parallel_for(0, machines.size(), 1, [&](std::size_t i) {
      steps_.stop_if_asked();
      runs[i] = simulate(row.scheme, images, machines[i].second, options());
    });
    for (std::size_t i = 0; i < machines.size(); ++i) {
      row.predicted.push_back({machines[i].first, runs[i].compose_seconds, runs[i].gather_seconds});
    }
    return runs.back();
  }

  std::vector<composite::TimedScheme> samples_of(const std::string& codec) {
    std::vector<composite::TimedScheme> samples;
    for (const ComparedScheme& row : rows_) {
      if (row.codec != codec || row.ranks > kMostFittedRanks || row.ranks < 2) continue;
      if (!row.compose_seconds) continue;
      samples.push_back({row.scheme, metadata_only(row.ranks, codec),
                         std::max(1e-9, row.compose_seconds->median), 1, options()});
    }
    return samples;
  }

  const Session& session_;
  const CompareRequest& request_;
  const Prepared& prepared_;
  Steps steps_;
  int session_ranks_ = 0;  // processes of mpirun
  ComposeComparison result_;
  std::map<int, ShareShapes> shapes_;  // by number of ranks
  std::vector<ComparedScheme> rows_;
};

}  // namespace

ComposeComparison compare_compose(const Session& session, const CompareRequest& request,
                                  const Prepared& prepared, parallel::Progress& progress) {
  return SchemeRuns(session, request, prepared, progress).run();
}

namespace {

template <class Wanted>
std::vector<const ComparedScheme*> rows_of(const std::vector<ComparedScheme>& rows, int ranks,
                                           Wanted&& wanted) {
  std::vector<const ComparedScheme*> result;
  for (const ComparedScheme& row : rows)
    if (row.ranks == ranks && wanted(row)) result.push_back(&row);
  return result;
}

}  // namespace

std::vector<const ComparedScheme*> fastest(const std::vector<ComparedScheme>& rows, int ranks) {
  const auto measured =
      rows_of(rows, ranks, [](const ComparedScheme& row) { return row.total_seconds.has_value(); });
  return winners<ComparedScheme>(measured,
                                 [](const ComparedScheme& row) { return *row.total_seconds; });
}

std::vector<const ComparedScheme*> fastest_over(const std::vector<ComparedScheme>& rows, int ranks,
                                                std::string_view network, double factor) {
  const auto predicted = rows_of(
      rows, ranks, [&](const ComparedScheme& row) { return prediction(row, network) != nullptr; });
  return winners<ComparedScheme>(predicted, [&](const ComparedScheme& row) {
    const Predicted* p = prediction(row, network);
    return known_within(p->seconds + p->gather_seconds, factor);
  });
}

const Predicted* prediction(const ComparedScheme& row, std::string_view network) {
  const auto at = std::find_if(row.predicted.begin(), row.predicted.end(),
                               [&](const Predicted& p) { return p.network == network; });
  return at == row.predicted.end() ? nullptr : &*at;
}

double prediction_factor(const std::vector<ComparedScheme>& rows) {
  std::map<int, std::vector<double>> ratios;  // of predicted to measured times, by ranks
  for (const ComparedScheme& row : rows) {
    const Predicted* p = prediction(row, kThisMachine);
    if (p == nullptr || !row.total_seconds || !(row.total_seconds->median > 0)) continue;
    const double seconds = p->seconds + p->gather_seconds;
    if (seconds > 0) ratios[row.ranks].push_back(seconds / row.total_seconds->median);
  }
  std::vector<double> factors;
  for (const auto& [ranks, of_ranks] : ratios) {
    if (of_ranks.size() < 2) continue;
    const double usual = spread_of(of_ranks).median;
    for (const double ratio : of_ranks) factors.push_back(std::max(ratio / usual, usual / ratio));
  }
  return factors.empty() ? kUnknownFactor : spread_of(factors).median;
}

}  // namespace delray::apps
