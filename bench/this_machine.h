// This machine as the simulated one sees it, measured: for benchmarks of predictions.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

#include "bench/measure.h"
#include "comm/collectives.h"
#include "comm/network.h"
#include "comm/threads.h"

namespace delray::bench {

inline int cores() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

// What a message takes from rank to rank of so many, of which all but two wait at any time.
inline double message_seconds(int ranks) {
  constexpr int kRounds = 500;
  double seconds = 0;
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    const int before = (communicator.rank() + ranks - 1) % ranks;
    const int after = (communicator.rank() + 1) % ranks;
    comm::barrier(communicator);
    const double begin = communicator.seconds();
    if (communicator.rank() == 0) communicator.send(after, 1, comm::Buffer(8));
    for (int i = 0; i < kRounds; ++i) {
      comm::Buffer message = communicator.receive(before, 1);
      if (communicator.rank() > 0 || i + 1 < kRounds)
        communicator.send(after, 1, std::move(message));
    }
    if (communicator.rank() == 0)
      seconds = (communicator.seconds() - begin) / (double{kRounds} * ranks);
  });
  return seconds;
}

// How much longer work takes a rank while others are at work of their own, the time of their turns
// on its core left out. Every rank calls make_work() once and then what it gave, time and again.
template <class MakeWork>
double contention(int ranks, MakeWork&& make_work) {
  constexpr int kTimes = 6;
  double alone = 0, together = 0;
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    auto work = make_work(communicator);
    const auto seconds = [&] {
      std::vector<double> times;
      for (int i = 0; i < kTimes; ++i) {
        times.push_back(seconds_of([&] {
          work();
          return 0;
        }));
      }
      return median(times);
    };
    seconds();
    comm::barrier(communicator);
    const double mine = seconds();
    comm::barrier(communicator);
    if (communicator.rank() == 0) {
      together = mine;
      alone = seconds();
    }
    comm::barrier(communicator);
  });
  return std::max(1.0, together / alone / std::max(1.0, static_cast<double>(ranks) / cores()));
}

// Messages hand over their memory: bytes take nothing. Work takes `slower` times as long as alone.
inline comm::Network this_machine(int ranks, double slower) {
  comm::Network machine;
  machine.seconds_per_byte = 0;
  machine.seconds_per_work[0] *= slower;
  if (ranks == 1) return machine;
  // Two of three parts are the processors'; a rank that has to be woken is not at work meanwhile.
  machine.overhead = message_seconds(2) / 3;
  machine.latency = std::max(0.0, message_seconds(ranks) - 2 * machine.overhead);
  if (ranks > cores()) machine.shared_cores = cores();
  return machine;
}

}  // namespace delray::bench
