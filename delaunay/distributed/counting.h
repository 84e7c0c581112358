// A communicator that counts what a rank sends and how long it waits.
#pragma once

#include <cstdint>
#include <memory>

#include "comm/forwarding.h"

namespace delray::delaunay {

// Messages of a rank to itself cross no network and are left out.
struct MessageCounts {
  std::uint64_t messages = 0, bytes = 0;
  double waiting_seconds = 0;
};

// Communicators that come from it by split add to the same counts, which outlive all of them.
class Counting final : public comm::ForwardingCommunicator {
 public:
  Counting(comm::Communicator& inner, MessageCounts& counts);

  void send(int to, comm::Tag tag, comm::Buffer&& message) override;
  void multicast(std::span<const int> to, comm::Tag tag, comm::Buffer&& message) override;
  comm::Buffer receive(int from_or_any, comm::Tag tag_or_any) override;
  std::optional<comm::Envelope> probe(int from_or_any, comm::Tag tag_or_any,
                                      comm::Deadline deadline) override;
  std::unique_ptr<comm::Communicator> split(int color, int key) override;

 private:
  Counting(std::unique_ptr<comm::Communicator> inner, MessageCounts& counts);
  void count(int to, std::size_t bytes);

  MessageCounts& counts_;
};

}  // namespace delray::delaunay
