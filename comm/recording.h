// A communicator that writes down what goes through it.
#pragma once

#include <memory>
#include <vector>

#include "comm/communicator.h"
#include "comm/ledger.h"

namespace delray::comm {

// Appends this rank's messages, work and marks to `events`. Communicators that come from it by
// split write to the same events, peers as world ranks; splitting itself is not recorded. Costs one
// entry per call. REQUIRES: `inner` and `events` or `tally` outlive the recording and what is split
// from it.
class Recording final : public Communicator {
 public:
  Recording(Communicator& inner, std::vector<Event>& events);
  // Only adds up.
  Recording(Communicator& inner, Tally& tally);

  int rank() const override { return inner_.rank(); }
  int size() const override { return inner_.size(); }
  int world_rank(int rank) const override { return inner_.world_rank(rank); }
  double seconds() const override { return inner_.seconds(); }

  void send(int to, Tag tag, Buffer&& message) override;
  void multicast(std::span<const int> to, Tag tag, Buffer&& message) override;
  Buffer receive(int from_or_any, Tag tag_or_any) override;
  std::optional<Envelope> probe(int from_or_any, Tag tag_or_any, Deadline deadline) override;
  std::unique_ptr<Communicator> split(int color, int key) override;
  void mark(Phase phase, int round) override;
  void work(Work kind, std::uint64_t amount) override;
  [[noreturn]] void abort(std::string why) override;

 private:
  // Where to write, and the phase and round that were marked last, on whichever communicator.
  struct Journal {
    std::vector<Event>* events;
    Tally* tally;
    Phase phase = Phase::other;
    int round = 0;
  };
  Recording(std::unique_ptr<Communicator> inner, std::shared_ptr<Journal> journal);
  Event event(Event::Kind kind, double begin) const;
  void write(const Event& event);

  std::unique_ptr<Communicator> owned_;  // null when the caller owns the inner one
  Communicator& inner_;
  std::shared_ptr<Journal> journal_;
};

}  // namespace delray::comm
