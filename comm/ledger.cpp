// Adds up events by phase and round. A rank counts a round for each change of phase or round that
// is followed by a message; over all ranks the distinct pairs of phase and round that had messages
// are counted.
#include "comm/ledger.h"

#include <set>
#include <utility>

#include "comm/collectives.h"

namespace delray::comm {
namespace {

// Whether `event` is a message that crosses the network, added to `sum`; its round is the caller's.
bool add_message(const Event& event, int self, Totals& sum) {
  if (event.kind == Event::Kind::mark) return false;
  if (event.kind == Event::Kind::work) {
    sum.work[static_cast<std::size_t>(event.work)] += event.amount;
    return false;
  }
  if (event.peer == self) return false;
  const bool sent = event.kind == Event::Kind::send;
  (sent ? sum.bytes_sent : sum.bytes_received) += event.amount;
  (sent ? sum.messages_sent : sum.messages_received) += 1;
  return true;
}

}  // namespace

void Tally::add(const Event& event) {
  const auto phase = static_cast<std::size_t>(event.phase);
  Totals& sum = phases_[phase];
  if (!add_message(event, self_, sum)) return;
  if (sum.rounds > 0 && event.round == last_round_[phase]) return;
  ++sum.rounds;
  last_round_[phase] = event.round;
  const auto round = static_cast<std::size_t>(event.round);
  if (rounds_[phase].size() <= round) rounds_[phase].resize(round + 1);
  rounds_[phase][round] = true;
}

Totals totals(std::span<const Event> events, int self, std::optional<Phase> phase) {
  Totals sum;
  std::pair last_round(Phase::other, 0);
  for (const Event& event : events) {
    if (phase && event.phase != *phase) continue;
    if (!add_message(event, self, sum)) continue;
    const std::pair round(event.phase, event.round);
    if (sum.rounds == 0 || round != last_round) ++sum.rounds;
    last_round = round;
  }
  return sum;
}

Totals totals(const Ledger& ledger, std::optional<Phase> phase) {
  Totals sum;
  std::set<std::pair<Phase, int>> rounds;
  for (std::size_t rank = 0; rank < ledger.ranks.size(); ++rank) {
    const Totals one = totals(ledger.ranks[rank], static_cast<int>(rank), phase);
    sum.bytes_sent += one.bytes_sent;
    sum.bytes_received += one.bytes_received;
    sum.messages_sent += one.messages_sent;
    sum.messages_received += one.messages_received;
    for (std::size_t i = 0; i < sum.work.size(); ++i) sum.work[i] += one.work[i];
    for (const Event& event : ledger.ranks[rank]) {
      if (phase && event.phase != *phase) continue;
      if (event.kind != Event::Kind::send && event.kind != Event::Kind::receive) continue;
      if (event.peer != static_cast<int>(rank)) rounds.emplace(event.phase, event.round);
    }
  }
  sum.rounds = rounds.size();
  return sum;
}

Ledger gather_ledger(Communicator& communicator, std::span<const Event> events) {
  Ledger ledger;
  for (const Buffer& buffer : gather(communicator, 0, Buffer::of(events))) {
    const std::span<const Event> rank = buffer.as<Event>();
    ledger.ranks.emplace_back(rank.begin(), rank.end());
  }
  return ledger;
}

}  // namespace delray::comm
