// A rank's part in a schedule: its threads, the tasks that wait for them, and what it has done.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "loadbalance/schedule.h"
#include "loadbalance/schedules/task_queue.h"

namespace delray::loadbalance::internal {

// Only the rank's own thread calls it, its thread 0; the other threads start with it and do tasks
// as long as there are any.
class TaskRunner {
 public:
  // With `works` false this rank does no tasks.
  TaskRunner(comm::Communicator& communicator, const ScheduleOptions& options, TaskFunction work,
             bool works = true);
  // Forgets what waits; the threads end after their present tasks.
  ~TaskRunner();
  TaskRunner(const TaskRunner&) = delete;
  TaskRunner& operator=(const TaskRunner&) = delete;

  int threads() const { return static_cast<int>(lanes_.size()); }
  std::uint64_t waiting() const;  // tasks that nobody has begun
  std::uint64_t begun() const;

  void put(std::span<const TaskRange> ranges);
  // Releases up to `amount` of the tasks that would be begun last, for another rank.
  std::vector<TaskRange> release(std::uint64_t amount);

  // Does the next task; false when none waits. Throws what a task on another thread has thrown.
  bool run_one();
  // Waits until there is such a message. Throws as run_one.
  comm::Envelope wait(int from_or_any, comm::Tag tag);
  // The time since the last call went to messages, to waiting, or to tasks that were begun before.
  void served() { mark(0, Interval::Kind::serve); }
  void waited() { mark(0, Interval::Kind::wait); }
  void worked() { mark(0, Interval::Kind::work); }
  void send(int to, comm::Tag tag, comm::Buffer&& message);

  // Does what waits and returns when all threads have done their tasks. The last call.
  RankReport finish();

  RankReport report;  // its counts of requests and steals are the schedule's

 private:
  // The record of a thread: what it did, and how far its time is accounted for.
  struct alignas(64) Lane {
    std::vector<Interval> intervals;
    double until = 0;
    TaskRange next;  // tasks that it is about to do
  };
  TaskRange pop();  // REQUIRES: the mutex is held
  double now(int thread) const;
  void mark(int thread, Interval::Kind kind, std::uint64_t tasks = 0);
  void run(std::uint32_t task, int thread);
  void run_thread(int thread);
  void close();
  void rethrow_failure();

  comm::Communicator& communicator_;
  TaskFunction work_;
  std::chrono::steady_clock::time_point start_;  // when it was report.begin
  std::vector<Lane> lanes_;                      // indexed by thread
  mutable std::mutex mutex_;                     // for all that follows
  std::condition_variable changed_;
  TaskQueue queue_;
  std::uint64_t begun_ = 0;
  bool closed_ = false;
  std::exception_ptr failure_;
  std::vector<std::jthread> others_;
};

}  // namespace delray::loadbalance::internal
