// Promises of every schedule, over threads and over every order of messages.
#include "loadbalance/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include "comm/collectives.h"
#include "comm/simulated.h"
#include "comm/threads.h"

namespace delray::loadbalance {
namespace {

using Reports = std::vector<RankReport>;

const Schedule& schedule(const char* name) { return *find_schedule(name); }

// How often each task was done, and by whom last.
struct Log {
  explicit Log(const TaskGrid& grid) : times(grid.count()), rank(grid.count()) {}
  std::vector<std::atomic<int>> times;
  std::vector<std::atomic<int>> rank;

  void expect_each_once() const {
    for (std::size_t task = 0; task < times.size(); ++task) {
      ASSERT_EQ(times[task].load(), 1) << "task " << task;
    }
  }
};

void expect_consistent(const Reports& reports, const TaskGrid& grid, const Log& log) {
  std::uint64_t tasks = 0;
  for (const RankReport& report : reports) {
    tasks += report.tasks;
    EXPECT_EQ(report.rank, &report - reports.data());
    const auto done = std::count_if(log.rank.begin(), log.rank.end(),
                                    [&](const auto& rank) { return rank.load() == report.rank; });
    EXPECT_EQ(report.tasks, static_cast<std::uint64_t>(done));
    EXPECT_LE(report.steals, report.tasks_stolen);
    std::uint64_t in_timeline = 0;
    double busy = 0;
    for (std::size_t k = 0; k < report.timeline.size(); ++k) {
      const Interval& interval = report.timeline[k];
      EXPECT_LE(interval.begin, interval.end);
      EXPECT_LT(interval.thread, static_cast<std::uint32_t>(report.threads));
      in_timeline += interval.tasks;
      if (interval.kind == Interval::Kind::work) busy += interval.end - interval.begin;
      if (k > 0 && report.timeline[k - 1].thread == interval.thread) {
        EXPECT_LE(report.timeline[k - 1].end, interval.begin);
        EXPECT_NE(report.timeline[k - 1].kind, interval.kind);
      }
    }
    EXPECT_EQ(in_timeline, report.tasks);
    EXPECT_NEAR(busy, report.busy, 1e-9);
    EXPECT_GE(report.idle, 0);
  }
  EXPECT_EQ(tasks, grid.count());
}

// On ranks that are threads. `work` is what a task does beside being counted.
Reports run_on_threads(
    const Schedule& schedule, int ranks, int threads, const TaskGrid& grid,
    const ScheduleOptions& options, Log& log,
    const std::function<void(int rank, std::uint32_t task, int thread)>& work = {}) {
  Reports reports;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    const int rank = communicator.rank();
    const RankReport mine =
        schedule.run(communicator, grid, options, [&](std::uint32_t task, int thread) {
          EXPECT_LT(thread, threads);
          ++log.times[task];
          log.rank[task] = rank;
          if (work) work(rank, task, thread);
        });
    Reports all = gather_reports(communicator, mine);
    if (rank == 0) reports = std::move(all);
  });
  return reports;
}

// On simulated ranks, of which some are slower; each task takes a millisecond on the others.
struct Simulated {
  Reports reports;
  double seconds = 0;  // until the last rank has returned
};
Simulated run_simulated(const Schedule& schedule, int ranks, const TaskGrid& grid,
                        const ScheduleOptions& options, Log& log, const comm::Network& network,
                        std::uint64_t seed, std::vector<double> slowness = {}) {
  Simulated result;
  comm::SimulationOptions simulation;
  simulation.slowness = std::move(slowness);
  ScheduleOptions single = options;
  single.threads = 1;
  comm::run_simulated(
      ranks, network, seed,
      [&](comm::Communicator& communicator) {
        const RankReport mine =
            schedule.run(communicator, grid, single, [&](std::uint32_t task, int) {
              ++log.times[task];
              log.rank[task] = communicator.rank();
              communicator.work(comm::Work::seconds_e9, 1000000);
            });
        Reports all = gather_reports(communicator, mine);
        if (communicator.rank() == 0) result.reports = std::move(all);
      },
      simulation);
  for (const RankReport& report : result.reports) {
    result.seconds = std::max(result.seconds, report.end);
  }
  return result;
}

TEST(Schedules, DoEveryTaskOnceForAllNumbersOfRanksAndThreads) {
  for (const Schedule& schedule : schedules()) {
    for (int ranks = 1; ranks <= 9; ++ranks) {
      for (const TaskGrid grid : {TaskGrid{7, 9}, TaskGrid{40, 1}, TaskGrid{3, 1}, TaskGrid{1, 5},
                                  TaskGrid{0, 0}, TaskGrid{0, 4}}) {
        const int threads = 1 + (ranks + static_cast<int>(grid.count())) % 3;
        for (const bool master_works : {true, false}) {
          SCOPED_TRACE(std::string(schedule.name) + ", " + std::to_string(ranks) + " x " +
                       std::to_string(threads) + ", " + std::to_string(grid.count()) + " tasks");
          ScheduleOptions options;
          options.master_works = master_works;
          options.fan_out = 2;
          Log log(grid);
          const Reports reports = run_on_threads(schedule, ranks, threads, grid, options, log);
          log.expect_each_once();
          expect_consistent(reports, grid, log);
        }
      }
    }
  }
}

