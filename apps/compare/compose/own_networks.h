// Whether schemes are fastest on the networks that Kohout (2004, 3.1.2.3) says suit them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "apps/compare/compose/compare_compose.h"
#include "apps/report/html.h"
#include "comm/topology.h"

namespace delray::apps {

// What the report says of a scheme: the shape of network on which it performs best.
struct SuitedScheme {
  const char* scheme;  // as the table calls it
  comm::Shape shape;
  const char* claim;
};
std::span<const SuitedScheme> suited_schemes();

// How a scheme did on its own network, for one codec and number of ranks; predicted, without the
// gather.
struct OnOwnNetwork {
  const SuitedScheme* suited;
  std::string network, codec;
  int ranks = 0;
  double seconds = 0;
  // Of the networks that have the same figures of links but another topology (the crossbar, which
  // has a link for each pair, apart) the one where it is fastest.
  std::string best_network;
  double best_seconds = 0;
  std::string fastest_scheme;  // on its own network
  double fastest_seconds = 0;

  // Whether it is within kAsFast of the best.
  bool own_is_best() const;
  bool is_fastest_there() const;
};
inline constexpr double kAsFast = 1.05;

// Those of which both a network of their shape and another of the same links were predicted.
std::vector<OnOwnNetwork> on_own_networks(const std::vector<ComparedScheme>& rows,
                                          std::span<const comm::NamedNetwork> networks);

// Their table; empty where there are none.
report::Html own_networks_tab(const std::vector<OnOwnNetwork>& found);
Json own_networks_json(const std::vector<OnOwnNetwork>& found);

}  // namespace delray::apps
