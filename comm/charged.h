// A communicator through which the simulated machine learns how long code really takes.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <thread>

#include "comm/forwarding.h"

namespace delray::comm {

// Which time passes between two calls: the processor's at the calling thread, or that of the clock,
// for code that has a core for each of its threads.
enum class ChargedTime : std::uint8_t { processor, clock };

// Passes on to `inner`, as work, the time between one call and the next, of the processor at the
// calling thread, so that real code runs on the simulated machine in its own time (direct
// execution: Covington et al. 1988), or that a recording of real ranks (comm/recording.h) knows
// what they did between messages. Where the next call comes from another thread, it is the time of
// the clock. Of real ranks and the processor's time, what passes without the thread being ready to
// run, in which it waits for a device or for other threads of its rank, is passed on as
// Work::blocked_e9; nothing is where the system does not tell it from waiting for a core. What the
// code itself tells of its work is left out: it is in that time. Only in the phases `told` it is
// the other way round: there the code only counts what it would do, and what it tells takes the
// time that it says. Times, and with them the order of what waits for any message, differ from run
// to run as measured times do.
//
// REQUIRES: on the simulated machine, loops over parallel/ run inside of an arena of one thread,
// entered before. `inner` outlives this and what is split from it.
class Charged final : public ForwardingCommunicator {
 public:
  explicit Charged(Communicator& inner, std::span<const Phase> told = {});
  // Of ranks whose time passes anyway: asking for the time charges nothing.
  Charged(Communicator& inner, ChargedTime time);

  double seconds() const override;

  void send(int to, Tag tag, Buffer&& message) override;
  void multicast(std::span<const int> to, Tag tag, Buffer&& message) override;
  Buffer receive(int from_or_any, Tag tag_or_any) override;
  std::optional<Envelope> probe(int from_or_any, Tag tag_or_any, Deadline deadline) override;
  std::unique_ptr<Communicator> split(int color, int key) override;
  void mark(Phase phase, int round) override;
  void work(Work kind, std::uint64_t amount) override;
  // Every rank is charged for what one of them computes.
  Replica replicate(const std::function<Replica()>& compute) override;

 private:
  struct Clock {
    std::int64_t resumed = 0;     // processor time of the thread when the rank's code went on
    std::int64_t resumed_at = 0;  // the clock then
    std::optional<std::int64_t> core_wait;  // parallel::core_wait_nanoseconds() then
    std::thread::id thread;                 // which it was
    bool is_real = false;                   // time passes without being charged
    ChargedTime time = ChargedTime::processor;
    std::uint32_t told = 0;      // bit k: of phase k
    Phase phase = Phase::other;  // marked last, on whichever communicator
    void go_on();
    std::int64_t passed() const;   // nanoseconds since go_on
    std::int64_t blocked() const;  // of them, those in which it could not run
    bool is_told() const { return (told >> static_cast<unsigned>(phase) & 1U) != 0; }
  };
  class Call;
  Charged(std::unique_ptr<Communicator> inner, std::shared_ptr<Clock> clock);

  std::shared_ptr<Clock> clock_;
};

}  // namespace delray::comm
