// Opens on rank 0 first, so that others find what they join; brings together on rank 0 what
// processes have.
#include "apps/output/ranks_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/output/raster_output.h"
#include "comm/agree_on_failure.h"

namespace delray::apps {

RanksOutput::RanksOutput(const TriangulationOutput& output, OutputFacts facts, Ranks ranks)
    : asked_(output), facts_(std::move(facts)), processes_(ranks == Ranks::processes) {}

void RanksOutput::add_finished(const std::function<bool(std::uint64_t tile)>& finished) {
  const std::lock_guard lock(mutex_);
  finished_.push_back(finished);
}

void RanksOutput::require_heights(bool has_z) const {
  if (asked_.kind() != OutputKind::raster || has_z) return;
  throw UsageError("-o " + asked_.path + ": the points have no z");
}

void RanksOutput::check(const delaunay::PointsFound& points) const {
  require_heights(points.has_z);
  if (asked_.kind() != OutputKind::raster) return;
  OutputFacts facts = facts_;
  facts.box = points.box;
  raster_grid_of(asked_, facts);
}

void RanksOutput::open(comm::Communicator& communicator, const delaunay::PointsFound& points) {
  const bool first = communicator.rank() == 0;
  {
    const std::lock_guard lock(mutex_);
    rows_[communicator.rank()] = points.rows;
  }
  const auto open_here = [&] {
    require_heights(points.has_z);
    if (asked_.kind() == OutputKind::file &&
        points.points > delaunay::MeshFileOptions::kMostPoints) {
      throw UsageError(
          fmt::format("-o {}: {} points are more than one file has numbers for; -o "
                      "FOLDER/ takes them",
                      asked_.path, points.points));
    }
    OutputFacts facts = facts_;
    facts.box = points.box;
    facts.writer = facts.file.writer = communicator.rank();
    facts.file.points = points.points;
    facts.file.has_z = points.has_z;
    facts.file.attributes = points.attributes;
    output_ = open_simplex_output(asked_, facts);
    if (!facts.resume) return;
    output_->keep_tiles([this](std::uint64_t tile) {
      return std::ranges::any_of(finished_, [tile](const auto& has) { return has(tile); });
    });
  };
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    if (first) open_here();
  });
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    if (!first && processes_) open_here();
  });
}

void RanksOutput::keep_unfinished() {
  const std::lock_guard lock(mutex_);
  if (output_) output_->keep_unfinished();
}

Json RanksOutput::commit(comm::Communicator& communicator, const delaunay::PointParts& parts,
                         const delaunay::PartsResult& made) {
  if (processes_) {
    for (int rank = 1; rank < communicator.size(); ++rank) {
      if (communicator.rank() == rank) output_->send_to_first(communicator);
      if (communicator.rank() == 0) output_->receive(communicator, rank);
    }
  }
  {
    std::unique_lock lock(mutex_);
    const delaunay::PartRows rows = rows_[communicator.rank()];
    lock.unlock();
    output_->write(communicator, {parts, rows, !processes_});
  }
  return comm::all_or_none(communicator, comm::Phase::other, [&]() -> Json {
    if (communicator.rank() != 0) return nullptr;
    return output_->commit({made.points, made.distinct, made.hull_facets, made.hash});
  });
}

}  // namespace delray::apps
