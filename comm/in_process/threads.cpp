// Ranks as threads, with one inbox each that is guarded by a mutex; a message is moved into the
// queue of its receiver.
//
// A rank that waits polls for a short while if there are cores enough, then sleeps on a condition
// variable, and a sender wakes it only for the message that it waits for. A counter of running
// ranks finds deadlocks: whoever brings it to zero reports one. O(1) per message, besides the
// search of the receiver's queue.
//
// Degenerate: a rank that waits with a deadline counts as running. A rank that computes without end
// is noticed only by the time-out of those who wait for it.
#include "comm/threads.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "comm/collectives.h"
#include "comm/in_process/group.h"
#include "comm/transport/first_failure.h"
#include "parallel/arena.h"

namespace delray::comm {
namespace {

using internal::Group;
using Clock = std::chrono::steady_clock;

// Where messages for one rank arrive, whatever its communicators. `mutex` guards the rank's queues
// in all groups and the fields below.
struct alignas(64) Inbox {
  std::mutex mutex;
  std::condition_variable changed;
  // What the rank sleeps for; a sender that delivers it clears `waiting`.
  bool waiting = false;
  bool counted_as_blocked = false;
  bool has_stalled = false;  // waited for longer than ranks may, and is about to say so
  const Group* group = nullptr;
  int from = 0;
  Tag tag = 0;

  // Read by other ranks only to word a failure and to spin.
  std::atomic<Phase> phase{Phase::other};
  std::atomic<std::uint32_t> deliveries{0};
};

class World {
 public:
  World(int ranks, const ThreadsOptions& options)
      : inboxes(ranks), timeout(options.timeout), running_(ranks) {
    const auto cores = static_cast<int>(std::thread::hardware_concurrency());
    awake = std::chrono::microseconds(ranks <= cores ? 200 : 0);
  }

  std::vector<Inbox> inboxes;  // indexed by world rank
  std::chrono::nanoseconds timeout;
  // How long a rank looks for a message before it sleeps: being woken takes a virtual core almost
  // as long. 0 where cores are scarce.
  std::chrono::nanoseconds awake;
  Clock::time_point start = Clock::now();
  internal::FirstFailure failure;

  // Ranks whose threads have not ended, and whether one of them is taken for stalled.
  std::mutex end_mutex;
  std::condition_variable end_changed;
  int not_ended = 0;
  bool stalled = false;

  void change_not_ended(int by) {
    const std::scoped_lock lock(end_mutex);
    not_ended += by;
    end_changed.notify_all();
  }

  // Until all ranks have ended, or one is taken for stalled and they do not end.
  bool all_end() {
    constexpr std::chrono::seconds kGrace{2};
    std::unique_lock lock(end_mutex);
    end_changed.wait(lock, [&] { return not_ended == 0 || stalled; });
    return end_changed.wait_for(lock, kGrace, [&] { return not_ended == 0; });
  }

  // The rank that `rank` waits for in the end; itself where ranks wait for each other, or it for
  // any. REQUIRES: the caller holds no lock.
  int stalled_rank(int rank) {
    const int first = rank;
    for (std::size_t steps = 0; steps < inboxes.size(); ++steps) {
      Inbox& inbox = inboxes[static_cast<std::size_t>(rank)];
      const std::scoped_lock lock(inbox.mutex);
      if (!inbox.has_stalled && !(inbox.waiting && inbox.counted_as_blocked)) return rank;
      if (inbox.from == kAnyRank) return first;
      rank = inbox.group->world_ranks[static_cast<std::size_t>(inbox.from)];
    }
    return first;
  }

  template <class Why>
  void fail(int rank, Why&& why) {
    if (!failure.record(rank, inboxes[rank].phase, std::forward<Why>(why))) return;
    for (Inbox& inbox : inboxes) {
      // Locked, so that a rank between its look at the failure and its sleep is not missed.
      { const std::scoped_lock lock(inbox.mutex); }
      inbox.changed.notify_all();
    }
  }

  // `running_` counts the ranks that have neither returned nor sleep without a deadline. A sender
  // counts the rank that it wakes before it goes on, so at zero nobody can send: a deadlock unless
  // all have returned. True for the one caller that brings it to zero.
  bool stop_running() { return running_.fetch_sub(1, std::memory_order_acq_rel) == 1; }
  void resume_running() { running_.fetch_add(1, std::memory_order_acq_rel); }

