// How ranks that hand each other work by messages find out that all of it is done.
#pragma once

#include <cstdint>

#include "comm/communicator.h"

namespace delray::comm {

// Four counters (Mattern 1987): waves over a tree of ranks sum up how many messages were sent and
// received by ranks while they were idle; when the sums of two successive waves are equal, sent and
// received alike, no message is under way and nobody works. A wave costs 2 (n - 1) messages; one
// starts whenever the last has come back, and waits at each rank until that is idle.
//
//   Termination termination(communicator, kControl);
//   for (;;) {
//     ... do work; count_sent() for every message that carries some ...
//     termination.idle();
//     if (termination.is_over()) break;
//     const auto next = communicator.probe(kAnyRank, kAnyTag, Deadline::never());
//     if (next->tag == kControl) {
//       termination.handle(*next);
//     } else {
//       ... receive it; count_received() ...
//     }
//   }
//
// Every rank gets to is_over(). Afterwards none of its messages is left in the communicator.
class Termination {
 public:
  // `control` is a tag that nothing else uses until the end.
  Termination(Communicator& communicator, Tag control);

  void count_sent(std::uint64_t messages = 1) { mine_.sent += messages; }
  void count_received(std::uint64_t messages = 1) { mine_.received += messages; }

  // Says that this rank has nothing to do until a message comes.
  void idle();
  // Receives a control message that a probe has found. The rank is still taken for working until it
  // calls idle again.
  void handle(const Envelope& envelope);
  bool is_over() const { return over_; }
  // Waves that this rank has taken part in.
  std::uint64_t waves() const { return waves_; }

 private:
  struct Counters {
    std::uint64_t sent = 0, received = 0;
  };
  struct Control {
    enum class Kind : std::uint32_t { ask, answer, end } kind;
    std::uint32_t unused = 0;
    Counters counters{};
  };
  void send_to_children(Control::Kind kind);

  Communicator& communicator_;
  Tag control_;
  int children_;  // ranks rank + 2^i below the lowest set bit of rank: a binomial tree
  Counters mine_, subtree_, last_;
  bool in_wave_ = false;
  bool has_last_ = false;
  int missing_ = 0;  // children whose answer is to come
  bool over_ = false;
  std::uint64_t waves_ = 0;
};

}  // namespace delray::comm
