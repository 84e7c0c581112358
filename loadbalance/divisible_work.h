// Work whose tasks, once they are begun, consist of units that any rank may do: rays of a tile that
// are still to be traced.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "comm/collectives.h"

namespace delray::loadbalance {

// The units that wait on one rank, of its own tasks and of those of other ranks. Doing some may
// make more. Used by the rank's own thread.
class DivisibleWork {
 public:
  virtual ~DivisibleWork() = default;
  DivisibleWork() = default;
  DivisibleWork(const DivisibleWork&) = delete;
  DivisibleWork& operator=(const DivisibleWork&) = delete;

  // Units that a task begins with.
  virtual std::uint64_t units_of(std::uint32_t task) const = 0;
  virtual std::uint64_t waiting() const = 0;
  // Whether this rank should begin another task, for all of its threads to have something to do.
  virtual bool wants_task() const = 0;

  // Does some of what waits, in all threads of the rank's arena, for a short time. False where
  // there is nothing to do.
  virtual bool advance() = 0;

  // Units of one rank that go to another.
  struct Released {
    std::uint64_t units = 0;
    comm::Buffer message;  // for put there; empty where there are none
  };
  // At most `amount` of those that wait.
  virtual Released release(std::uint64_t amount) = 0;
  // Adds what another rank has released. Returns the number of units. Throws comm::BadMessage.
  virtual std::uint64_t put(std::span<const std::byte> message) = 0;

  // What has been found here, since the last call, of units of other ranks' tasks: for put_results
  // on those ranks.
  virtual std::vector<comm::Parcel> take_results() = 0;
  virtual void put_results(std::span<const std::byte> message) = 0;
};

}  // namespace delray::loadbalance
