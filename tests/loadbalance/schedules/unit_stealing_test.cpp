// Units of tasks that are stolen while they wait: each is done once, wherever, and what was found
// of it comes home.
#include "loadbalance/schedules/unit_stealing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "comm/simulated.h"
#include "loadbalance/balance.h"
#include "loadbalance/divisible_work.h"
#include "loadbalance/simulated_schedule.h"

namespace delray::loadbalance {
namespace {

// Node `number` of the tree of units of a task; the tree's first 2^k - 1 nodes are there.
struct Unit {
  int home = 0;
  std::uint32_t task = 0;
  std::uint64_t number = 0;
};

// Of all ranks: which units were done, and found at home.
struct Trees {
  std::vector<std::uint64_t> sizes;  // of task i, nodes
  std::set<std::pair<std::uint32_t, std::uint64_t>> done;
  std::map<std::uint32_t, std::uint64_t> found;
  std::vector<std::uint64_t> by_rank;
};

// A unit takes a microsecond; thirty are done between two looks at messages. A task begins as one.
class TreeWork final : public DivisibleWork {
 public:
  TreeWork(comm::Communicator& communicator, Trees& trees)
      : communicator_(communicator), trees_(trees) {}

  void begin(std::uint32_t task) { units_.push_back({communicator_.rank(), task, 0}); }

  std::uint64_t units_of(std::uint32_t) const override { return 1; }
  std::uint64_t waiting() const override { return units_.size(); }
  bool wants_task() const override { return units_.empty(); }
  bool advance() override {
    if (units_.empty()) return false;
    int count = 0;
    for (; count < 30 && !units_.empty(); ++count) {
      const Unit unit = units_.front();
      units_.pop_front();
      EXPECT_TRUE(trees_.done.emplace(unit.task, unit.number).second);
      ++trees_.by_rank[static_cast<std::size_t>(communicator_.rank())];
      if (unit.home == communicator_.rank())
        ++trees_.found[unit.task];
      else
        found_[unit.home].push_back(unit.task);
      for (const std::uint64_t next : {2 * unit.number + 1, 2 * unit.number + 2})
        if (next < trees_.sizes[unit.task]) units_.push_back({unit.home, unit.task, next});
    }
    communicator_.work(comm::Work::seconds_e9, static_cast<std::uint64_t>(count) * 1000);
    return true;
  }
  Released release(std::uint64_t amount) override {
    const std::size_t count = std::min<std::size_t>(amount, units_.size());
    const std::vector<Unit> last(units_.end() - static_cast<std::ptrdiff_t>(count), units_.end());
    units_.resize(units_.size() - count);
    return {count, comm::Buffer::of(std::span<const Unit>(last))};
  }
  std::uint64_t put(std::span<const std::byte> message) override {
    std::vector<Unit> more(message.size() / sizeof(Unit));
    std::memcpy(more.data(), message.data(), message.size());
    units_.insert(units_.end(), more.begin(), more.end());
    return more.size();
  }
  std::vector<comm::Parcel> take_results() override {
    std::vector<comm::Parcel> parcels;
    for (const auto& [home, tasks] : std::exchange(found_, {}))
      parcels.push_back({home, comm::Buffer::of(std::span<const std::uint32_t>(tasks))});
    return parcels;
  }
  void put_results(std::span<const std::byte> message) override {
    for (; !message.empty(); message = message.subspan(sizeof(std::uint32_t))) {
      std::uint32_t task = 0;
      std::memcpy(&task, message.data(), sizeof(task));
      ++trees_.found[task];
    }
  }

