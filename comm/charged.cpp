// Reads the thread's processor time on entering each call, charges the difference to the last
// return as work, and reads it again on leaving, so that the time of the communicator itself is
// charged to nobody (direct execution: Covington et al. 1988).
#include "comm/charged.h"

#include <chrono>
#include <utility>

#include "parallel/processor_time.h"

namespace delray::comm {

using parallel::processor_nanoseconds;

namespace {

std::int64_t clock_nanoseconds() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

void Charged::Clock::go_on() {
  resumed = processor_nanoseconds();
  if (!is_real) return;
  if (time == ChargedTime::processor) core_wait = parallel::core_wait_nanoseconds();
  resumed_at = clock_nanoseconds();
  thread = std::this_thread::get_id();
}

std::int64_t Charged::Clock::blocked() const {
  constexpr std::int64_t kLeast = 20'000;  // less is what asking for the times takes
  if (!is_real || time != ChargedTime::processor || thread != std::this_thread::get_id()) return 0;
  const std::int64_t off_core =
      clock_nanoseconds() - resumed_at - (processor_nanoseconds() - resumed);
  if (!core_wait || off_core < kLeast) return 0;
  const std::optional<std::int64_t> wait = parallel::core_wait_nanoseconds();
  const std::int64_t blocked = wait ? off_core - (*wait - *core_wait) : 0;
  return blocked < kLeast ? 0 : blocked;
}

std::int64_t Charged::Clock::passed() const {
  if (is_real && (time == ChargedTime::clock || thread != std::this_thread::get_id()))
    return clock_nanoseconds() - resumed_at;
  return processor_nanoseconds() - resumed;
}

// While it lives, the thread does not work for this rank.
class Charged::Call {
 public:
  explicit Call(const Charged& charged) : clock_(*charged.clock_) {
    const std::int64_t passed = clock_.passed(), blocked = clock_.blocked();
    if (passed > 0 && !clock_.is_told())
      charged.inner().work(Work::seconds_e9, static_cast<std::uint64_t>(passed));
    if (blocked > 0) charged.inner().work(Work::blocked_e9, static_cast<std::uint64_t>(blocked));
  }
  ~Call() { clock_.go_on(); }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

 private:
  Clock& clock_;
};

Charged::Charged(Communicator& inner, std::span<const Phase> told)
    : ForwardingCommunicator(inner), clock_(std::make_shared<Clock>()) {
  for (const Phase phase : told) clock_->told |= 1U << static_cast<unsigned>(phase);
  clock_->go_on();
}

Charged::Charged(Communicator& inner, ChargedTime time) : Charged(inner) {
  clock_->is_real = true;
  clock_->time = time;
  clock_->go_on();
}

Charged::Charged(std::unique_ptr<Communicator> inner, std::shared_ptr<Clock> clock)
    : ForwardingCommunicator(std::move(inner)), clock_(std::move(clock)) {}

double Charged::seconds() const {
  if (clock_->is_real) return inner().seconds();
  const Call call(*this);
  return inner().seconds();
}

void Charged::send(int to, Tag tag, Buffer&& message) {
  const Call call(*this);
  inner().send(to, tag, std::move(message));
}

void Charged::multicast(std::span<const int> to, Tag tag, Buffer&& message) {
  const Call call(*this);
  inner().multicast(to, tag, std::move(message));
}

Buffer Charged::receive(int from_or_any, Tag tag_or_any) {
  const Call call(*this);
  return inner().receive(from_or_any, tag_or_any);
}

std::optional<Envelope> Charged::probe(int from_or_any, Tag tag_or_any, Deadline deadline) {
  const Call call(*this);
  const bool is_work = clock_->is_real && clock_->time == ChargedTime::processor;
  const std::int64_t begin = is_work ? processor_nanoseconds() : 0;
  auto envelope = inner().probe(from_or_any, tag_or_any, deadline);
  // No event stands for looking for a message, but it takes a core that others want.
  if (is_work)
    inner().work(Work::seconds_e9, static_cast<std::uint64_t>(processor_nanoseconds() - begin));
  return envelope;
}

std::unique_ptr<Communicator> Charged::split(int color, int key) {
  const Call call(*this);
  return std::unique_ptr<Communicator>(new Charged(inner().split(color, key), clock_));
}

void Charged::mark(Phase phase, int round) {
  const Call call(*this);
  clock_->phase = phase;
  inner().mark(phase, round);
}

Communicator::Replica Charged::replicate(const std::function<Replica()>& compute) {
  struct Timed {
    Replica result;
    std::uint64_t nanoseconds = 0;
  };
  const Call call(*this);
  const auto timed = std::static_pointer_cast<const Timed>(inner().replicate([&]() -> Replica {
    const std::int64_t begin = processor_nanoseconds();
    auto computed = std::make_shared<Timed>();
    computed->result = compute();
    computed->nanoseconds = static_cast<std::uint64_t>(processor_nanoseconds() - begin);
    return computed;
  }));
  if (!clock_->is_told()) inner().work(Work::seconds_e9, timed->nanoseconds);
  return timed->result;
}

void Charged::work(Work kind, std::uint64_t amount) {
  if (clock_->is_told()) inner().work(kind, amount);
}

}  // namespace delray::comm
