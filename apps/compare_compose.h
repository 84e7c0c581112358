// delray compare compose: every compositing scheme on one scene, counted, measured and predicted.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/scene_comparison.h"
#include "apps/spread.h"
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

// How long a scheme would take.
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
  bool unfinished = false;                   // told to stop before the end
};

// Compares; complete on the first process only. Told to stop, gives what is finished. Throws as
// render does, parallel::Interrupted where nothing is finished.
ComposeComparison compare_compose(const Session& session, const CompareRequest& request,
                                  const Prepared& prepared, parallel::Progress& progress);

// The row that took least, compositing and gather, with so many ranks; null if none was measured.
const ComparedScheme* fastest(const std::vector<ComparedScheme>& rows, int ranks);

}  // namespace delray::apps
