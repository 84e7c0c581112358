// Writes the sentences of the first screen: the fastest way to triangulate, by how much, why, how
// it scales, whether all results agree, and the command to use it.
#include "apps/compare/triangulate/triangulate_answer.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/compare/triangulate/triangulate_rows.h"
#include "apps/compare/verdict.h"
#include "apps/report/page.h"
#include "apps/report/series.h"
#include "apps/report/table.h"
#include "delaunay/methods.h"

namespace delray::apps {
namespace {

using namespace report;
using Row = ComparedTriangulation;
using Rows = ComparedTriangulations;

using TriangulationWinners = std::vector<const Row*>;

std::string way_text(const Row& row) {
  return name_of(row.how) + " with " + threads_text(row.how.threads);
}

// The methods that are as fast, and the time of the next one. REQUIRES: !best.empty().
std::string others_sentence(const Rows& rows, const TriangulationWinners& best) {
  const Row& first = *best.front();
  std::vector<std::string> equals;
  for (std::size_t i = 1; i < best.size(); ++i) equals.push_back(way_text(*best[i]));
  std::string text;
  if (!equals.empty())
    text += fmt::format(" There is no difference to {}.", escaped(listed(equals)));
  const Row* next = nullptr;
  for (const Row& row : rows) {
    if (row.points == first.points &&
        std::ranges::none_of(best,
                             [&](const Row* one) { return one->how.method == row.how.method; }) &&
        (next == nullptr || row.seconds.median < next->seconds.median))
      next = &row;
  }
  if (next == nullptr) return text;
  const double times = next->seconds.median / first.seconds.median;
  return text + fmt::format(" {}, the next method, takes {}{}.", escaped(way_text(*next)),
                            measured_text(next->seconds),
                            times < 2 ? fmt::format(", {:.0f} % more", (times - 1) * 100)
                                      : fmt::format(", {:.1f} times as long", times));
}

// The work of the other methods that the best does without.
std::string reason(const Rows& rows, const Row& best) {
  const auto per_point = [](std::uint64_t count, const Row& row) {
    return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(row.points, 1));
  };
  const Row *locks = nullptr, *history = nullptr;
  for (const Row& row : rows) {
    if (row.points != best.points) continue;
    if (locks == nullptr ||
        row.statistics.synchronization.lock_calls > locks->statistics.synchronization.lock_calls)
      locks = &row;
    if (history == nullptr || row.statistics.dag_nodes > history->statistics.dag_nodes)
      history = &row;
  }
  std::vector<std::string> reasons;
  const std::uint64_t own_locks = best.statistics.synchronization.lock_calls;
  const std::uint64_t most_locks = locks->statistics.synchronization.lock_calls;
  if (own_locks > 0) {
    reasons.push_back(
        fmt::format("asks for locks {:.3g} times a point", per_point(own_locks, best)));
  } else if (most_locks > 0) {
    reasons.push_back(fmt::format("takes no locks, which {} asks for {:.3g} times a point",
                                  locks->how.method, per_point(most_locks, *locks)));
  }
  if (best.statistics.dag_nodes == 0 && history->statistics.dag_nodes > 0) {
    reasons.push_back(fmt::format("keeps no history, of which {} has {:.3g} nodes a point",
                                  history->how.method,
                                  per_point(history->statistics.dag_nodes, *history)));
  }
  if (reasons.empty()) return "";
  return fmt::format("It {} (counted).", fmt::join(reasons, ", and "));
}

std::string scaling(const TriangulateComparison& comparison, const Row& best) {
  if (is_alone(best) || comparison.threads.size() < 2) return "";
  const Row* base = base_of(comparison.rows, best);
  if (base == nullptr) return "";
  if (best.how.threads == 1) {
    const Row* more = nullptr;
    for (const Row& row : comparison.rows) {
      if (row.points == best.points && row.how.method == best.how.method && row.how.threads > 1 &&
          row.how.threads <= comparison.cores &&
          (more == nullptr || row.seconds.median < more->seconds.median))
        more = &row;
    }
    if (more == nullptr) return "";
    return fmt::format(" {}: {} with {}.",
                       differ(more->seconds, best.seconds) ? "More threads did not help"
                                                           : "More threads make no difference",
                       measured_text(more->seconds), threads_text(more->how.threads));
  }
  const std::string alone = fmt::format(" One thread takes {}", measured_text(base->seconds));
  if (!differ(base->seconds, best.seconds)) return alone + ": no difference.";
  const double times_as_fast = base->seconds.median / best.seconds.median;
  return fmt::format("{}: that is a speed-up of {:.2f}, an efficiency of {:.2f}.", alone,
                     times_as_fast, times_as_fast / best.how.threads);
}

std::string agreement(const TriangulateComparison& comparison, const Row& best) {
  const Rows same = rows_of(comparison.rows, [&](const Row& r) { return r.points == best.points; });
  const bool agree = std::ranges::all_of(same, [&](const Row& r) { return r.hash == best.hash; });
  if (!agree) {
    return "<strong>The ways to triangulate did not give the same simplices: that is a defect, "
           "please tell us.</strong>";
  }
  const char* what = simplices_text(comparison.dim);
  if (best.simplices == 0) {
    return fmt::format(
        "The points are too few or lie on a {}: there are no {}, and {} ways to triangulate find "
        "that out (counted). Their times tell nothing of points that are not so.",
        comparison.dim == 2 ? "line" : "plane", what, same.size());
  }
  return fmt::format("All {} ways to triangulate gave the same {} {} (counted; hash {}).",
                     same.size(), best.simplices, what, best.hash);
}

// The command to type, without files.
std::string command_of(const Row& row, int cores) {
  delaunay::Options plain;
  plain.dim = row.how.dim;
  std::string command = "delray triangulate";
  if (row.how.dim == 3) command += " --dim 3";
  if (row.how.method != resolve(plain).method) command += " --method " + row.how.method;
  plain.method = row.how.method;
  plain = resolve(plain);
  if (row.how.location != plain.location) command += " --location " + row.how.location;
  if (row.how.split != plain.split) command += " --split " + row.how.split;
  if (row.how.threads != cores && !is_alone(row))
    command += fmt::format(" --threads {}", row.how.threads);
  return command;
}

}  // namespace

