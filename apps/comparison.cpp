#include "apps/comparison.h"

#include <fmt/format.h>

#include <algorithm>

#include "comm/network.h"
#include "files/atomic_file.h"

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

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::string millions(std::uint64_t amount) {
  return fmt::format("{:.3f}", static_cast<double>(amount) / 1e6);
}

std::string milliseconds(const std::optional<double>& seconds) {
  return seconds ? fmt::format("{:.2f}", *seconds * 1e3) : "-";
}

// A heading and a line for each row, with a column for each network that any row has.
std::vector<std::vector<std::string>> table_of(const std::vector<ComparedScheme>& rows) {
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
                                   "Mpixel",   "Mpixel max", "compose ms", "gather ms"};
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
                                     milliseconds(row.compose_seconds),
                                     milliseconds(row.gather_seconds)};
    for (const std::string& network : networks) {
      const auto at = std::find_if(row.predicted.begin(), row.predicted.end(),
                                   [&](const Predicted& one) { return one.network == network; });
      line.push_back(at == row.predicted.end() ? "-" : milliseconds(at->seconds));
    }
    table.push_back(std::move(line));
  }
  return table;
}

constexpr const char* kExplanation =
    "Counted: rounds, messages, bytes and pixels composited of all ranks together, and the most "
    "that any rank sends, receives and composites. Measured: until the last rank is done; the "
    "gather to rank 0 comes on top. Predicted: compositing on ranks with a core each over the "
    "network named; on this machine by a model that was fitted to the other numbers of ranks.";

}  // namespace

Json comparison_statistics(const CompareRequest& request, const Prepared& prepared,
                           const std::vector<ComparedScheme>& rows) {
  Json table = Json::array();
  for (const ComparedScheme& row : rows) {
    Json one = counts_of(row);
    one["gather"] = {{"bytes_total", row.gather.bytes_total}, {"messages", row.gather.messages}};
    one["seconds"] = {{"compose", or_null(row.compose_seconds)},
                      {"gather", or_null(row.gather_seconds)}};
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
  Json networks = Json::array();
  for (const comm::NamedNetwork& named : comm::networks()) {
    networks.push_back({{"name", named.name},
                        {"latency", named.network.latency},
                        {"overhead", named.network.overhead},
                        {"seconds_per_byte", named.network.seconds_per_byte},
                        {"copy_seconds_per_byte", named.network.copy_seconds_per_byte},
                        {"bus", named.network.is_bus}});
  }
  return {{"schema", "delray.compare.compose/1"},
          {"scene",
           {{"file", request.render.scene.file.path},
            {"triangles", scenes::triangle_count(prepared.scene)}}},
          {"options",
           {{"size", request.render.size},
            {"ranks", request.ranks},
            {"codecs", request.codecs},
            {"threads", request.render.launch.threads},
            {"quick", request.quick}}},
          {"networks", std::move(networks)},
          {"rows", std::move(table)}};
}

void print_comparison(const std::vector<ComparedScheme>& rows) {
  const auto table = table_of(rows);
  std::vector<std::size_t> widths(table[0].size());
  for (const auto& line : table) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  for (const auto& line : table) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      const bool is_name = i == 1 || i == 2;
      fmt::print("{}{}", i > 0 ? "  " : "",
                 is_name ? fmt::format("{:<{}}", line[i], widths[i])
                         : fmt::format("{:>{}}", line[i], widths[i]));
    }
    fmt::print("\n");
  }
}

void write_comparison(const std::string& path, const CompareRequest& request,
                      const std::vector<ComparedScheme>& rows) {
  const auto escaped = [](const std::string& text) {
    std::string result;
    for (const char c : text) {
      result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    }
    return result;
  };
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>{0}</title>\n"
      "<style>body{{font-family:sans-serif}}table{{border-collapse:collapse}}"
      "td,th{{padding:2px 8px;text-align:right;border-bottom:1px solid #ccc}}</style>\n"
      "<h1>Compositing {0}, {1}</h1>\n<p>{2}</p>\n<table>\n",
      escaped(request.render.scene.file.path), escaped(request.render.size), kExplanation);
  const char* cell = "th";
  for (const auto& line : table_of(rows)) {
    page += "<tr>";
    for (const std::string& text : line) page += fmt::format("<{0}>{1}</{0}>", cell, escaped(text));
    page += "</tr>\n";
    cell = "td";
  }
  files::write_file(path, page + "</table>\n</html>\n");
}

}  // namespace delray::apps
