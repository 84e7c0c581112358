// Runs a ledger on the simulated machine: every rank repeats its events with messages that have a
// size but no content, and sends that were one multicast are joined again.
#include "comm/replay.h"

#include "comm/simulated.h"

namespace delray::comm {

std::vector<double> replay(const Ledger& ledger, const Network& network) {
  if (ledger.ranks.empty()) return {};
  return run_simulated(static_cast<int>(ledger.ranks.size()), network, 1,
                       [&](Communicator& communicator) {
                         const std::vector<Event>& events =
                             ledger.ranks[static_cast<std::size_t>(communicator.rank())];
                         std::vector<int> peers;  // of the message that goes out next
                         for (std::size_t i = 0; i < events.size(); ++i) {
                           const Event& event = events[i];
                           switch (event.kind) {
                             case Event::Kind::send:
                               peers.push_back(event.peer);
                               if (i + 1 < events.size() && events[i + 1].is_repeated) break;
                               communicator.multicast(peers, event.tag,
                                                      Buffer::standing_for(event.amount, Buffer()));
                               peers.clear();
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
