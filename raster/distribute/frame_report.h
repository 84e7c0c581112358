// What ranks did for a frame, and its statistics.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "comm/communicator.h"
#include "comm/ledger.h"
#include "raster/distribute/rank_context.h"
#include "raster/render.h"

namespace delray::raster {

// What one rank did, as it travels to rank 0, which sums up the statistics of the frame.
struct FrameReport {
  TriangleCounts triangles;
  std::uint64_t fragments, shaded, triangles_travelled, fragments_travelled;

  void operator+=(const FrameReport& other) {
    rank += other.rank;
    triangles += other.triangles;
    fragments += other.fragments;
    shaded += other.shaded;
    triangles_travelled += other.triangles_travelled;
    fragments_travelled += other.fragments_travelled;
  }
  RankStatistics rank;  // ends with what only packs have
};
static_assert(offsetof(FrameReport, rank) + offsetof(RankStatistics, pack) + sizeof(PackCounts) ==
              sizeof(FrameReport));

// What this rank did by now; `events` are its messages.
FrameReport make_report(const RankContext& rank, std::span<const comm::Event> events);

// The statistics of a frame of which this rank did what the report says; on rank 0. Counts of packs
// travel only where the scene is one. Collective.
Statistics gather_statistics(comm::Communicator& communicator, const FrameReport& mine,
                             bool packed);

}  // namespace delray::raster
