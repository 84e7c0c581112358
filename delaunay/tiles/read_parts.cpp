// Threads read runs of parts, so that each meets points by ascending rows. Where several ranks
// read, they exchange what they have read by rounds, each of one batch of every thread.
#include "delaunay/tiles/read_parts.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "delaunay/tiles/distribute_points.h"
#include "files/error.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

std::size_t share_begin(std::size_t n, std::size_t i, std::size_t shares) {
  return n / shares * i + std::min(i, n % shares);
}

// Places that are not finite make the sum none.
geometry::Box3d box_of_places(std::span<const glm::dvec3> places, int dim, double& sum) {
  geometry::Box3d box;
  glm::dvec3 nothing(0);
  for (const glm::dvec3& place : places) {
    box.include(place);
    nothing += place * 0.0;
  }
  sum = nothing.x + nothing.y + (dim == 3 ? nothing.z : 0);
  return box;
}

// Throws for the first place that is not finite.
void refuse_place(std::span<const glm::dvec3> places, int dim, std::uint64_t first_row) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (int k = 0; k < dim; ++k) {
      if (std::isfinite(places[i][k])) continue;
      throw std::invalid_argument("row " + std::to_string(first_row + i) +
                                  " has a coordinate that is not finite");
    }
  }
}

// Of a point whose row is not known yet.
std::uint64_t number_of(std::size_t part, std::size_t place) {
  constexpr int kPlaceBits = 40;
  return (static_cast<std::uint64_t>(part) << kPlaceBits) + place;
}

// Runs work(thread, first, last) for runs of the parts [begin, end), one for each thread.
template <class Work>
void share_parts(std::size_t begin, std::size_t end, const Work& work) {
  const auto threads = static_cast<std::size_t>(parallel::arena_threads());
  parallel::parallel_for(0, threads, 1, [&](std::size_t thread) {
    work(thread, begin + share_begin(end - begin, thread, threads),
         begin + share_begin(end - begin, thread + 1, threads));
  });
}

// A bit for each attribute that some of the points do not have.
unsigned missing_attributes(const PointCloud& cloud) {
  const auto missing = [&](const auto& values) { return values.size() < cloud.size() ? 1U : 0U; };
  return missing(cloud.colours) | missing(cloud.intensity) << 1 |
         missing(cloud.classification) << 2;
}

void advance(parallel::Progress* progress, std::uint64_t steps) {
  if (progress != nullptr) progress->advance(steps);
}

// Parts [first, last), as many as have about so many rows, but at least one.
std::size_t batch_end(const PartCounts& counts, std::size_t first, std::size_t last,
                      std::uint64_t rows) {
  std::size_t end = first;
  const auto row = [&](std::size_t part) { return counts.first_rows[part - counts.first_part]; };
  while (end < last && (end == first || row(end + 1) - row(first) <= rows)) ++end;
  return end;
}

struct BatchOptions {
  std::size_t rows = 1;
  int ranks = 1;
};

// Reads parts and gives their points, sorted by tiles, some batch_rows at a time: a part that
// cannot be cut may have many more.
template <class Give>
void read_batch(const PointParts& parts, const PartCounts& counts, const Destination& to,
                std::size_t first, std::size_t last, const BatchOptions& options,
                const Give& give) {
  std::vector<PointCloud> clouds(last - first);
  std::vector<PointRun> runs;
  std::vector<std::int32_t> tile_of;
  const auto give_runs = [&] {
    if (!runs.empty()) give(pack_by_tile(runs, tile_of, to.format, to.tiles, options.ranks));
    runs.clear();
    tile_of.clear();
  };
  for (std::size_t part = first; part < last; ++part) {
    PointCloud& cloud = clouds[part - first];
    parts.read(part, cloud);
    const std::size_t own = part - counts.first_part;
    if (cloud.size() != counts.first_rows[own + 1] - counts.first_rows[own]) {
      throw files::FileError(files::Cause::device, "points", "part " + std::to_string(part),
                             "has changed while it was read");
    }
    const std::span<const glm::dvec3> places = cloud.positions;
    for (std::size_t begin = 0; begin < places.size(); begin += options.rows) {
      const auto some =
          places.subspan(begin, std::min<std::size_t>(options.rows, places.size() - begin));
      if (tile_of.size() + some.size() > options.rows) give_runs();
      runs.push_back({some, counts.first_rows[own] + begin});
      for (const glm::dvec3& place : some) tile_of.push_back(to.cut.tile_of(place));
    }
  }
  give_runs();
}

// Takes messages in for the rank's own tiles.
class Receiver {
 public:
  Receiver(const Destination& to, std::size_t first_tile) : to_(to), first_(first_tile) {}

  void take(comm::Buffer&& message) {
    for (const TileRecords& run : tiles_of(message, to_.format)) {
      TileSummary summary;
      for (std::uint64_t i = 0; i < run.count; ++i) {
        summary.include(to_.format.read(run.records + i * to_.format.bytes()), to_.dim);
      }
      const std::lock_guard lock(mutex_);
      to_.own[run.tile - first_].include(summary, to_.dim);
      to_.own_points[run.tile - first_] += run.count;
    }
    to_.store.add(std::move(message));
  }

 private:
  const Destination& to_;
  std::size_t first_;
  std::mutex mutex_;
};

}  // namespace

