// The protocol of masters that demand, guided and hierarchical scheduling share; they differ in the
// tree and in the amounts.
//
// A rank alternates between taking in messages, handing out tasks and doing one task, and waits
// only when none of these is possible. Tasks from above fill a pool; ranks below that ask are
// served from it first come, first served, and an empty reply ends them. Two messages for each
// batch.
//
// Degenerate: a single rank is the root, with all tasks and nobody to serve; a rank with nobody
// below it always works.
#include "loadbalance/schedules/masters.h"

#include <algorithm>
#include <deque>
#include <optional>

#include "loadbalance/schedules/tags.h"
#include "loadbalance/schedules/task_runner.h"
#include "parallel/arena.h"

namespace delray::loadbalance::internal {
namespace {

class MasterNode {
 public:
  MasterNode(comm::Communicator& communicator, const TaskGrid& tasks,
             const ScheduleOptions& options, TaskFunction work, const MasterTree& tree,
             Amount amount)
      : communicator_(communicator),
        tree_(tree),
        amount_(amount),
        master_(tree.master(communicator.rank())),
        ahead_(options.ahead.value_or(0)),
        is_root_(communicator.rank() == 0),
        has_all_(is_root_) {
    const int end = tree.end_below(communicator.rank());
    for (int k = tree.first_below(communicator.rank()); k < end; ++k) asking_.push_back(k);
    below_ = asking_.size();
    works_ = below_ == 0 || options.master_works;
    runner_.emplace(communicator, options, work, works_);
    const TaskRange all{0, tasks.count()};
    if (is_root_) pool_.put({&all, 1});
  }

  RankReport run() {
    for (;;) {
      take_in();
      hand_out();
      if (works_ && (runner_->run_one() || pool_.size() > 0)) continue;
      if (!has_all_) {
        if (asked_) {
          runner_->wait(master_, kTagTasks);
        } else {
          runner_->wait(comm::kAnyRank, kTagRequest);
        }
      } else if (below_ > 0) {
        runner_->wait(comm::kAnyRank, kTagRequest);
      } else {
        return runner_->finish();
      }
    }
  }

 private:
  // Messages that have arrived.
  void take_in() {
    bool any = false;
    while (below_ > 0) {
      const auto request = communicator_.probe(comm::kAnyRank, kTagRequest, comm::Deadline::now());
      if (!request) break;
      communicator_.receive(request->source, kTagRequest);
      asking_.push_back(request->source);
      any = true;
    }
    if (asked_ && communicator_.probe(master_, kTagTasks, comm::Deadline::now())) {
      const comm::Buffer message = communicator_.receive(master_, kTagTasks);
      pool_.put(message.as<TaskRange>());
      has_all_ = message.empty();
      asked_ = false;
      any = true;
    }
    if (any) runner_->served();
  }

  // To those who ask, then to the own threads; what is missing is asked for.
  void hand_out() {
    const bool any = !asking_.empty();
    while (!asking_.empty() && (pool_.size() > 0 || has_all_)) {
      const int to = asking_.front();
      asking_.pop_front();
      if (pool_.size() == 0) --below_;  // an empty message: it need not ask again
      const std::vector<TaskRange> tasks = take(tree_.workers(to));
      runner_->send(to, kTagTasks, comm::Buffer::of(std::span<const TaskRange>(tasks)));
    }
    const bool is_dry = works_ && runner_->waiting() <= ahead_;
    if (is_dry && pool_.size() > 0) runner_->put(take(1));
    if (!has_all_ && !asked_ && pool_.size() == 0 && (is_dry || !asking_.empty())) {
      runner_->send(master_, kTagRequest, comm::Buffer());
      ++runner_->report.requests;
      asked_ = true;
    }
    if (any) runner_->served();
  }

  std::vector<TaskRange> take(std::uint64_t workers) {
    if (pool_.size() == 0) return {};
    return pool_.take_front(amount_(pool_.size(), workers));
  }

  comm::Communicator& communicator_;
  MasterTree tree_;
  Amount amount_;
  int master_;
  std::uint64_t ahead_;
  bool is_root_, works_ = true;
  bool has_all_;            // no more will come from the master
  bool asked_ = !is_root_;  // or not yet spoken to
  std::deque<int> asking_;  // ranks below that wait for tasks
  std::size_t below_ = 0;   // ranks below that have not been told that there are no more
  TaskQueue pool_;          // to be handed out
  std::optional<TaskRunner> runner_;
};

}  // namespace

int MasterTree::first_below(int rank) const {
  return static_cast<int>(std::min(ranks, rank * fan_out + 1));
}

int MasterTree::end_below(int rank) const {
  return static_cast<int>(std::min(ranks, rank * fan_out + fan_out + 1));
}

std::uint64_t MasterTree::workers(int rank) const {
  const std::int64_t first_leaf = (ranks - 2 + fan_out) / fan_out;  // masters have lower numbers
  const std::int64_t first_worker = masters_work ? 0 : first_leaf;
  std::int64_t count = 0;
  for (std::int64_t first = rank, last = rank; first < ranks;
       first = first * fan_out + 1, last = last * fan_out + fan_out) {
    count +=
        std::max<std::int64_t>(0, std::min(last, ranks - 1) - std::max(first, first_worker) + 1);
  }
  return static_cast<std::uint64_t>(count);
}

MasterTree MasterTree::flat(const comm::Communicator& communicator,
                            const ScheduleOptions& options) {
  return {communicator.size(), std::max(1, communicator.size() - 1), options.master_works};
}

RankReport run_masters(comm::Communicator& communicator, const TaskGrid& tasks,
                       const ScheduleOptions& options, TaskFunction work, const MasterTree& tree,
                       Amount amount) {
  return MasterNode(communicator, tasks, options, work, tree, amount).run();
}

std::uint64_t batch_of(const ScheduleOptions& options) {
  if (options.batch > 0) return options.batch;
  return static_cast<std::uint64_t>(options.threads > 0 ? options.threads
                                                        : parallel::arena_threads());
}

}  // namespace delray::loadbalance::internal
