// The part that all of `delray compare` have in common: options, steps, output of results.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/compare/spread.h"
#include "apps/options/outputs.h"
#include "apps/session.h"
#include "apps/statistics.h"
#include "apps/terminal/text_table.h"
#include "parallel/progress.h"

namespace delray::apps {

struct ComparisonOptions {
  std::string output;      // the page; empty: none
  std::string statistics;  // --stats
  bool quick = false;
  bool list = false;
};

// Adds -o, --quick, --stats and --list with what the last ones do here.
void add_comparison_options(CLI::App& command, ComparisonOptions& options, const std::string& quick,
                            const std::string& listed);
// Throws UsageError, FileError where nothing could be written in the end.
void check(const Session& session, const ComparisonOptions& options,
           const std::vector<std::string>& inputs);
std::vector<OutputFile> outputs_of(const ComparisonOptions& options);

// Least, most and number of the runs, and the interval of their median, which stands elsewhere.
Json spread_json(const Spread& times);
// The range of times in milliseconds, for tables.
std::string range_text(const Spread& times);
// For tables, with so many decimals.
std::string milliseconds_text(double seconds, int decimals);
std::string ratio_text(double ratio);  // with three decimals

constexpr int kMostShownRanks = 16;  // more are too many for one chart or timeline
// The largest of `ranks` that is at most `most`, else the first. REQUIRES: !ranks.empty().
int shown_ranks_of(const std::vector<int>& ranks, int most);

// Runs of a comparison. A stop that was asked for is heard between two of them, where it loses
// nothing.
class Steps {
 public:
  explicit Steps(parallel::Progress& progress) : progress_(progress), inside_(&progress) {}

  void start(std::uint64_t steps) { progress_.start(steps); }
  // So much is finished; goes on whatever was asked for.
  void done(std::uint64_t steps = 1) {
    try {
      progress_.advance(steps);
    } catch (const parallel::Interrupted&) {
    }
  }
  bool stop_requested() const { return progress_.stop_requested(); }
  // Throws parallel::Interrupted.
  void stop_if_asked() const {
    if (stop_requested()) throw parallel::Interrupted{};
  }
  // For what a single run does.
  parallel::Progress* inside() { return &inside_; }

 private:
  parallel::Progress& progress_;
  parallel::Progress inside_;
};

struct Found {
  TextTable table;                    // for people
  Json statistics;                    // for scripts
  bool unfinished = false;            // told to stop before the end
  std::function<std::string()> page;  // made only where it is asked for
};

// Writes what was asked for, or gives it to who takes it in the session; returns the exit code.
int report_results(const Session& session, const ComparisonOptions& options, Found&& found);

}  // namespace delray::apps
