// A communicator that serves rays of other ranks while its caller waits for something else.
#pragma once

#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "comm/communicator.h"
#include "raytrace/distributed/distributed_tracer.h"

namespace delray::raytrace {

// For schedules that hand out tiles meanwhile: a rank that waits for tiles answers the others, who
// might hand them out. Messages of the traffic are not its caller's.
class ServingCommunicator final : public comm::Communicator {
 public:
  ServingCommunicator(comm::Communicator& inner, DistributedTracer& tracer)
      : inner_(inner), tracer_(tracer) {}

  int rank() const override { return inner_.rank(); }
  int size() const override { return inner_.size(); }
  int world_rank(int rank) const override { return inner_.world_rank(rank); }
  double seconds() const override { return inner_.seconds(); }
  void send(int to, comm::Tag tag, comm::Buffer&& message) override {
    inner_.send(to, tag, std::move(message));
  }
  comm::Buffer receive(int from, comm::Tag tag) override {
    const auto envelope = probe(from, tag, comm::Deadline::never());
    return inner_.receive(envelope->source, envelope->tag);
  }
  // REQUIRES: tag is none that stands for all.
  std::optional<comm::Envelope> probe(int from, comm::Tag tag, comm::Deadline deadline) override {
    const double begin = inner_.seconds();
    const double seconds = static_cast<double>(deadline.wait.count()) * 1e-9;
    for (;;) {
      if (const auto found = inner_.probe(from, tag, comm::Deadline::now())) return found;
      if (inner_.seconds() - begin >= seconds) return std::nullopt;
      if (!tracer_.serve()) tracer_.wait_a_moment();
    }
  }
  std::unique_ptr<comm::Communicator> split(int color, int key) override {
    return inner_.split(color, key);
  }
  void mark(comm::Phase phase, int round) override { inner_.mark(phase, round); }
  void work(comm::Work kind, std::uint64_t amount) override { inner_.work(kind, amount); }
  [[noreturn]] void abort(std::string why) override {
    inner_.abort(std::move(why));
    std::abort();
  }

 private:
  comm::Communicator& inner_;
  DistributedTracer& tracer_;
};

}  // namespace delray::raytrace
