// What wrappers of a communicator have in common: each call goes to the one inside.
#pragma once

#include <memory>

#include "comm/communicator.h"

namespace delray::comm {

// Forwards everything; a wrapper overrides what it does differently.
//
// REQUIRES: an inner communicator that was passed by reference outlives it.
class ForwardingCommunicator : public Communicator {
 public:
  int rank() const override;
  int size() const override;
  int world_rank(int rank) const override;
  double seconds() const override;

  void send(int to, Tag tag, Buffer&& message) override;
  void multicast(std::span<const int> to, Tag tag, Buffer&& message) override;
  void finish_sends() override;
  Buffer receive(int from_or_any, Tag tag_or_any) override;
  std::optional<Envelope> probe(int from_or_any, Tag tag_or_any, Deadline deadline) override;
  std::unique_ptr<Communicator> split(int color, int key) override;
  void mark(Phase phase, int round) override;
  void work(Work kind, std::uint64_t amount) override;
  Replica replicate(const std::function<Replica()>& compute) override;
  [[noreturn]] void abort(std::string why) override;

 protected:
  explicit ForwardingCommunicator(Communicator& inner) : inner_(inner) {}
  explicit ForwardingCommunicator(std::unique_ptr<Communicator> inner)
      : owned_(std::move(inner)), inner_(*owned_) {}

  Communicator& inner() const { return inner_; }

 private:
  std::unique_ptr<Communicator> owned_;  // null when somebody else owns the inner one
  Communicator& inner_;
};

}  // namespace delray::comm