  // REQUIRES: the caller holds no lock.
  void report_deadlock() {
    std::string why;
    int first = -1, others = 0;
    for (std::size_t rank = 0; rank < inboxes.size(); ++rank) {
      const std::scoped_lock lock(inboxes[rank].mutex);
      if (!inboxes[rank].waiting) continue;
      if (first < 0) {
        first = static_cast<int>(rank);
        why = "deadlock: it waits for a message from " +
              internal::describe_pattern(inboxes[rank].from, inboxes[rank].tag);
      } else {
        ++others;
      }
    }
    if (first < 0) return;
    if (others > 0) why += ", and " + std::to_string(others) + " more rank(s) wait in vain";
    fail(first, std::move(why));
  }

 private:
  std::atomic<int> running_;
};

class ThreadCommunicator final : public Communicator {
 public:
  ThreadCommunicator(World& world, std::shared_ptr<Group> group, int rank)
      : world_(world),
        group_(std::move(group)),
        rank_(rank),
        inbox_(world.inboxes[group_->world_ranks[rank]]) {}

  int rank() const override { return rank_; }
  int size() const override { return static_cast<int>(group_->world_ranks.size()); }
  int world_rank(int rank) const override { return group_->world_ranks[rank]; }
  double seconds() const override {
    return std::chrono::duration<double>(Clock::now() - world_.start).count();
  }

  void send(int to, Tag tag, Buffer&& message) override {
    internal::check_message(to, size(), tag);
    if (world_.failure.happened()) throw RunEnded{};
    Inbox& inbox = world_.inboxes[group_->world_ranks[to]];
    bool wake = false;
    {
      const std::scoped_lock lock(inbox.mutex);
      group_->queues[to].push(rank_, tag, 0, std::move(message));
      inbox.deliveries.fetch_add(1, std::memory_order_release);
      if (inbox.waiting && inbox.group == group_.get() &&
          internal::matches(rank_, tag, inbox.from, inbox.tag)) {
        wake = true;
        stop_waiting(inbox);
      }
    }
    if (wake) inbox.changed.notify_one();
  }

  Buffer receive(int from_or_any, Tag tag_or_any) override {
    std::unique_lock lock(inbox_.mutex);
    auto* message = wait(lock, from_or_any, tag_or_any, Deadline::never());
    return group_->queues[rank_].take(message);
  }

  std::optional<Envelope> probe(int from_or_any, Tag tag_or_any, Deadline deadline) override {
    std::unique_lock lock(inbox_.mutex);
    const auto* message = wait(lock, from_or_any, tag_or_any, deadline);
    if (!message) return std::nullopt;
    return Envelope{message->source, message->tag, message->payload.size()};
  }

  std::unique_ptr<Communicator> split(int color, int key) override {
    group_->post_split(rank_, color, key);
    barrier(*this);
    auto [group, rank] = group_->take_split(rank_);
    return std::make_unique<ThreadCommunicator>(world_, std::move(group), rank);
  }

  void mark(Phase phase, int) override { inbox_.phase.store(phase, std::memory_order_relaxed); }
  void work(Work, std::uint64_t) override {}

  // `from` and `tag` are what this rank waits for.
  [[noreturn]] void end_stalled(int from, Tag tag, std::chrono::nanoseconds longest) {
    const int first = from == kAnyRank ? kAnyRank : world_rank(from);
    const int stalled = first == kAnyRank ? world_rank(rank_) : world_.stalled_rank(first);
    {
      const std::scoped_lock lock(world_.end_mutex);
      world_.stalled = true;
    }
    std::array<char, 32> seconds{};
    std::snprintf(seconds.data(), seconds.size(), "%.3g s",
                  std::chrono::duration<double>(longest).count());
    world_.fail(stalled, "stalled: rank " + std::to_string(world_rank(rank_)) + " waited " +
                             seconds.data() + " for a message from " +
                             internal::describe_pattern(first, tag));
    world_.end_changed.notify_all();
    throw RunEnded{};
  }

  void abort(std::string why) override {
    world_.fail(group_->world_ranks[rank_], std::move(why));
    throw RunEnded{};
  }

 private:
  using Message = internal::MessageQueue<Buffer>::Message;

  // REQUIRES: the caller holds inbox.mutex and inbox.waiting.
  void stop_waiting(Inbox& inbox) {
    inbox.waiting = false;
    if (inbox.counted_as_blocked) world_.resume_running();
  }

