// Turns the rows of a comparison of distributed methods into JSON and a table.
#include "apps/compare/triangulate/distributed_figures.h"

#include <fmt/format.h>

#include <cmath>

#include "apps/compare/triangulate/triangulate_figures.h"
#include "comm/network.h"

namespace delray::apps {

double shared_per_root(const ComparedDistributedMethod& row) {
  return row.points == 0 ? 0
                         : static_cast<double>(row.sum.shared_simplices) /
                               std::sqrt(static_cast<double>(row.points));
}

Json distributed_statistics(const TriangulateRequest& request,
                            const DistributedComparison& comparison) {
  Json rows = Json::array();
  for (const ComparedDistributedMethod& row : comparison.rows) {
    Json one = {{"method", row.method},
                {"ranks", row.ranks},
                {"points", row.points},
                {"simplices", row.simplices},
                {"hash", row.hash},
                {"rounds", row.rounds},
                {"bytes_sent_max", row.bytes_sent_max}};
    one.update(counts_json(row.sum));
    one["shared_per_root"] = shared_per_root(row);
    one["predicted"] = Json::array();
    for (const PredictedTriangulation& predicted : row.predicted) {
      one["predicted"].push_back(
          {{"network", predicted.network}, {"ranks", row.ranks}, {"seconds", predicted.seconds}});
    }
    rows.push_back(std::move(one));
  }
  return {{"schema", "delray.compare.distributed/1"},
          {"input", compared_input_json(request, comparison.points, comparison.dim)},
          {"options",
           {{"distributed", request.distributed},
            {"ranks", comparison.ranks},
            {"seed", request.seed},
            {"quick", request.quick}}},
          {"left_out", comparison.left_out},
          {"unfinished", comparison.unfinished},
          {"rows", std::move(rows)}};
}

TextTable distributed_table(const DistributedComparison& comparison) {
  TextTable table = {{"method", "points", "ranks", "messages", "bytes", "rounds", "waits",
                      "rollbacks", "points sent", "shared", "shared/sqrt(N)"}};
  for (const comm::NamedNetwork& network : comparison.networks) {
    table[0].push_back(network.name + " ms, predicted");
  }
  for (const ComparedDistributedMethod& row : comparison.rows) {
    std::vector<std::string> line = {row.method,
                                     std::to_string(row.points),
                                     std::to_string(row.ranks),
                                     std::to_string(row.sum.messages),
                                     std::to_string(row.sum.bytes),
                                     std::to_string(row.rounds),
                                     std::to_string(row.sum.waits),
                                     std::to_string(row.sum.rollbacks),
                                     std::to_string(row.sum.points_sent),
                                     std::to_string(row.sum.shared_simplices),
                                     fmt::format("{:.2f}", shared_per_root(row))};
    for (const PredictedTriangulation& predicted : row.predicted) {
      line.push_back(milliseconds_text(predicted.seconds, 2));
    }
    line.resize(table[0].size(), "-");
    table.push_back(std::move(line));
  }
  return table;
}

}  // namespace delray::apps
