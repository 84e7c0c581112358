// The table of schedules, looked up by name, and the gathering of the ranks' reports on rank 0.
#include <array>
#include <cstring>

#include "comm/collectives.h"
#include "files/find_named.h"
#include "loadbalance/schedules/schedules.h"

namespace delray::loadbalance {
namespace {

constexpr std::array kSchedules = {
    Schedule{.name = "static",
             .description = "each rank has as many consecutive tasks",
             .run = &internal::static_schedule,
             .group = "fixed",
             .begins_with_shares = true},
    Schedule{.name = "interlaced",
             .description = "tasks are assigned in turn, each row shifted",
             .run = &internal::interlaced_schedule,
             .group = "fixed"},
    Schedule{.name = "random",
             .description = "tasks are assigned in random order",
             .run = &internal::random_schedule,
             .group = "fixed"},
    Schedule{.name = "demand",
             .description = "a master hands out a few tasks whenever a rank asks (Badouel)",
             .run = &internal::demand,
             .group = "master",
             .has_master = true},
    Schedule{.name = "guided",
             .description = "a master hands out ever fewer rows of tasks at a time (Pandzic)",
             .run = &internal::guided,
             .group = "master",
             .has_master = true},
    Schedule{.name = "hierarchical",
             .description =
                 "a tree of masters: ranks ask theirs for tasks, and they ask those above (Green)",
             .run = &internal::hierarchical,
             .group = "master",
             .has_master = true},
    Schedule{.name = "stealing",
             .description = "idle ranks take tasks from ranks that have more than the mean",
             .run = &internal::stealing,
             .group = "stealing",
             .begins_with_shares = true},
    Schedule{.name = "half-stealing",
             .description = "idle ranks take half of what the rank with most has left (Ellsworth)",
             .run = &internal::half_stealing,
             .group = "stealing",
             .begins_with_shares = true},
    Schedule{
        .name = "neighbour-stealing",
        .description =
            "ranks ask their neighbours in a hypercube for tasks before they run out (Heirich)",
        .run = &internal::neighbour_stealing,
        .group = "stealing",
        .begins_with_shares = true},
    Schedule{
        .name = "ray-stealing",
        .description = "stealing of pending rays: tiles in progress are divided, too (Badouel)",
        .run = &internal::ray_stealing,
        .group = "stealing",
        .begins_with_shares = true,
        .divides = true},
    Schedule{
        .name = "ray-neighbours",
        .description = "neighbour-stealing of pending rays, of tiles in progress, too (Heirich)",
        .run = &internal::ray_neighbours,
        .group = "stealing",
        .begins_with_shares = true,
        .divides = true},
};

}  // namespace

std::span<const Schedule> schedules() { return kSchedules; }

const Schedule* find_schedule(std::string_view name) {
  return files::find_named(schedules(), name);
}

std::vector<RankReport> gather_reports(comm::Communicator& communicator, const RankReport& mine) {
  const ScheduleCounts& counts = mine;
  comm::Buffer message(sizeof(counts) + mine.timeline.size() * sizeof(Interval));
  std::memcpy(message.data(), &counts, sizeof(counts));
  if (!mine.timeline.empty()) {
    std::memcpy(message.data() + sizeof(counts), mine.timeline.data(),
                mine.timeline.size() * sizeof(Interval));
  }
  std::vector<RankReport> reports;
  for (const comm::Buffer& from : comm::gather(communicator, 0, std::move(message))) {
    RankReport& report = reports.emplace_back();
    std::memcpy(static_cast<ScheduleCounts*>(&report), from.data(), sizeof(ScheduleCounts));
    report.timeline.resize((from.size() - sizeof(ScheduleCounts)) / sizeof(Interval));
    if (!report.timeline.empty()) {
      std::memcpy(report.timeline.data(), from.data() + sizeof(ScheduleCounts),
                  report.timeline.size() * sizeof(Interval));
    }
  }
  return reports;
}

}  // namespace delray::loadbalance
