// A communicator that serves rays of other ranks while its caller waits for something else.
#pragma once

#include <optional>

#include "comm/forwarding.h"
#include "raytrace/distributed/distributed_tracer.h"

namespace delray::raytrace {

// For schedules that hand out tiles meanwhile: a rank that waits for tiles answers the others, who
// might hand them out. Messages of the traffic are not its caller's.
class ServingCommunicator final : public comm::ForwardingCommunicator {
 public:
  ServingCommunicator(comm::Communicator& inner, DistributedTracer& tracer)
      : comm::ForwardingCommunicator(inner), tracer_(tracer) {}

  comm::Buffer receive(int from, comm::Tag tag) override {
    const auto envelope = probe(from, tag, comm::Deadline::never());
    return inner().receive(envelope->source, envelope->tag);
  }
  // REQUIRES: tag is none that stands for all.
  std::optional<comm::Envelope> probe(int from, comm::Tag tag, comm::Deadline deadline) override {
    const double begin = inner().seconds();
    const double seconds = static_cast<double>(deadline.wait.count()) * 1e-9;
    for (;;) {
      if (const auto found = inner().probe(from, tag, comm::Deadline::now())) return found;
      if (inner().seconds() - begin >= seconds) return std::nullopt;
      if (!tracer_.serve()) tracer_.wait_a_moment();
    }
  }

 private:
  DistributedTracer& tracer_;
};

}  // namespace delray::raytrace
