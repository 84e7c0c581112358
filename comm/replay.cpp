// Runs a ledger on the simulated machine: every rank repeats its events with messages that have a
// size but no content, and sends that were one multicast are joined again. The virtual clock is
// read around each event, whose phase the ledger knows.
#include "comm/replay.h"

#include <algorithm>

#include "comm/simulated.h"

namespace delray::comm {
namespace {

// Does one event; `peers` are those of the message that goes out next. Returns the processor
// seconds that it takes if nobody has to wait.
double repeat(Communicator& communicator, const Network& network, const Event& event, bool goes_on,
              std::vector<int>& peers) {
  const auto handling = [&](std::uint64_t bytes) {
    return network.overhead + network.copy_seconds_per_byte * static_cast<double>(bytes);
  };
  const bool is_own = event.peer == communicator.rank();
  switch (event.kind) {
    case Event::Kind::send: {
      peers.push_back(event.peer);
      if (goes_on) return 0;
      const bool has_other = std::any_of(peers.begin(), peers.end(),
                                         [&](int peer) { return peer != communicator.rank(); });
      const double messages = !has_other         ? 0
                              : network.is_bus() ? 1
                                                 : static_cast<double>(peers.size());
      communicator.multicast(peers, event.tag, Buffer::standing_for(event.amount, Buffer()));
      peers.clear();
      return messages * handling(event.amount);
    }
    case Event::Kind::receive:
      communicator.receive(event.peer, event.tag);
      return is_own ? 0 : handling(event.amount);
    case Event::Kind::work:
      communicator.work(event.work, event.amount);
      if (event.work == Work::blocked_e9) return 0;
      return network.seconds_per_work[static_cast<std::size_t>(event.work)] *
             static_cast<double>(event.amount);
    case Event::Kind::mark:
      return 0;
  }
  return 0;
}

}  // namespace

std::vector<ReplayedRank> replay_phases(const Ledger& ledger, const Network& network) {
  std::vector<ReplayedRank> result(ledger.ranks.size());
  if (result.empty()) return result;
  run_simulated(static_cast<int>(result.size()), network, 1, [&](Communicator& communicator) {
    const auto rank = static_cast<std::size_t>(communicator.rank());
    const std::vector<Event>& events = ledger.ranks[rank];
    ReplayedRank& replayed = result[rank];
    std::vector<int> peers;
    for (std::size_t i = 0; i < events.size(); ++i) {
      const double begin = communicator.seconds();
      const bool goes_on = i + 1 < events.size() && events[i + 1].is_repeated;
      const double busy = repeat(communicator, network, events[i], goes_on, peers);
      const double taken = communicator.seconds() - begin;
      PhaseSeconds& phase = replayed.phases[static_cast<std::size_t>(events[i].phase)];
      const double mine = std::min(busy, taken);
      (events[i].kind == Event::Kind::work ? phase.work : phase.handling) += mine;
      phase.waiting += taken - mine;
    }
    replayed.end = communicator.seconds();
  });
  return result;
}

std::vector<double> replay(const Ledger& ledger, const Network& network) {
  std::vector<double> ends;
  for (const ReplayedRank& rank : replay_phases(ledger, network)) ends.push_back(rank.end);
  return ends;
}

}  // namespace delray::comm
