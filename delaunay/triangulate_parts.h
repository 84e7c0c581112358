// Triangulations of points that memory need not hold, by one process or by many ranks.
//
// Points are counted on a grid, which is cut into tiles, and each goes to the file of its tile on
// disk. Then tiles are triangulated, several at a time; simplices that no other tile can change
// leave memory at once, and what is left of neighbours is put together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/duplicates.h"
#include "delaunay/point_parts.h"
#include "delaunay/tile_sink.h"
#include "delaunay/tiles.h"
#include "geometry/box.h"

namespace delray::delaunay {

// What all points have.
struct PointAttributes {
  bool colours = true, intensity = true, classification = true;
};

// The parts of the input that a rank reads: `first` and those behind it. first_rows has the row of
// the first point of each, and one more; it is empty in a run that was resumed.
struct PartRows {
  std::size_t first = 0;
  std::vector<std::uint64_t> first_rows;
};

// What is known of all points before the first simplex is.
struct PointsFound {
  std::uint64_t points = 0;
  bool has_z = false;
  geometry::Box3d box;  // z is 0 in 2D; empty without points
  PointAttributes attributes;
  PartRows rows;  // of this rank
};

// What a sink writes, in bytes for each point, as far as that can be told before.
struct SinkDiskUse {
  std::filesystem::path folder;     // where the result grows
  std::uint64_t result_bytes = 0;   // there
  std::uint64_t scratch_bytes = 0;  // in the folder of scratch files, until the end
};

// How points in parts are triangulated, and where they wait.
struct PartsOptions {
  // Tiles 0: as many as keep within memory, at least one a rank. Threads are those of a rank.
  TileOptions tiles;
  // Bytes that this process may have resident, all told; 0: no limit.
  std::uint64_t memory = 0;
  // Where points go that do not fit, each rank's in a folder of its own that is removed in the end.
  std::filesystem::path scratch;
  bool to_disk = false;  // whether they go there even if they fit
  SinkDiskUse sink;      // for which there has to be room, too
  // Goes on from the last tile that an earlier run with the same `identity` finished and did not
  // live to tell. `identity` says what is triangulated: inputs, their sizes and ages, options.
  bool resume = false;
  // Whether an error in the last phase leaves the scratch folder, for `resume` to go on from.
  bool can_resume = true;
  std::string identity;
  // Told once, before the sink gets anything, which regions of tiles an earlier run has finished:
  // the sink had all of them and does not get them again. On every rank, of that rank's regions.
  std::function<void(const std::function<bool(std::uint64_t region)>& finished)> on_resume =
      nullptr;
  // Told by every rank once all points are counted, unless that was in an earlier run. Who throws
  // ends the run before points go anywhere.
  std::function<void(const PointsFound& points)> on_counted = nullptr;
  // Collective, once, after that and before the sink gets anything.
  std::function<void(comm::Communicator& communicator, const PointsFound& points)> on_points =
      nullptr;
  // Told after an error if `resume` can go on: what the sink has got must stay. On every rank.
  std::function<void()> on_keep = nullptr;
  Duplicates duplicates = Duplicates::first;              // in 2D, which z points in one place get
  std::uint64_t first_row = 0;                            // of the first point
  std::function<void(const std::string&)> say = nullptr;  // told what happens, by the first rank
};

// What triangulate_parts() has made, of all ranks.
struct PartsResult {
  int dim = 2;
  bool has_z = false;
  std::uint64_t points = 0, distinct = 0, simplices = 0, hull_facets = 0;
  Hash128 hash;
  std::vector<TileStatistics> tiles;
  TileStatistics shared;      // of what tiles leave to be put together
  int rounds = 0;             // of telling other ranks of points
  std::uint64_t scratch = 0;  // bytes that went to disk
  std::uint64_t resumed = 0;  // tiles that an earlier run had finished
  DuplicatesCount duplicates;
};

// Collective: the triangulation that triangulate() gives for all points, of which each rank reads
// its share of the parts. Every final simplex goes to the sink of one rank, if it has one. A region
// of tiles whose rests were put together has a number of its own, from the number of tiles on, and
// what is put together last, which is never resumed, one from twice that on.
//
// Errors, on all ranks: those of reading; std::invalid_argument for options that cannot be and
// coordinates that are not finite; FileError (memory) where memory does not do, as for points that
// are all on one circle or sphere, with the numbers; FileError (device) for a disk that is full, or
// a file in `scratch` that is not as it was written, by name; those of the sink;
// parallel::Interrupted. After an error within the last phase `resume` goes on.
PartsResult triangulate_parts(comm::Communicator& communicator, const PointParts& parts,
                              const PartsOptions& options, TileSink* sink);

}  // namespace delray::delaunay
