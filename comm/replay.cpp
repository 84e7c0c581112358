#include "comm/replay.h"

#include "comm/simulated.h"

namespace delray::comm {

std::vector<double> replay(const Ledger& ledger, const Network& network) {
  if (ledger.ranks.empty()) return {};
  return run_simulated(
      static_cast<int>(ledger.ranks.size()), network, 1, [&](Communicator& communicator) {
        for (const Event& event : ledger.ranks[static_cast<std::size_t>(communicator.rank())]) {
          switch (event.kind) {
            case Event::Kind::send:
              communicator.send(event.peer, event.tag,
                                Buffer::standing_for(event.amount, Buffer()));
              break;
            case Event::Kind::receive:
              communicator.receive(event.peer, event.tag);
              break;
            case Event::Kind::work:
              communicator.work(event.work, event.amount);
              break;
            case Event::Kind::mark:
              break;
          }
        }
      });
}

}  // namespace delray::comm