  // The first message that matches, once there is one; null when the deadline passes before.
  Message* wait(std::unique_lock<std::mutex>& lock, int from, Tag tag, Deadline deadline) {
    constexpr auto kForever = std::chrono::nanoseconds::max();
    auto& queue = group_->queues[rank_];
    const bool forever = deadline.wait == kForever;
    const auto longest = std::min(deadline.wait, world_.timeout);
    Clock::time_point end{};
    bool end_known = false;
    bool stays_awake = world_.awake.count() > 0;
    for (;;) {
      if (world_.failure.happened()) throw RunEnded{};
      if (auto* message = queue.find(from, tag)) return message;
      if (longest != kForever) {
        if (deadline.wait <= std::chrono::nanoseconds{0}) return nullptr;
        const auto now = Clock::now();
        if (!end_known) end = now + longest;
        end_known = true;
        if (now >= end) {
          if (longest == deadline.wait) return nullptr;
          inbox_.has_stalled = true;
          inbox_.group = group_.get();
          inbox_.from = from;
          lock.unlock();
          end_stalled(from, tag, longest);
        }
      }
      if (stays_awake) {
        stays_awake = spin(lock);
        continue;
      }
      sleep(lock, from, tag, forever, longest == kForever ? nullptr : &end);
    }
  }

  // Until a message has come or it has taken too long, which is false.
  bool spin(std::unique_lock<std::mutex>& lock) {
    const std::uint32_t seen = inbox_.deliveries.load(std::memory_order_relaxed);
    const auto has_come = [&] { return inbox_.deliveries.load(std::memory_order_acquire) != seen; };
    lock.unlock();
    const auto end = Clock::now() + world_.awake;
    bool found = false;
    do {
      for (int i = 0; i < 64 && !found; ++i) found = has_come();
      if (!found) std::this_thread::yield();
    } while (!found && Clock::now() < end);
    lock.lock();
    return found;
  }

  void sleep(std::unique_lock<std::mutex>& lock, int from, Tag tag, bool forever,
             const Clock::time_point* end) {
    inbox_.waiting = true;
    inbox_.counted_as_blocked = forever;
    inbox_.group = group_.get();
    inbox_.from = from;
    inbox_.tag = tag;
    if (forever && world_.stop_running()) {
      lock.unlock();
      world_.report_deadlock();
      lock.lock();
    } else if (end) {
      inbox_.changed.wait_until(lock, *end);
    } else {
      inbox_.changed.wait(lock);
    }
    if (inbox_.waiting) stop_waiting(inbox_);
  }

  World& world_;
  std::shared_ptr<Group> group_;
  int rank_;
  Inbox& inbox_;
};

void run_rank(World& world, const std::shared_ptr<Group>& group, int rank, int threads_per_rank,
              const std::function<void(Communicator&)>& body) {
  try {
    ThreadCommunicator communicator(world, group, rank);
    parallel::Arena arena(threads_per_rank);
    arena.execute([&] { body(communicator); });
  } catch (const RunEnded&) {
  } catch (...) {
    world.fail(rank, std::current_exception());
  }
  if (world.stop_running()) world.report_deadlock();
  world.change_not_ended(-1);
}

}  // namespace

void run_threads(int ranks, int threads_per_rank, const std::function<void(Communicator&)>& body,
                 const ThreadsOptions& options) {
  if (ranks < 1) throw std::invalid_argument("ranks: there is at least one");
  if (threads_per_rank < 1 || threads_per_rank > kMostThreadsPerRank) {
    throw std::invalid_argument("threads of a rank: from 1 to " +
                                std::to_string(kMostThreadsPerRank));
  }
  const parallel::AllowThreads allowed(ranks * threads_per_rank);
  const parallel::JoinWorkers join_workers;
  World world(ranks, options);
  std::vector<int> members(ranks);
  std::iota(members.begin(), members.end(), 0);
  const auto group = std::make_shared<Group>(std::move(members));
  {
    std::vector<std::jthread> threads;
    threads.reserve(ranks);
    try {
      for (int rank = 0; rank < ranks; ++rank) {
        world.change_not_ended(1);
        threads.emplace_back([&world, &group, rank, threads_per_rank, &body] {
          run_rank(world, group, rank, threads_per_rank, body);
        });
      }
    } catch (...) {
      world.change_not_ended(-1);
      world.fail(static_cast<int>(threads.size()), std::current_exception());
    }
    if (!world.all_end() && options.on_stuck) {
      try {
        world.failure.rethrow_if_any();
      } catch (const RankFailure& failure) {
        options.on_stuck(failure);
      }
    }
  }
  world.failure.rethrow_if_any();
}

}  // namespace delray::comm
