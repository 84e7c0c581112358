// Options, checks and output that all comparisons share: a table on the terminal, JSON, a page.
#include "apps/compare/comparison.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/options/help.h"
#include "apps/options/outputs.h"
#include "apps/terminal/terminal.h"
#include "files/atomic_file.h"

namespace delray::apps {
void add_comparison_options(CLI::App& command, ComparisonOptions& options, const std::string& quick,
                            const std::string& listed) {
  command
      .add_option("-o,--output", options.output,
                  "Report to write: a web page that needs no other files (.html)")
      ->type_name("FILE")
      ->group(group::kOutput);
  command.add_flag("--quick", options.quick, quick)->group(group::kOutput);
  command
      .add_option("--stats", options.statistics,
                  "Figures as JSON to this file; - for standard output")
      ->type_name("FILE")
      ->group(group::kOutput);
  command.add_flag("--list", options.list, "List the " + listed)->group(group::kOutput);
}

void check(const Session& session, const ComparisonOptions& options,
           const std::vector<std::string>& inputs) {
  if (!options.output.empty() && !options.output.ends_with(".html"))
    throw UsageError(fmt::format("-o: '{}' does not end in .html", options.output));
  if (!session.first_process) return;
  check_outputs(outputs_of(options), inputs);
}

std::vector<OutputFile> outputs_of(const ComparisonOptions& options) {
  return {{"-o", options.output}, {"--stats", options.statistics}};
}

Json spread_json(const Spread& times) {
  return {{"least", times.least},
          {"most", times.most},
          {"low", times.low},
          {"high", times.high},
          {"runs", times.runs}};
}

std::string range_text(const Spread& times) {
  return fmt::format("{:.4g}..{:.4g}", times.least * 1e3, times.most * 1e3);
}

std::string milliseconds_text(double seconds, int decimals) {
  return fmt::format("{:.{}f}", seconds * 1e3, decimals);
}

std::string ratio_text(double ratio) { return fmt::format("{:.3f}", ratio); }

int shown_ranks_of(const std::vector<int>& ranks, int most) {
  int shown = 0;
  for (const int count : ranks) {
    if (count <= most) shown = std::max(shown, count);
  }
  return shown > 0 ? shown : ranks.front();
}

int report_results(const Session& session, const ComparisonOptions& options, Found&& found) {
  if (session.take_comparison) {
    const bool unfinished = found.unfinished;
    session.take_comparison(std::move(found));
    return unfinished ? int{kInterrupted} : int{kDone};
  }
  if (options.statistics != "-") fmt::print("{}", aligned(found.table, line_width(STDOUT_FILENO)));
  if (!options.output.empty()) files::write_file(options.output, found.page());
  write_statistics(options.statistics, found.statistics);
  if (!found.unfinished) return kDone;
  spdlog::error("interrupted: what was finished is written");
  return kInterrupted;
}

}  // namespace delray::apps
