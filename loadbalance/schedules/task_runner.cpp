// A rank's threads and its queue of tasks. The rank's own thread does tasks between messages; the
// others sleep on a condition variable when there are none. Threads take several at once while many
// wait. An exception on another thread empties the queue and is rethrown on the rank's own.
#include "loadbalance/schedules/task_runner.h"

#include <algorithm>
#include <stdexcept>

#include "parallel/arena.h"

namespace delray::loadbalance::internal {
namespace {

// The interval at which a rank that waits for messages checks whether one of its threads has
// failed.
constexpr auto kFailureCheck = std::chrono::milliseconds(5);

// Tasks that a thread takes from the queue at once: at most so many, and such a part of its share
// of what waits.
constexpr std::uint64_t kMost = 8, kShare = 16;

}  // namespace

TaskRunner::TaskRunner(comm::Communicator& communicator, const ScheduleOptions& options,
                       TaskFunction work, bool works)
    : communicator_(communicator), work_(work), start_(std::chrono::steady_clock::now()) {
  constexpr int kMostThreads = 4096;
  if (options.threads < 0 || options.threads > kMostThreads || options.fan_out < 2 ||
      !(options.share > 0)) {
    throw std::invalid_argument(
        "a schedule's threads are from 0 to 4096, its fan-out at least 2, its share above 0");
  }
  const int threads = options.threads > 0 ? options.threads : parallel::arena_threads();
  lanes_.resize(works ? static_cast<std::size_t>(std::max(1, threads)) : 1);
  report.rank = communicator.rank();
  report.threads = TaskRunner::threads();
  report.begin = communicator.seconds();
  for (Lane& lane : lanes_) lane.until = report.begin;
  try {
    for (int thread = 1; thread < TaskRunner::threads(); ++thread) {
      others_.emplace_back([this, thread] { run_thread(thread); });
    }
  } catch (...) {
    close();
    throw;
  }
}

TaskRunner::~TaskRunner() { close(); }

std::uint64_t TaskRunner::waiting() const {
  const std::lock_guard lock(mutex_);
  return queue_.size();
}

std::uint64_t TaskRunner::begun() const {
  const std::lock_guard lock(mutex_);
  return begun_;
}

void TaskRunner::put(std::span<const TaskRange> ranges) {
  {
    const std::lock_guard lock(mutex_);
    if (!failure_) queue_.put(ranges);
  }
  changed_.notify_all();
}

std::vector<TaskRange> TaskRunner::release(std::uint64_t amount) {
  const std::lock_guard lock(mutex_);
  return queue_.take_back(amount);
}

bool TaskRunner::run_one() {
  TaskRange& next = lanes_[0].next;
  if (next.count() == 0) {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    next = pop();
    if (next.count() == 0) return false;
  }
  run(next.first++, 0);
  return true;
}

comm::Envelope TaskRunner::wait(int from_or_any, comm::Tag tag) {
  for (;;) {
    const auto deadline =
        others_.empty() ? comm::Deadline::never() : comm::Deadline::in(kFailureCheck);
    const auto envelope = communicator_.probe(from_or_any, tag, deadline);
    if (envelope) {
      mark(0, Interval::Kind::wait);
      return *envelope;
    }
    rethrow_failure();
  }
}

void TaskRunner::send(int to, comm::Tag tag, comm::Buffer&& message) {
  ++report.messages;
  report.bytes_sent += message.counted_bytes();
  communicator_.send(to, tag, std::move(message));
}

RankReport TaskRunner::finish() {
  while (run_one()) {
  }
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  const bool alone = others_.empty();
  others_.clear();  // joins
  rethrow_failure();
  if (!alone) mark(0, Interval::Kind::wait);
  report.end = communicator_.seconds();
  for (Lane& lane : lanes_) {
    for (const Interval& interval : lane.intervals) {
      const double seconds = interval.end - interval.begin;
      if (interval.kind == Interval::Kind::work) report.busy += seconds;
      if (interval.kind == Interval::Kind::wait) report.idle += seconds;
      report.tasks += interval.tasks;
      report.timeline.push_back(interval);
    }
    // Another thread's clock is not quite the communicator's.
    report.idle += std::max(0.0, report.end - lane.until);
  }
  return std::move(report);
}

double TaskRunner::now(int thread) const {
  if (thread == 0) return communicator_.seconds();
  return report.begin +
         std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

// Intervals follow each other without a gap, and become one where nothing changes.
void TaskRunner::mark(int thread, Interval::Kind kind, std::uint64_t tasks) {
  Lane& lane = lanes_[static_cast<std::size_t>(thread)];
  const double end = now(thread);
  if (lane.intervals.empty() || lane.intervals.back().kind != kind) {
    lane.intervals.push_back({kind, static_cast<std::uint32_t>(thread), 0, lane.until, end});
  }
  lane.intervals.back().end = end;
  lane.intervals.back().tasks += tasks;
  lane.until = end;
}

void TaskRunner::run(std::uint32_t task, int thread) {
  work_(task, thread);
  mark(thread, Interval::Kind::work, 1);
}

// Takes several at once where threads would contend for the queue, but few of those that wait.
TaskRange TaskRunner::pop() {
  const auto threads = static_cast<std::uint64_t>(lanes_.size());
  const std::uint64_t most =
      threads == 1 ? 1 : std::clamp<std::uint64_t>(queue_.size() / (kShare * threads), 1, kMost);
  const TaskRange tasks = queue_.pop(most);
  begun_ += tasks.count();
  return tasks;
}

void TaskRunner::run_thread(int thread) {
  try {
    std::unique_lock lock(mutex_);
    for (;;) {
      if (queue_.size() == 0 && !closed_) {
        changed_.wait(lock, [this] { return queue_.size() > 0 || closed_; });
        mark(thread, Interval::Kind::wait);
      }
      TaskRange& next = lanes_[static_cast<std::size_t>(thread)].next;
      next = pop();
      if (next.count() == 0) return;
      lock.unlock();
      while (next.count() > 0) run(next.first++, thread);
      lock.lock();
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::current_exception();
    queue_.clear();
  }
}

void TaskRunner::close() {
  {
    const std::lock_guard lock(mutex_);
    queue_.clear();
    closed_ = true;
  }
  changed_.notify_all();
  others_.clear();
}

void TaskRunner::rethrow_failure() {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace delray::loadbalance::internal
