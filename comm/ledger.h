// The events of a run's ranks, in program order: the raw material of counts, timelines and
// predictions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "comm/communicator.h"

namespace delray::comm {

// A message, an amount of work, or a mark of one rank.
struct Event {
  enum class Kind : std::uint8_t { send, receive, work, mark };
  Kind kind = Kind::mark;
  Phase phase = Phase::other;
  Work work = Work::seconds_e9;  // of kind work
  bool is_repeated = false;      // a send of the message of the send before, to one more rank
  std::int32_t round = 0;
  std::int32_t peer = -1;     // world rank of the other side of a message
  Tag tag = -1;               // of a message; collectives' are >= kReservedTags
  std::uint64_t amount = 0;   // bytes of a message, amount of work
  double begin = 0, end = 0;  // Communicator::seconds; equal where the call took no time
  // Seconds of the processor that a message took the calling thread, where the recording was told
  // to ask (comm/recording.h). Not in files.
  double processor = 0;
};

// Indexed by world rank.
struct Ledger {
  std::vector<std::vector<Event>> ranks;
};

// Counted exactly. Messages of a rank to itself cross no network and are left out.
struct Totals {
  std::uint64_t bytes_sent = 0, bytes_received = 0;
  std::uint64_t messages_sent = 0, messages_received = 0;
  // Changes of phase or round between marks that were followed by a message.
  std::uint64_t rounds = 0;
  std::array<std::uint64_t, kWorkKinds> work{};  // indexed by Work
};

// Adds up the events of one rank, for runs of so many messages that nobody can keep them all.
class Tally {
 public:
  // `self` is the rank's world rank.
  explicit Tally(int self) : self_(self) {}

  // REQUIRES: rounds are numbered from 0.
  void add(const Event& event);
  const Totals& totals(Phase phase) const { return phases_[static_cast<std::size_t>(phase)]; }
  // Element i: whether there was a message in round i. May be shorter than there are rounds.
  const std::vector<bool>& rounds(Phase phase) const {
    return rounds_[static_cast<std::size_t>(phase)];
  }

 private:
  int self_;
  std::array<Totals, kPhases> phases_{};
  std::array<std::int32_t, kPhases> last_round_{};
  std::array<std::vector<bool>, kPhases> rounds_{};
};

// Of one rank's events: `self` is its world rank. With a phase, of that phase only. O(events).
Totals totals(std::span<const Event> events, int self, std::optional<Phase> phase = std::nullopt);

// Over all ranks: sums, and how many rounds there were: pairs of phase and round, whoever had a
// message in them.
Totals totals(const Ledger& ledger, std::optional<Phase> phase = std::nullopt);

// Collective: every rank's events on rank 0, nothing elsewhere. Call it on the communicator that
// was recorded, not on the recording.
Ledger gather_ledger(Communicator& communicator, std::span<const Event> events);

}  // namespace delray::comm
