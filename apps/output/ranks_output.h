// A folder, a raster or a mesh in one file that all ranks of a run write together.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "apps/output/triangulation_output.h"
#include "comm/communicator.h"
#include "delaunay/triangulate_parts.h"

namespace delray::apps {

// One for each process. Ranks that are threads share what it opens; processes have one each, of
// which that of rank 0 becomes the whole.
class RanksOutput {
 public:
  // Whether ranks are processes.
  enum class Ranks : std::uint8_t { threads, processes };

  RanksOutput(const TriangulationOutput& output, OutputFacts facts, Ranks ranks);

  // A rank of a resumed run tells which tiles of its own an earlier one has finished. Any thread,
  // before open(); `finished` must stay callable until then.
  void add_finished(const std::function<bool(std::uint64_t tile)>& finished);
  // Throws what open() would, as far as that can be told of points that are counted.
  void check(const delaunay::PointsFound& points) const;
  // Throws UsageError for a raster of points without heights.
  void require_heights(bool has_z) const;
  // Collective, before the first simplex. Throws FileError, and UsageError for a raster of points
  // without heights and for a file of more points than there are numbers.
  void open(comm::Communicator& communicator, const delaunay::PointsFound& points);
  // Forwards to what was opened.
  delaunay::TileSink& sink() { return sink_; }
  // Whether a later run may go on with what has been written.
  bool can_resume() const { return asked_.kind() == OutputKind::folder; }
  // What has been written stays for a run that resumes this one. Any thread.
  void keep_unfinished();
  // Collective, after the last simplex; `parts` are those that the points came from. On rank 0 what
  // statistics say of it, or null. Throws FileError (device) where pieces are not those of all
  // tiles, as an earlier run's may be missing.
  Json commit(comm::Communicator& communicator, const delaunay::PointParts& parts,
              const delaunay::PartsResult& made);

 private:
  class Forward : public delaunay::TileSink {
   public:
    explicit Forward(const RanksOutput& to) : to_(to) {}
    void take(const delaunay::TilePiece& piece) override { to_.output_->sink().take(piece); }
    void take_heights(std::span<const delaunay::RowPoint> points) override {
      to_.output_->sink().take_heights(points);
    }

   private:
    const RanksOutput& to_;
  };

  TriangulationOutput asked_;
  OutputFacts facts_;
  bool processes_;
  std::mutex mutex_;
  std::vector<std::function<bool(std::uint64_t)>> finished_;
  std::map<int, delaunay::PartRows> rows_;  // of ranks
  std::unique_ptr<SimplexOutput> output_;
  Forward sink_{*this};
};

}  // namespace delray::apps
