// Reports are gathered on rank 0 and summed up; statistics of several frames are added.
#include "raster/distribute/frame_report.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "comm/collectives.h"
#include "loadbalance/partition.h"

namespace delray::raster {
namespace {

// The frame's statistics, of all ranks' reports.
Statistics summarize(std::span<const FrameReport> reports, bool packed) {
  Statistics statistics;
  if (packed) statistics.pack.emplace();
  double busiest = 0, sum = 0;
  for (const FrameReport& report : reports) {
    statistics.phases += report.rank.phases;
    statistics.ranks.push_back(report.rank);
    if (packed) *statistics.pack += report.rank.pack;
    busiest = std::max(busiest, report.rank.busy);
    sum += report.rank.busy;
    statistics.triangles_in += report.triangles.in;
    statistics.triangles_culled += report.triangles.culled;
    statistics.triangles_clipped += report.triangles.clipped;
    statistics.triangles_rasterized += report.triangles.rasterized;
    statistics.triangles_hidden += report.triangles.hidden;
    statistics.clusters_hidden += report.triangles.hidden_clusters;
    statistics.triangles_travelled += report.triangles_travelled;
    statistics.fragments_travelled += report.fragments_travelled;
    statistics.fragments += report.fragments;
    statistics.shaded += report.shaded;
  }
  if (sum > 0) statistics.imbalance = busiest / (sum / static_cast<double>(reports.size()));
  return statistics;
}

}  // namespace

FrameReport make_report(const RankContext& rank, std::span<const comm::Event> events) {
  const comm::Communicator& communicator = rank.communicator;
  const comm::Totals totals = comm::totals(events, communicator.world_rank(communicator.rank()));
  const Phases& phases = rank.counts.phases;
  FrameReport report{};
  report.rank.rank = communicator.rank();
  report.rank.busy = phases.transform + phases.bin + phases.rasterize + phases.shade;
  report.rank.phases = phases;
  report.rank.tasks = rank.counts.tiles;
  report.rank.triangles_in = rank.counts.triangles.in;
  report.rank.triangles = rank.counts.triangles.rasterized;
  report.rank.shaded = rank.counts.shaded;
  report.rank.requests = rank.schedule.requests;
  report.rank.steals = rank.schedule.steals;
  report.rank.blocks_stolen = rank.schedule.tasks_stolen;
  report.rank.idle = rank.schedule.idle;
  report.rank.pack = rank.pack;
  report.rank.bytes_sent = totals.bytes_sent;
  report.rank.bytes_received = totals.bytes_received;
  report.rank.messages = totals.messages_sent;
  report.triangles = rank.counts.triangles;
  report.fragments = rank.counts.fragments;
  report.shaded = rank.counts.shaded;
  report.triangles_travelled = rank.triangles_travelled;
  report.fragments_travelled = rank.fragments_travelled;
  return report;
}

Statistics gather_statistics(comm::Communicator& communicator, const FrameReport& mine,
                             bool packed) {
  comm::Buffer message(packed ? sizeof(FrameReport) : sizeof(FrameReport) - sizeof(PackCounts));
  std::memcpy(message.data(), &mine, message.size());
  std::vector<FrameReport> reports;
  for (const comm::Buffer& buffer : comm::gather(communicator, 0, std::move(message)))
    std::memcpy(static_cast<void*>(&reports.emplace_back()), buffer.data(), buffer.size());
  return communicator.rank() == 0 ? summarize(reports, packed) : Statistics();
}

void PackCounts::operator+=(const PackCounts& other) {
  pages += other.pages;
  pages_hidden += other.pages_hidden;
  clusters += other.clusters;
  for (std::size_t level = 0; level < kLevels; ++level) levels[level] += other.levels[level];
  cache += other.cache;
}

void Phases::operator+=(const Phases& other) {
  transform += other.transform;
  bin += other.bin;
  rasterize += other.rasterize;
  shade += other.shade;
  redistribute += other.redistribute;
  compose += other.compose;
  gather += other.gather;
}

void Statistics::operator+=(Statistics&& more) {
  if (ranks.empty()) {
    *this = std::move(more);
    return;
  }
  phases += more.phases;
  std::vector<double> busy;
  for (std::size_t r = 0; r < ranks.size(); ++r) {
    ranks[r] += more.ranks[r];
    busy.push_back(ranks[r].busy);
  }
  imbalance = loadbalance::imbalance(busy);
  if (pack && more.pack) *pack += *more.pack;
  triangles_in += more.triangles_in;
  triangles_culled += more.triangles_culled;
  triangles_clipped += more.triangles_clipped;
  triangles_rasterized += more.triangles_rasterized;
  triangles_hidden += more.triangles_hidden;
  clusters_hidden += more.clusters_hidden;
  triangles_travelled += more.triangles_travelled;
  fragments_travelled += more.fragments_travelled;
  fragments += more.fragments;
  shaded += more.shaded;
  partition = std::move(more.partition);
  warnings = std::move(more.warnings);
}

void RankStatistics::operator+=(const RankStatistics& other) {
  busy += other.busy;
  tasks += other.tasks;
  phases += other.phases;
  triangles_in += other.triangles_in;
  triangles += other.triangles;
  shaded += other.shaded;
  bytes_sent += other.bytes_sent;
  bytes_received += other.bytes_received;
  messages += other.messages;
  requests += other.requests;
  steals += other.steals;
  blocks_stolen += other.blocks_stolen;
  idle += other.idle;
  pack += other.pack;
}

}  // namespace delray::raster
