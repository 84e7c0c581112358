// delray compare compose: every compositing scheme on one scene, counted, measured and predicted.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/compare/scene_comparison.h"
#include "apps/compare/spread.h"
#include "composite/simulate.h"

namespace delray::apps {

struct CompareRequest : SceneComparison {
  std::vector<std::string> codecs = {"active"};
  std::vector<std::string> schemes;  // empty: all
  bool interlace = false;            // ComposeOptions
  // More ranks than are measured are left out of schemes that might send more messages than this,
  // each of which is simulated; 0: none is left out.
  std::uint64_t most_messages = 0;
};

// The time that a scheme would take.
struct Predicted {
  std::string network;
  double seconds = 0, gather_seconds = 0;
};

// One scheme with one codec on so many ranks.
struct ComparedScheme {
  std::string scheme, codec;
  int ranks = 0;
  composite::Counts counts, gather;
  std::optional<Spread> compose_seconds, gather_seconds;  // measured
  std::optional<Spread> total_seconds;                    // of both, run by run
  std::string hash;                                       // of the picture; empty: not composited
  std::vector<Predicted> predicted;
};

// Not simulated: CompareRequest::most_messages.
struct LeftOut {
  std::string scheme, codec;
  int ranks = 0;
};

struct ShownScheme;

struct ComposeComparison {
  std::vector<ComparedScheme> rows;          // by number of ranks
  std::vector<LeftOut> left_out;             // by number of ranks
  std::shared_ptr<const ShownScheme> shown;  // of the fastest one, if a page is asked for
  int cores = 1;                             // hardware threads; more ranks share them
  bool unfinished = false;                   // told to stop before the end
};

// Compares; complete on the first process only. Told to stop, gives what is finished. Throws as
// render does, parallel::Interrupted where nothing is finished.
ComposeComparison compare_compose(const Session& session, const CompareRequest& request,
                                  const Prepared& prepared, parallel::Progress& progress);

// With so many ranks, the row that took least, compositing and gather, and those that cannot be
// told from it (winners() in verdict.h); empty if none was measured.
std::vector<const ComparedScheme*> fastest(const std::vector<ComparedScheme>& rows, int ranks);
// The fastest by what is predicted over a network; `factor` as in known_within().
std::vector<const ComparedScheme*> fastest_over(const std::vector<ComparedScheme>& rows, int ranks,
                                                std::string_view network, double factor);
// Null if nothing is predicted of it over the network.
const Predicted* prediction(const ComparedScheme& row, std::string_view network);

// By which factor two predictions are off each other's proportion, in the median: of each row that
// was measured, and predicted on this machine, from what is usual with as many ranks. Of other
// networks nothing is known but this. kUnknownFactor where nothing can be checked.
double prediction_factor(const std::vector<ComparedScheme>& rows);

}  // namespace delray::apps
