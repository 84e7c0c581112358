// Cut-through (Kermani and Kleinrock 1979): the first byte goes on while the others follow, and a
// link is taken for the time of the whole message from when its first byte enters. A message that
// waits for a link holds none but those that its bytes still cross, as if places had room for it.
#include "comm/in_process/flights.h"

#include <algorithm>
#include <utility>

namespace delray::comm::internal {

Flights::Flights(const Network& network, int ranks)
    : routes_(network.topology, ranks),
      seconds_per_byte_(network.seconds_per_byte),
      hop_seconds_(network.hop_seconds),
      latency_(network.latency),
      link_free_(routes_.links()) {}

void Flights::start(Flight&& flight) {
  if (unused_.empty()) {
    unused_.push_back(flights_.size());
    flights_.emplace_back();
  }
  const std::size_t index = unused_.back();
  unused_.pop_back();
  OnTheWay& one = flights_[index];
  one.flight = std::move(flight);
  one.passed = 0;
  const std::vector<int>& world = one.flight.group->world_ranks;
  routes_.find(world[static_cast<std::size_t>(one.flight.from)],
               world[static_cast<std::size_t>(one.flight.to)], one.route);
  order_.push({one.flight.time, started_++, index});
}

std::optional<Flight> Flights::move_on() {
  Place place = order_.top();
  order_.pop();
  OnTheWay& one = flights_[place.index];
  double& free = link_free_[one.route[one.passed++]];
  const double begin = std::max(free, place.time);
  free = begin + seconds_per_byte_ * static_cast<double>(one.flight.message.counted_bytes());
  if (one.passed < one.route.size()) {
    place.time = begin + hop_seconds_;
    order_.push(place);
    return std::nullopt;
  }
  one.flight.time = free + latency_;
  unused_.push_back(place.index);
  return std::move(one.flight);
}

}  // namespace delray::comm::internal