 private:
  comm::Communicator& communicator_;
  Trees& trees_;
  std::deque<Unit> units_;
  std::map<int, std::vector<std::uint32_t>> found_;
};

std::vector<RankReport> run(const Schedule& schedule, Trees& trees, int ranks,
                            const comm::Network& network, std::uint64_t seed) {
  std::vector<RankReport> reports(static_cast<std::size_t>(ranks));
  trees.by_rank.resize(reports.size());
  const TaskGrid grid{static_cast<std::uint32_t>(trees.sizes.size()), 1};
  comm::run_simulated(ranks, network, seed, [&](comm::Communicator& communicator) {
    TreeWork work(communicator, trees);
    ScheduleOptions options;
    options.divisible = &work;
    reports[static_cast<std::size_t>(communicator.rank())] = schedule.run(
        communicator, grid, options, [&](std::uint32_t task, int) { work.begin(task); });
    EXPECT_FALSE(communicator.probe(comm::kAnyRank, comm::kAnyTag, comm::Deadline::now()));
  });
  return reports;
}

TEST(UnitStealing, DoesEveryUnitOnceInEveryOrderOfMessages) {
  std::uint64_t stolen = 0;
  for (const Schedule& schedule : schedules()) {
    if (!schedule.divides) continue;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      SCOPED_TRACE(std::string(schedule.name) + ", seed " + std::to_string(seed));
      Trees trees;
      for (std::uint64_t task = 0; task < seed % 11; ++task)
        trees.sizes.push_back(task * seed % 5 == 0 ? 4000 : task);
      comm::Network network = comm::any_order();
      network.jitter = seed % 2 == 0 ? 1e-5 : 1e-3;
      const int ranks = 1 + static_cast<int>(seed % 9);
      const auto reports = run(schedule, trees, ranks, network, seed);
      std::uint64_t tasks = 0, units = 0;
      for (const RankReport& report : reports) {
        tasks += report.tasks;
        stolen += report.units_stolen;
      }
      EXPECT_EQ(tasks, trees.sizes.size());
      for (std::uint32_t task = 0; task < trees.sizes.size(); ++task) {
        const std::uint64_t size = std::max<std::uint64_t>(1, trees.sizes[task]);
        EXPECT_EQ(trees.found[task], size) << task;
        units += size;
      }
      EXPECT_EQ(trees.done.size(), units);
    }
  }
  EXPECT_GT(stolen, 10000U);
}

// Where a single task has all the work no rank has much more than the mean.
TEST(UnitStealing, SpreadsASingleTask) {
  for (const Schedule& schedule : schedules()) {
    if (!schedule.divides) continue;
    for (const int ranks : {2, 3, 8}) {
      Trees trees;
      trees.sizes = {1, 200000, 1};
      run(schedule, trees, ranks, {}, 1);
      const std::vector<double> loads(trees.by_rank.begin(), trees.by_rank.end());
      EXPECT_LT(imbalance(loads), 1.1) << schedule.name << ' ' << ranks;
    }
  }
}

// Tasks whose times are known, one of them most of the work.
TEST(SimulatedSchedule, DividesTasksWithUnits) {
  const TaskGrid grid{8, 1};
  const std::vector<double> seconds = {1e-3, 1e-3, 80e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3};
  const std::vector<std::uint64_t> units = {1000, 1000, 80000, 1000, 1000, 1000, 1000, 1000};
  const SimulatedTasks tasks{grid, seconds, {}, 0, 0, units, 100, 20, units};
  for (const Schedule& schedule : schedules()) {
    SCOPED_TRACE(schedule.name);
    const SimulatedSchedule run = simulate(schedule, tasks, 4, {});
    std::uint64_t stolen = 0, bytes = 0;
    double done = 0, busy = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      done += run.rays[k];
      busy += run.busy[k];
      stolen += run.ranks[k].units_stolen;
      bytes += run.ranks[k].bytes_sent;
    }
    EXPECT_NEAR(done, 87000, 1e-6);
    EXPECT_NEAR(busy, 87e-3, 1e-9);
    if (schedule.divides) {
      EXPECT_LT(run.seconds, 1.2 * 87e-3 / 4);  // bytes take time as well
      EXPECT_GT(stolen, 40000U);
      EXPECT_GT(bytes, 100 * stolen);
    } else {
      EXPECT_GT(run.seconds, 79e-3);
      EXPECT_EQ(stolen, 0U);
    }
  }
}

}  // namespace
}  // namespace delray::loadbalance