PartCounts count_parts(comm::Communicator& communicator, const PointParts& parts,
                       const CountOptions& options, parallel::Progress* progress) {
  const int dim = options.dim;
  const auto most = static_cast<std::size_t>(options.sample);
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const std::size_t begin = share_begin(parts.parts(), rank, ranks);
  const std::size_t end = share_begin(parts.parts(), rank + 1, ranks);
  PartCounts counts{PointSample(most), 0, false, {}, begin, {}, {}};
  std::vector<std::uint64_t> sizes(end - begin);
  std::atomic<std::size_t> bad_part{end};
  std::atomic<bool> has_z{false};
  std::atomic<unsigned> missing{0};
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    std::mutex mutex;
    share_parts(begin, end, [&](std::size_t, std::size_t first, std::size_t last) {
      PointSample sample(most);
      geometry::Box3d around;
      PointCloud cloud;
      for (std::size_t part = first; part < last; ++part) {
        parts.read(part, cloud);
        sizes[part - begin] = cloud.size();
        if (cloud.has_z) has_z = true;
        missing |= missing_attributes(cloud);
        double sum = 0;
        const geometry::Box3d box = box_of_places(cloud.positions, dim, sum);
        if (sum != 0) {
          std::size_t lowest = bad_part;
          while (part < lowest && !bad_part.compare_exchange_weak(lowest, part)) {
          }
          break;
        }
        around.include(box);
        for (std::size_t i = 0; i < cloud.size(); ++i) {
          sample.add(number_of(part, i), cloud.positions[i]);
        }
        advance(progress, cloud.size());
      }
      const std::lock_guard lock(mutex);
      counts.sample.add(sample);
      counts.box.include(around);
    });
  });
  std::uint64_t before = 0;
  for (const std::uint64_t size : sizes) before += size;
  std::uint64_t first_row = before;
  comm::exclusive_scan(communicator, std::span(&first_row, 1), std::uint64_t{0}, std::plus<>());
  first_row += options.first_row;
  counts.first_rows.push_back(first_row);
  for (const std::uint64_t size : sizes) counts.first_rows.push_back(first_row += size);
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    if (bad_part == end) return;
    PointCloud cloud;
    parts.read(bad_part, cloud);
    refuse_place(cloud.positions, dim, counts.first_rows[bad_part - begin]);
  });
  const unsigned bits = missing;
  std::uint64_t sums[] = {before, has_z ? 1U : 0U, bits & 1, bits >> 1 & 1, bits >> 2};
  comm::all_reduce(communicator, std::span<std::uint64_t>(sums), std::plus<>());
  counts.points = sums[0];
  counts.has_z = sums[1] > 0;
  counts.attributes = {sums[2] == 0, sums[3] == 0, sums[4] == 0};
  double ends[] = {counts.box.low.x,   counts.box.low.y,   counts.box.low.z,
                   -counts.box.high.x, -counts.box.high.y, -counts.box.high.z};
  comm::all_reduce(communicator, std::span<double>(ends),
                   [](double a, double b) { return std::min(a, b); });
  counts.box = {{ends[0], ends[1], ends[2]}, {-ends[3], -ends[4], -ends[5]}};
  if (dim == 2 && !counts.box.empty()) counts.box.low.z = counts.box.high.z = 0;
  return counts;
}

void distribute_parts(comm::Communicator& communicator, const PointParts& parts,
                      const PartCounts& counts, const Destination& to, const MemoryPlan& plan,
                      parallel::Progress* progress) {
  const int ranks = communicator.size(), rank = communicator.rank();
  const std::size_t begin = counts.first_part, end = begin + counts.first_rows.size() - 1;
  const BatchOptions batch{static_cast<std::size_t>(plan.batch_rows), ranks};
  Receiver receiver(to, static_cast<std::size_t>(first_tile(rank, ranks, to.tiles)));
  const auto points_of = [&](std::size_t first, std::size_t last) {
    return counts.first_rows[last - begin] - counts.first_rows[first - begin];
  };
  if (ranks == 1) {
    share_parts(begin, end, [&](std::size_t, std::size_t first, std::size_t last) {
      while (first < last) {
        const std::size_t next = batch_end(counts, first, last, plan.batch_rows);
        read_batch(parts, counts, to, first, next, batch, [&](std::vector<comm::Parcel>&& some) {
          for (comm::Parcel& parcel : some) receiver.take(std::move(parcel.message));
        });
        advance(progress, points_of(first, next));
        first = next;
      }
    });
    return;
  }
  for (std::size_t next = begin;;) {
    std::vector<comm::Parcel> all;
    comm::all_or_none(communicator, comm::Phase::redistribute, [&] {
      std::vector<std::pair<std::size_t, std::size_t>> batches;
      for (int thread = 0; thread < parallel::arena_threads() && next < end; ++thread) {
        const std::size_t first = next;
        next = batch_end(counts, first, end, plan.batch_rows);
        batches.emplace_back(first, next);
      }
      std::vector<std::vector<comm::Parcel>> parcels(batches.size());
      parallel::parallel_for(0, batches.size(), 1, [&](std::size_t i) {
        const auto [first, last] = batches[i];
        read_batch(parts, counts, to, first, last, batch, [&](std::vector<comm::Parcel>&& some) {
          std::ranges::move(some, std::back_inserter(parcels[i]));
        });
        advance(progress, points_of(first, last));
      });
      for (auto& each : parcels) std::ranges::move(each, std::back_inserter(all));
    });
    const std::uint64_t left = end - next;
    const bool done = comm::all_reduce_value(communicator, left, std::plus<>()) == 0;
    auto received = comm::exchange(communicator, std::move(all));
    comm::all_or_none(communicator, comm::Phase::redistribute, [&] {
      parallel::parallel_for(0, received.size(), 1,
                             [&](std::size_t i) { receiver.take(std::move(received[i].message)); });
    });
    if (done) return;
  }
}

}  // namespace delray::delaunay
