// A communicator that writes down what goes through it.
#pragma once

#include <memory>
#include <vector>

#include "comm/forwarding.h"
#include "comm/ledger.h"

namespace delray::comm {

// Appends this rank's messages, work and marks to `events`. Communicators that come from it by
// split write to the same events, peers as world ranks; splitting itself is not recorded. Costs one
// entry per call. REQUIRES: `inner` and `events` or `tally` outlive the recording and what is split
// from it.
class Recording final : public ForwardingCommunicator {
 public:
  Recording(Communicator& inner, std::vector<Event>& events);
  // The same with Event::processor, of ranks that are threads or processes: some 0.5 us for each
  // message.
  static Recording with_processor_time(Communicator& inner, std::vector<Event>& events);
  // Only adds up.
  Recording(Communicator& inner, Tally& tally);

  void send(int to, Tag tag, Buffer&& message) override;
  void multicast(std::span<const int> to, Tag tag, Buffer&& message) override;
  Buffer receive(int from_or_any, Tag tag_or_any) override;
  std::unique_ptr<Communicator> split(int color, int key) override;
  void mark(Phase phase, int round) override;
  void work(Work kind, std::uint64_t amount) override;

 private:
  // Where to write, and the phase and round that were marked last, on whichever communicator.
  struct Journal {
    std::vector<Event>* events;
    Tally* tally;
    bool asks_processor = false;
    Phase phase = Phase::other;
    int round = 0;
  };
  struct Begun {
    double seconds;
    std::int64_t processor;  // nanoseconds
  };
  Recording(Communicator& inner, std::shared_ptr<Journal> journal);
  Recording(std::unique_ptr<Communicator> inner, std::shared_ptr<Journal> journal);
  Begun begin() const;
  Event event(Event::Kind kind, const Begun& begun) const;
  void write(const Event& event);

  std::shared_ptr<Journal> journal_;
};

}  // namespace delray::comm
