// Compares predictions over networks of the same links: where a scheme is fastest, and which scheme
// is fastest where. Degenerate: fat trees and crossbars take part neither as own networks nor as
// others, since the report knows neither.
#include "apps/compare/compose/own_networks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "apps/report/page.h"
#include "apps/report/table.h"

namespace delray::apps {
namespace {

using comm::NamedNetwork;
using comm::Shape;

constexpr std::array kSuited = {
    SuitedScheme{"pipeline", Shape::ring, "processing elements joined in a pipeline"},
    SuitedScheme{"tree", Shape::tree, "the best performance on a binary tree"},
    SuitedScheme{"binary-swap", Shape::hypercube,
                 "the hypercube approach: between neighbours only, therefore the best performance"},
    SuitedScheme{"mesh", Shape::grid, "suits well a two-dimensional grid"},
    SuitedScheme{"bus", Shape::bus, "needs broadcasting, as on a shared bus"},
};

bool is_compared(const NamedNetwork& named) {
  const Shape shape = named.network.topology.shape;
  return shape != Shape::crossbar && shape != Shape::fat_tree;
}

bool has_same_links(const comm::Network& a, const comm::Network& b) {
  return a.latency == b.latency && a.overhead == b.overhead &&
         a.seconds_per_byte == b.seconds_per_byte &&
         a.copy_seconds_per_byte == b.copy_seconds_per_byte;
}

// Negative if nothing is predicted of it over the network.
double predicted_seconds(const ComparedScheme& row, const std::string& network) {
  const auto at = std::ranges::find(row.predicted, network, &Predicted::network);
  return at == row.predicted.end() ? -1 : at->seconds;
}

std::optional<OnOwnNetwork> found_of(const std::vector<ComparedScheme>& rows,
                                     const ComparedScheme& row, const SuitedScheme& suited,
                                     const NamedNetwork& own,
                                     std::span<const NamedNetwork> networks) {
  const double here = predicted_seconds(row, own.name);
  if (here < 0) return std::nullopt;
  OnOwnNetwork result{&suited,  own.name, row.codec,  row.ranks, here,
                      own.name, here,     row.scheme, here};
  bool has_other = false;
  for (const NamedNetwork& other : networks) {
    const double there = predicted_seconds(row, other.name);
    if (other.name == own.name || there < 0 || !is_compared(other)) continue;
    if (!has_same_links(own.network, other.network)) continue;
    has_other = true;
    if (there >= result.best_seconds) continue;
    result.best_seconds = there;
    result.best_network = other.name;
  }
  if (!has_other) return std::nullopt;
  for (const ComparedScheme& other : rows) {
    const double seconds = predicted_seconds(other, own.name);
    if (other.ranks != row.ranks || other.codec != row.codec || seconds < 0) continue;
    if (seconds >= result.fastest_seconds) continue;
    result.fastest_seconds = seconds;
    result.fastest_scheme = other.scheme;
  }
  return result;
}

}  // namespace

std::span<const SuitedScheme> suited_schemes() { return kSuited; }

bool OnOwnNetwork::own_is_best() const { return seconds <= kAsFast * best_seconds; }
bool OnOwnNetwork::is_fastest_there() const { return seconds <= kAsFast * fastest_seconds; }

std::vector<OnOwnNetwork> on_own_networks(const std::vector<ComparedScheme>& rows,
                                          std::span<const NamedNetwork> networks) {
  std::vector<OnOwnNetwork> result;
  for (const ComparedScheme& row : rows) {
    for (const SuitedScheme& suited : kSuited) {
      if (row.scheme != suited.scheme || row.ranks < 2) continue;
      for (const NamedNetwork& own : networks) {
        if (own.network.topology.shape != suited.shape) continue;
        if (auto found = found_of(rows, row, suited, own, networks))
          result.push_back(std::move(*found));
      }
    }
  }
  return result;
}

report::Html own_networks_tab(const std::vector<OnOwnNetwork>& found) {
  using namespace report;
  if (found.empty()) return "";
  Table text;
  text.columns = {{"ranks", true, false, {}},
                  {"scheme", false, false, {}},
                  {"codec", false, false, {}},
                  {"own network", false, false, {}},
                  {"ms", true, true, Source::predicted},
                  {"best network for it", false, true, Source::predicted},
                  {"ms", true, true, Source::predicted},
                  {"the report is", false, true, Source::predicted},
                  {"fastest scheme there", false, true, Source::predicted},
                  {"ms", true, true, Source::predicted}};
  const auto ms = [](double seconds) { return short_number(seconds * 1e3); };
  for (const OnOwnNetwork& one : found) {
    text.rows.push_back({std::to_string(one.ranks), one.suited->scheme, one.codec, one.network,
                         ms(one.seconds), one.best_network, ms(one.best_seconds),
                         one.own_is_best() ? "right" : "wrong", one.fastest_scheme,
                         ms(one.fastest_seconds)});
  }
  std::string claims;
  for (const SuitedScheme& suited : kSuited) {
    claims += fmt::format("{}{}: {}", claims.empty() ? "" : "; ", suited.scheme, suited.claim);
  }
  return heading("Schemes on the networks that suit them") + table(text) +
         paragraph(fmt::format(
             "Kohout (2004, 3.1.2.3) says of {}. He is right where no other network with the same "
             "links, fat trees and crossbars apart, is faster for the scheme by more than {:.0f} "
             "%. "
             "Without the gather.",
             claims, (kAsFast - 1) * 100));
}

Json own_networks_json(const std::vector<OnOwnNetwork>& found) {
  Json result = Json::array();
  for (const OnOwnNetwork& one : found) {
    result.push_back({{"scheme", one.suited->scheme},
                      {"codec", one.codec},
                      {"ranks", one.ranks},
                      {"network", one.network},
                      {"seconds", one.seconds},
                      {"best_network", one.best_network},
                      {"best_seconds", one.best_seconds},
                      {"own_is_best", one.own_is_best()},
                      {"fastest_scheme", one.fastest_scheme},
                      {"fastest_seconds", one.fastest_seconds}});
  }
  return result;
}

}  // namespace delray::apps