// Every order in which messages may arrive, over seeds; one rank ten times slower.
TEST(Schedules, DoEveryTaskOnceInEveryOrderOfMessages) {
  for (const Schedule& schedule : schedules()) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const int ranks = 1 + static_cast<int>(seed % 9);
      const TaskGrid grid{static_cast<std::uint32_t>(seed * 7 % 13), 1 + seed % 5 > 3 ? 6U : 1U};
      SCOPED_TRACE(std::string(schedule.name) + ", seed " + std::to_string(seed));
      ScheduleOptions options;
      options.fan_out = 2 + static_cast<int>(seed % 2);
      options.master_works = seed % 3 != 0;
      options.ahead = seed % 4 == 0 ? std::optional<std::uint32_t>(seed % 3) : std::nullopt;
      std::vector<double> slowness(static_cast<std::size_t>(ranks), 1.0);
      slowness[seed % slowness.size()] = 10;
      comm::Network network = comm::any_order();
      network.jitter = seed % 2 == 0 ? 1e-3 : 1.0;
      Log log(grid);
      const auto result =
          run_simulated(schedule, ranks, grid, options, log, network, seed, slowness);
      log.expect_each_once();
      expect_consistent(result.reports, grid, log);
    }
  }
}

TEST(Schedules, DoEveryTaskOnceWithASlowRankOnThreads) {
  const TaskGrid grid{12, 5};
  for (const Schedule& schedule : schedules()) {
    for (const int slow : {0, 3}) {
      SCOPED_TRACE(schedule.name);
      Log log(grid);
      const Reports reports =
          run_on_threads(schedule, 5, 2, grid, {}, log, [&](int rank, std::uint32_t, int) {
            std::this_thread::sleep_for(std::chrono::microseconds(rank == slow ? 500 : 50));
          });
      log.expect_each_once();
      expect_consistent(reports, grid, log);
    }
  }
}

// Runs follow each other without a barrier, of different kinds, and other messages are under way.
TEST(Schedules, OfSeveralRunsDoNotMeet) {
  constexpr comm::Tag kOther = 7;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    comm::Network network = comm::any_order();
    network.jitter = seed % 2 == 0 ? 1e-3 : 0.1;
    const int ranks = 2 + static_cast<int>(seed % 6);
    const TaskGrid grid{static_cast<std::uint32_t>(seed % 11), 3};
    std::mt19937_64 random(seed);
    std::vector<const Schedule*> chosen(16);
    for (auto& schedule : chosen) schedule = &schedules()[random() % schedules().size()];
    for (std::size_t run = 1; run < chosen.size(); run += 2) {
      if (random() % 2 == 0) chosen[run] = chosen[run - 1];
    }
    std::vector<std::unique_ptr<Log>> logs;
    for (std::size_t run = 0; run < chosen.size(); ++run) {
      logs.push_back(std::make_unique<Log>(grid));
    }
    comm::run_simulated(ranks, network, seed, [&](comm::Communicator& communicator) {
      const int next = (communicator.rank() + 1) % ranks;
      for (std::size_t run = 0; run < logs.size(); ++run) {
        communicator.send(next, kOther, comm::Buffer());
        ScheduleOptions options;
        options.threads = 1;
        options.fan_out = 2 + static_cast<int>(run % 3);
        options.master_works = run % 4 != 1;
        chosen[run]->run(communicator, grid, options, [&](std::uint32_t task, int) {
          ++logs[run]->times[task];
          communicator.work(comm::Work::seconds_e9, 1000 * (task % 7) * (task % 7));
        });
      }
      for (std::size_t run = 0; run < logs.size(); ++run) {
        communicator.receive(comm::kAnyRank, kOther);
      }
      comm::barrier(communicator);
      EXPECT_FALSE(communicator.probe(comm::kAnyRank, comm::kAnyTag, comm::Deadline::now()));
    });
    for (const auto& log : logs) log->expect_each_once();
  }
}

