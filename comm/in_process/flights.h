// Messages on their way through the links of a simulated network.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <queue>
#include <vector>

#include "comm/in_process/group.h"
#include "comm/network.h"

namespace delray::comm::internal {

// A message between two ranks of a group.
struct Flight {
  std::shared_ptr<Group> group;
  int from = 0, to = 0;  // ranks in the group
  Tag tag = 0;
  double time = 0;  // when its first byte comes to the next link; landed: when its last one arrives
  Buffer message;
};

// Moves messages over the links of their routes, each link carrying one at a time, in the order in
// which their first bytes come to it, those of one moment in the order in which they started.
// O(log messages on their way) for each link; nothing is kept of a message that has landed.
class Flights {
 public:
  // Throws as Routes.
  Flights(const Network& network, int ranks);

  // REQUIRES: not to itself; `time` is not before next() was when it was last moved on.
  void start(Flight&& flight);
  // When a message comes to a link next; infinite if none is on its way.
  double next() const {
    return order_.empty() ? std::numeric_limits<double>::infinity() : order_.top().time;
  }
  // Moves that message over the link; returns it where that was its last. REQUIRES: there is one.
  std::optional<Flight> move_on();

 private:
  struct OnTheWay {
    Flight flight;
    std::vector<std::uint32_t> route;
    std::size_t passed = 0;  // links of the route
  };
  struct Place {
    double time;
    std::uint64_t sequence;
    std::size_t index;  // in flights_
    bool operator<(const Place& other) const {
      return time != other.time ? time > other.time : sequence > other.sequence;
    }
  };

  Routes routes_;
  double seconds_per_byte_, hop_seconds_, latency_;
  std::vector<double> link_free_;  // when the link has carried all so far
  std::vector<OnTheWay> flights_;
  std::vector<std::size_t> unused_;  // of flights_
  std::priority_queue<Place> order_;
  std::uint64_t started_ = 0;
};

}  // namespace delray::comm::internal
