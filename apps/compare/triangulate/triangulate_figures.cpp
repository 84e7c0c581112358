// Turns the rows of a comparison of triangulation methods into JSON and a table.
#include "apps/compare/triangulate/triangulate_figures.h"

#include <fmt/format.h>

#include "apps/compare/scaling_limit.h"
#include "apps/triangulation_json.h"

namespace delray::apps {
namespace {

Json statistics_of(const TriangulateComparison& comparison, const ComparedTriangulation& row) {
  const delaunay::Options& how = row.how;
  const delaunay::Statistics& phases = row.statistics;
  const double times_as_fast = speed_up(comparison.rows, row);
  const auto ratio = [&](double value) { return times_as_fast > 0 ? Json(value) : Json(nullptr); };
  Json sync = synchronization_json(phases.synchronization);
  sync["fragments"] = row.fragments;
  Json seconds = {{"triangulate", row.seconds.median}};
  seconds.update(phases_json(phases));
  return {{"method", how.method},
          {"location", how.location},
          {"split", how.split},
          {"order", how.order},
          {"deadlocks", how.deadlocks},
          {"locks", how.locks},
          {"unlock", how.unlock},
          {"searching", how.searching},
          {"queue", how.queue},
          {"threads", how.threads},
          {"points", row.points},
          {"distinct", row.distinct},
          {"simplices", row.simplices},
          {"hull_facets", row.hull_facets},
          {"hash", row.hash},
          {"sync", sync},
          {"searching_threads", searching_json(phases.searching)},
          {"flips", flips_json(phases.flips, how.dim)},
          {"simplices_by_thread", row.simplices_by_thread},
          {"dag_nodes", phases.dag_nodes},
          {"dag_node_bytes", phases.dag_node_bytes},
          {"seconds", seconds},
          {"spread", {{"triangulate", spread_json(row.seconds)}}},
          {"speed_up", ratio(times_as_fast)},
          {"efficiency", ratio(times_as_fast / how.threads)},
          {"serial_fraction", serial_fraction_json(times_as_fast, how.threads)}};
}

std::string per_point(std::uint64_t count, const ComparedTriangulation& row) {
  if (row.statistics.synchronization.lock_calls == 0) return "-";
  return fmt::format("{:.4g}", static_cast<double>(count) / static_cast<double>(row.points));
}

}  // namespace

Json compared_input_json(const TriangulateRequest& request, std::size_t points, int dim) {
  return {{"file", request.input.path},
          {"points", points},
          {"dim", dim},
          {"duplicates", request.input.duplicates.empty() ? "first" : request.input.duplicates}};
}

Json triangulate_statistics(const TriangulateRequest& request,
                            const TriangulateComparison& comparison) {
  Json rows = Json::array();
  for (const ComparedTriangulation& row : comparison.rows)
    rows.push_back(statistics_of(comparison, row));
  return {{"schema", "delray.compare.triangulate/1"},
          {"input", compared_input_json(request, comparison.points, comparison.dim)},
          {"options",
           {{"methods", request.methods},
            {"threads", comparison.threads},
            {"seed", request.seed},
            {"quick", request.quick}}},
          {"hardware_threads", comparison.cores},
          {"left_out", comparison.left_out},
          {"unfinished", comparison.unfinished},
          {"rows", std::move(rows)}};
}

TextTable triangulate_table(const TriangulateComparison& comparison) {
  TextTable table = {{"points", "method", "threads", "ms", "least ms", "most ms", "speed-up",
                      "efficiency", "sequential", "fragments", "lock calls/point", "waits",
                      "deadlocks", "history nodes"}};
  for (const ComparedTriangulation& row : comparison.rows) {
    const delaunay::Statistics& statistics = row.statistics;
    const delaunay::Synchronization& sync = statistics.synchronization;
    const double times_as_fast = speed_up(comparison.rows, row);
    const bool locks = sync.lock_calls > 0;
    const std::vector<std::string> ratios = times_as_fast > 0
                                                ? speed_up_cells(times_as_fast, row.how.threads)
                                                : std::vector<std::string>(3, "-");
    table.push_back(
        {std::to_string(row.points), name_of(row.how), std::to_string(row.how.threads),
         milliseconds_text(row.seconds.median, 2), milliseconds_text(row.seconds.least, 2),
         milliseconds_text(row.seconds.most, 2), ratios[0], ratios[1], ratios[2],
         std::to_string(row.fragments), per_point(sync.lock_calls, row),
         locks ? std::to_string(sync.waits) : "-", locks ? std::to_string(sync.deadlocks) : "-",
         statistics.dag_nodes > 0 ? std::to_string(statistics.dag_nodes) : "-"});
  }
  return table;
}

}  // namespace delray::apps