// Eight ranks, one ten times slower, 800 tasks of a millisecond: 110 ms where all is shared out
// perfectly, 1000 ms where every rank does as many tasks.
TEST(Schedules, ThatAdaptLeaveASlowRankLess) {
  const TaskGrid grid{80, 10};
  std::vector<double> slowness(8, 1.0);
  slowness[5] = 10;
  for (const Schedule& schedule : schedules()) {
    SCOPED_TRACE(schedule.name);
    const std::string name = schedule.name;
    ScheduleOptions options;
    // One master that is slow to answer because it works is another matter.
    options.master_works = name != "demand" && name != "guided";
    Log log(grid);
    const Simulated result = run_simulated(schedule, 8, grid, options, log, {}, 1, slowness);
    log.expect_each_once();
    const std::uint64_t slow = result.reports[5].tasks;
    if (std::string(schedule.group) == "fixed") {
      EXPECT_EQ(slow, 100U);
      EXPECT_GT(result.seconds, 0.99);
      for (const RankReport& report : result.reports) EXPECT_EQ(report.messages, 0U);
    } else if (name == "guided") {
      EXPECT_LE(slow, 80U);  // its first batch is 57 already, in whole rows 0 or 80
    } else {
      EXPECT_LE(slow, 25U);
      EXPECT_LT(result.seconds, 0.25);
    }
  }
}

TEST(Schedules, ForEqualRanksAndTasksShareEqually) {
  for (const Schedule& schedule : schedules()) {
    const TaskGrid grid{1, 1000};
    Log log(grid);
    const Simulated result = run_simulated(schedule, 5, grid, {}, log, {}, 1);
    EXPECT_LT(result.seconds, 0.23) << schedule.name;
  }
}

TEST(Schedules, RethrowWhatATaskThrowsAndEndAllRanks) {
  for (const Schedule& schedule : schedules()) {
    for (const int threads : {1, 3}) {
      for (const int culprit : {0, 2}) {
        SCOPED_TRACE(std::string(schedule.name) + ", " + std::to_string(threads) + " threads");
        const TaskGrid grid{10, 20};
        try {
          Log log(grid);
          run_on_threads(schedule, 4, threads, grid, {}, log,
                         [&](int rank, std::uint32_t, int thread) {
                           if (rank == culprit && thread == threads - 1) {
                             throw std::runtime_error("no more");
                           }
                           std::this_thread::sleep_for(std::chrono::microseconds(50));
                         });
          // A thread may get no task at all, but with one thread its rank has to do some.
          EXPECT_GT(threads, 1);
        } catch (const comm::RankFailure& failure) {
          EXPECT_EQ(failure.rank(), culprit);
          EXPECT_EQ(failure.why(), "no more");
        }
      }
    }
  }
}

TEST(Schedules, AreFoundByName) {
  EXPECT_GE(schedules().size(), 8U);  // those of the report
  for (const Schedule& schedule : schedules()) {
    EXPECT_EQ(find_schedule(schedule.name), &schedule);
  }
  EXPECT_EQ(find_schedule("nonsense"), nullptr);
}

TEST(Schedules, BeginWithTheSharesThatAreGiven) {
  for (const char* name : {"static", "stealing", "neighbour-stealing"}) {
    const TaskGrid grid{90, 1};
    Log log(grid);
    std::vector<RankReport> reports(3);
    comm::run_threads(3, 1, [&](comm::Communicator& communicator) {
      ScheduleOptions options;
      options.initial.emplace();
      if (communicator.rank() == 1) options.initial = {{10, 90}, {0, 10}};
      reports[communicator.rank()] =
          schedule(name).run(communicator, grid, options, [&](std::uint32_t task, int) {
            ++log.times[task];
            std::this_thread::sleep_for(std::chrono::microseconds(20));
          });
    });
    log.expect_each_once();
    if (std::string(name) == "static") {
      EXPECT_EQ(reports[1].tasks, 90U);
    } else {
      // At least, for what was taken may be taken again.
      EXPECT_GE(reports[0].tasks_stolen + reports[2].tasks_stolen, 90 - reports[1].tasks);
    }
  }
}

TEST(Demand, CountsWhatItSends) {
  const TaskGrid grid{20, 1};
  ScheduleOptions options;
  options.master_works = false;
  options.batch = 3;
  Log log(grid);
  const Reports reports = run_simulated(schedule("demand"), 3, grid, options, log, {}, 1).reports;
  // Seven batches, the last of two tasks, and one message to each that there are no more.
  EXPECT_EQ(reports[0].tasks, 0U);
  EXPECT_EQ(reports[0].messages, 9U);
  EXPECT_EQ(reports[0].bytes_sent, 7 * sizeof(TaskRange));
  EXPECT_EQ(reports[1].requests + reports[2].requests, 7U);
  EXPECT_EQ(reports[1].tasks + reports[2].tasks, 20U);
  EXPECT_EQ(reports[1].bytes_sent, 0U);
  EXPECT_EQ(reports[0].busy, 0);
  EXPECT_NEAR(reports[1].busy + reports[2].busy, 0.02, 1e-4);  // looking for messages included
}

