// Turns the rows of a comparison of compositing schemes into JSON and a table; values that were not
// measured become null or a dash.
#include "apps/compare/compose/compose_figures.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/compare/compose/growth_claims.h"
#include "apps/compare/compose/own_networks.h"

namespace delray::apps {
namespace {

Json counts_of(const ComparedScheme& row) {
  return {{"scheme", row.scheme},
          {"codec", row.codec},
          {"ranks", row.ranks},
          {"rounds", row.counts.rounds},
          {"bytes_total", row.counts.bytes_total},
          {"bytes_sent_max", row.counts.bytes_sent_max},
          {"bytes_received_max", row.counts.bytes_received_max},
          {"messages", row.counts.messages},
          {"pixels_composited_total", row.counts.pixels_composited_total},
          {"pixels_composited_max", row.counts.pixels_composited_max}};
}

Json median_of(const std::optional<Spread>& times) {
  return times ? Json(times->median) : Json(nullptr);
}
Json optional_spread_json(const std::optional<Spread>& times) {
  return times ? spread_json(*times) : Json(nullptr);
}

std::string millions(std::uint64_t amount) {
  return fmt::format("{:.3f}", static_cast<double>(amount) / 1e6);
}

std::string median_milliseconds(const std::optional<Spread>& times) {
  return times ? milliseconds_text(times->median, 2) : "-";
}

}  // namespace

Json compose_statistics(const CompareRequest& request, const Prepared& prepared,
                        const ComposeComparison& comparison) {
  Json table = Json::array();
  for (const ComparedScheme& row : comparison.rows) {
    Json one = counts_of(row);
    one["gather"] = {{"bytes_total", row.gather.bytes_total}, {"messages", row.gather.messages}};
    one["seconds"] = {{"compose", median_of(row.compose_seconds)},
                      {"gather", median_of(row.gather_seconds)},
                      {"total", median_of(row.total_seconds)}};
    one["spread"] = {{"compose", optional_spread_json(row.compose_seconds)},
                     {"gather", optional_spread_json(row.gather_seconds)},
                     {"total", optional_spread_json(row.total_seconds)}};
    one["predicted"] = Json::array();
    for (const Predicted& predicted : row.predicted) {
      one["predicted"].push_back({{"network", predicted.network},
                                  {"ranks", row.ranks},
                                  {"seconds", predicted.seconds},
                                  {"gather_seconds", predicted.gather_seconds}});
    }
    one["image_hash"] = row.hash.empty() ? Json(nullptr) : Json(row.hash);
    table.push_back(std::move(one));
  }
  Json left_out = Json::array();
  for (const LeftOut& one : comparison.left_out)
    left_out.push_back({{"scheme", one.scheme}, {"codec", one.codec}, {"ranks", one.ranks}});
  return {{"schema", "delray.compare.compose/1"},
          {"scene", scene_json(request, prepared)},
          {"options",
           {{"size", request.render.size},
            {"ranks", request.ranks},
            {"codecs", request.codecs},
            {"interlace", request.interlace},
            {"threads", request.render.launch.threads},
            {"quick", request.quick}}},
          {"unfinished", comparison.unfinished},
          {"networks", networks_json(request.networks)},
          {"left_out", std::move(left_out)},
          {"own_networks", own_networks_json(on_own_networks(comparison.rows, request.networks))},
          {"growth", growth_claims_json(judge_growth(comparison.rows))},
          {"rows", std::move(table)}};
}

TextTable compose_table(const std::vector<ComparedScheme>& rows) {
  std::vector<std::string> networks;
  for (const ComparedScheme& row : rows) {
    for (const Predicted& predicted : row.predicted) {
      if (std::find(networks.begin(), networks.end(), predicted.network) == networks.end()) {
        networks.push_back(predicted.network);
      }
    }
  }
  std::vector<std::string> head = {"ranks",    "scheme",     "codec",      "rounds",
                                   "messages", "MB",         "MB sent",    "MB received",
                                   "Mpixel",   "Mpixel max", "compose ms", "compose from..to ms",
                                   "gather ms"};
  for (const std::string& network : networks) head.push_back(network + " ms, predicted");
  std::vector<std::vector<std::string>> table = {std::move(head)};
  for (const ComparedScheme& row : rows) {
    const composite::Counts& counts = row.counts;
    std::vector<std::string> line = {std::to_string(row.ranks),
                                     row.scheme,
                                     row.codec,
                                     std::to_string(counts.rounds),
                                     std::to_string(counts.messages),
                                     millions(counts.bytes_total),
                                     millions(counts.bytes_sent_max),
                                     millions(counts.bytes_received_max),
                                     millions(counts.pixels_composited_total),
                                     millions(counts.pixels_composited_max),
                                     median_milliseconds(row.compose_seconds),
                                     row.compose_seconds ? range_text(*row.compose_seconds) : "-",
                                     median_milliseconds(row.gather_seconds)};
    for (const std::string& network : networks) {
      const auto at = std::find_if(row.predicted.begin(), row.predicted.end(),
                                   [&](const Predicted& one) { return one.network == network; });
      line.push_back(at == row.predicted.end() ? "-" : milliseconds_text(at->seconds, 2));
    }
    table.push_back(std::move(line));
  }
  return table;
}

}  // namespace delray::apps