Html triangulate_answer(const TriangulateComparison& comparison) {
  const Rows& rows = comparison.rows;
  const std::size_t points = most_points(rows);
  // More threads than cores may win by chance, where there is little to do.
  const Rows uncrowded =
      rows_of(rows, [&](const Row& row) { return row.how.threads <= comparison.cores; });
  const TriangulationWinners own_cores = fastest(uncrowded, points, 0);
  const TriangulationWinners winners = own_cores.empty() ? fastest(rows, points, 0) : own_cores;
  const Row& best = *winners.front();
  std::string text = fmt::format("<p>Use {} with {}: {} points in {}D take {}.",
                                 strong(name_of(best.how)), strong(threads_text(best.how.threads)),
                                 points, comparison.dim, measured_text(best.seconds));
  text += fmt::format(" That is <code>{}</code>.", command_of(best, comparison.cores));
  text +=
      others_sentence(own_cores.empty() ? rows : uncrowded, winners) + "</p>\n<p>" +
      reason(rows, best) + scaling(comparison, best) + "</p>\n<p>" + agreement(comparison, best) +
      crowded_text(comparison) + "</p>\n" +
      paragraph(
          "No difference (\u2248 in the table): the intervals in which the medians lie overlap.");
  Table best_of;
  best_of.columns = {{"points", true, false, {}}};
  for (const int threads : comparison.threads) {
    best_of.columns.push_back({threads_text(threads), false, true, Source::measured});
    best_of.columns.push_back({"ms", true, false, {}});
  }
  for (const std::size_t size : sizes_of(rows)) {
    std::vector<std::string> line = {std::to_string(size)};
    for (const int threads : comparison.threads) {
      const TriangulationWinners of_size = fastest(rows, size, threads);
      std::vector<std::string> names;
      for (const Row* row : of_size) names.push_back(name_of(row->how));
      line.push_back(winners_cell(names));
      line.push_back(of_size.empty() ? "-" : milliseconds_cell(of_size.front()->seconds));
    }
    best_of.rows.push_back(std::move(line));
  }
  return advice_beside(
      text, paragraph("Fastest of so many of the points, chosen at random:") + table(best_of));
}

}  // namespace delray::apps