// Who gets what from the start on: the tasks of a batch are consecutive.
TEST(Guided, HandsOutEverFewerWholeRowsAndThenPartsOfOne) {
  const TaskGrid grid{10, 64};
  ScheduleOptions options;
  options.master_works = false;
  options.share = 1;
  std::vector<std::uint32_t> order;
  Log log(grid);
  ScheduleOptions single = options;
  single.threads = 1;
  std::vector<std::size_t> batches;
  comm::run_simulated(2, {}, 1, [&](comm::Communicator& communicator) {
    const RankReport report = schedule("guided").run(
        communicator, grid, single, [&](std::uint32_t task, int) { order.push_back(task); });
    if (communicator.rank() == 0) {
      EXPECT_EQ(report.messages, 2U);  // everything to the only one who works
    }
  });
  EXPECT_EQ(order.size(), grid.count());

  // Two who work, half of the rest each time: 32 rows, 16, 8, 4, 2, 1; 5 tasks, 2, 1, 1 and 1.
  const Reports reports = run_simulated(schedule("guided"), 3, grid, options, log, {}, 1).reports;
  EXPECT_EQ(reports[0].messages, 11U + 2U);
  for (std::uint32_t row = 0; row < 63; ++row) {
    for (std::uint32_t i = 1; i < 10; ++i) EXPECT_EQ(log.rank[row * 10 + i], log.rank[row * 10]);
  }
}

TEST(Hierarchical, NobodyTalksToMoreThanItsMasterAndThoseBelow) {
  const TaskGrid grid{500, 1};
  ScheduleOptions options;
  options.fan_out = 3;
  options.master_works = false;
  Log log(grid);
  const Reports reports =
      run_simulated(schedule("hierarchical"), 13, grid, options, log, {}, 1).reports;
  for (int k = 0; k <= 3; ++k) EXPECT_EQ(reports[k].tasks, 0U);
  for (int k = 4; k < 13; ++k) EXPECT_GT(reports[k].tasks, 20U);
  // A master passes on three at a time; the one above it is asked a third as often.
  EXPECT_LE(reports[0].messages, 500U / 3 + 10);
  EXPECT_LE(reports[1].requests, reports[4].requests + 10);
}

TEST(Random, DependsOnTheSeedOnly) {
  const TaskGrid grid{64, 4};
  const auto owners = [&](std::uint64_t seed) {
    Log log(grid);
    ScheduleOptions options;
    options.seed = seed;
    run_on_threads(schedule("random"), 4, 1, grid, options, log);
    return std::vector<int>(log.rank.begin(), log.rank.end());
  };
  EXPECT_EQ(owners(3), owners(3));
  EXPECT_NE(owners(3), owners(4));
}

TEST(Interlaced, ShiftsFromRowToRow) {
  const TaskGrid grid{10, 4};
  Log log(grid);
  run_on_threads(schedule("interlaced"), 3, 2, grid, {}, log);
  for (std::uint32_t task = 0; task < grid.count(); ++task) {
    EXPECT_EQ(log.rank[task], static_cast<int>((task % 10 + task / 10) % 3));
  }
}

// All tasks begin on one rank: the others get them from there, or by way of their neighbours.
TEST(Stealing, SpreadsWhatOneRankHas) {
  for (const char* name : {"stealing", "neighbour-stealing"}) {
    for (const int ranks : {2, 3, 8, 13}) {
      const TaskGrid grid{400, 1};
      Log log(grid);
      Reports reports;
      comm::run_simulated(ranks, {}, 1, [&](comm::Communicator& communicator) {
        ScheduleOptions options;
        options.threads = 1;
        options.initial.emplace();
        if (communicator.rank() == ranks - 1) options.initial = {{0, grid.count()}};
        const RankReport mine =
            schedule(name).run(communicator, grid, options, [&](std::uint32_t task, int) {
              ++log.times[task];
              communicator.work(comm::Work::seconds_e9, 1000000);
            });
        Reports all = gather_reports(communicator, mine);
        if (communicator.rank() == 0) reports = std::move(all);
      });
      log.expect_each_once();
      for (const RankReport& report : reports) {
        EXPECT_GE(report.tasks, 200U / ranks) << name << ' ' << ranks;
        EXPECT_LE(report.tasks, 800U / ranks) << name << ' ' << ranks;
        if (report.rank != ranks - 1) {
          EXPECT_GE(report.tasks_stolen, report.tasks);
        }
      }
    }
  }
}

TEST(NeighbourStealing, AsksNobodyButNeighbours) {
  const TaskGrid grid{200, 1};
  Log log(grid);
  std::vector<double> slowness(16, 1.0);
  slowness[0] = 10;
  const Reports reports =
      run_simulated(schedule("neighbour-stealing"), 16, grid, {}, log, {}, 1, slowness).reports;
  for (const RankReport& report : reports) EXPECT_EQ(report.requests % 4, 0U);
}

}  // namespace
}  // namespace delray::loadbalance
