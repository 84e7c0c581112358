#include "apps/triangulate_answer.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/report/page.h"
#include "apps/report/series.h"
#include "apps/report/table.h"
#include "apps/triangulate_rows.h"
#include "delaunay/methods.h"

namespace delray::apps {
namespace {

using namespace report;
using Row = ComparedTriangulation;
using Rows = ComparedTriangulations;

// What else is as good, and whether that is certain.
std::string next_sentence(const Rows& rows, const Row& best) {
  const Row* next = nullptr;
  for (const Row& row : rows)
    if (row.points == best.points && row.how.method != best.how.method &&
        (next == nullptr || row.seconds.median < next->seconds.median))
      next = &row;
  if (next == nullptr) return "";
  const double times = next->seconds.median / best.seconds.median;
  const bool apart = next->seconds.least > best.seconds.most;
  const char* doubt = apart && times > 1.5     ? ""
                      : best.seconds.runs == 1 ? " once"
                      : apart                  ? ""
                                               : ", which other runs may turn round";
  return fmt::format(" {} with {}, the next method, takes {} (measured{}).",
                     escaped(name_of(next->how)), threads_text(next->how.threads),
                     times < 2 ? fmt::format("{:.0f} % more", (times - 1) * 100)
                               : fmt::format("{:.1f} times as long", times),
                     doubt);
}

// What the others do that it does not.
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
  if (own_locks > 0)
    reasons.push_back(
        fmt::format("asks for locks {:.3g} times a point", per_point(own_locks, best)));
  else if (most_locks > 0)
    reasons.push_back(fmt::format("takes no locks, which {} asks for {:.3g} times a point",
                                  locks->how.method, per_point(most_locks, *locks)));
  if (best.statistics.dag_nodes == 0 && history->statistics.dag_nodes > 0)
    reasons.push_back(fmt::format("keeps no history, of which {} has {:.3g} nodes a point",
                                  history->how.method,
                                  per_point(history->statistics.dag_nodes, *history)));
  if (reasons.empty()) return "";
  return fmt::format("It {} (counted).", fmt::join(reasons, ", and "));
}

std::string scaling(const TriangulateComparison& comparison, const Row& best) {
  if (is_alone(best) || comparison.threads.size() < 2) return "";
  const Row* base = base_of(comparison.rows, best);
  if (base == nullptr) return "";
  if (best.how.threads == 1) {
    const Row* more = nullptr;
    for (const Row& row : comparison.rows)
      if (row.points == best.points && row.how.method == best.how.method && row.how.threads > 1 &&
          row.how.threads <= comparison.cores &&
          (more == nullptr || row.seconds.median < more->seconds.median))
        more = &row;
    if (more == nullptr) return "";
    return fmt::format(" More threads did not help: {} with {} (measured).",
                       milliseconds_text(more->seconds.median), threads_text(more->how.threads));
  }
  return fmt::format(" One thread takes {}: that is a speed-up of {:.2f} (measured).",
                     milliseconds_text(base->seconds.median),
                     base->seconds.median / best.seconds.median);
}

std::string agreement(const TriangulateComparison& comparison, const Row& best) {
  const Rows same = rows_of(comparison.rows, [&](const Row& r) { return r.points == best.points; });
  const bool agree = std::ranges::all_of(same, [&](const Row& r) { return r.hash == best.hash; });
  if (!agree)
    return "<strong>The ways to triangulate did not give the same simplices: that is a defect, "
           "please tell us.</strong>";
  const char* what = simplices_text(comparison.dim);
  if (best.simplices == 0)
    return fmt::format(
        "The points are too few or lie on a {}: there are no {}, and {} ways to triangulate find "
        "that out (counted). Their times tell nothing of points that are not so.",
        comparison.dim == 2 ? "line" : "plane", what, same.size());
  return fmt::format("All {} ways to triangulate gave the same {} {} (counted; hash {}).",
                     same.size(), best.simplices, what, best.hash);
}

// What to type, without files.
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
  const Row* own_cores = fastest(uncrowded, points, 0);
  const Row& best = own_cores != nullptr ? *own_cores : *fastest(rows, points, 0);
  std::string text = fmt::format(
      "<p>Use {} with {}: {} points in {}D take {} (measured, {}).", strong(name_of(best.how)),
      strong(threads_text(best.how.threads)), points, comparison.dim,
      strong(milliseconds_text(best.seconds.median)),
      best.seconds.runs > 1
          ? fmt::format("median of {} runs, {} to {}", best.seconds.runs,
                        milliseconds_text(best.seconds.least), milliseconds_text(best.seconds.most))
          : "once");
  text += fmt::format(" That is <code>{}</code>.", command_of(best, comparison.cores));
  text += next_sentence(own_cores != nullptr ? uncrowded : rows, best) + "</p>\n<p>" +
          reason(rows, best) + scaling(comparison, best) + "</p>\n<p>" +
          agreement(comparison, best) + crowded_text(comparison) + "</p>\n";
  Table best_of;
  best_of.columns = {{"points", true, false, {}}};
  for (const int threads : comparison.threads) {
    best_of.columns.push_back({threads_text(threads), false, true, Source::measured});
    best_of.columns.push_back({"ms", true, false, {}});
  }
  for (const std::size_t size : sizes_of(rows)) {
    std::vector<std::string> line = {std::to_string(size)};
    for (const int threads : comparison.threads) {
      const Row* row = fastest(rows, size, threads);
      line.push_back(row != nullptr ? name_of(row->how) : "-");
      line.push_back(row != nullptr ? short_number(row->seconds.median * 1e3) : "-");
    }
    best_of.rows.push_back(std::move(line));
  }
  return advice_beside(
      text, paragraph("Fastest of so many of the points, chosen at random:") + table(best_of));
}

}  // namespace delray::apps
