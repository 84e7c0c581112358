// Triangulations that memory need not hold, by one process or by all ranks.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "apps/input/point_input.h"
#include "apps/launch.h"
#include "apps/output/ranks_output.h"
#include "apps/session.h"
#include "apps/statistics.h"
#include "delaunay/triangulate_parts.h"

namespace CLI {
class App;
}

namespace delray::apps {

// How points are cut into tiles, and where they wait.
struct TilesChoice {
  int tiles = 0;        // 0: none were asked for
  std::string scratch;  // empty: none was named
  bool resume = false;

  bool given() const { return tiles > 0 || !scratch.empty() || resume; }
};

// Adds --tiles, --scratch and --resume.
void add_tiles_options(CLI::App& command, TilesChoice& choice);

// The folder for scratch files: the one that was named, that of the output, or the system's.
std::string scratch_folder(const TilesChoice& choice, const std::string& output);

// Throws FileError (device) where a folder was named that is not there.
void check_scratch(const TilesChoice& choice);

// What an input needs in memory to be triangulated in one piece, if that is more than it may have;
// otherwise 0. As a rule without reading it.
std::uint64_t memory_beyond_limit(const PointInput& input, int dim);

// What was made, and how long it took.
struct PartsMade {
  delaunay::PartsResult result;
  int ranks = 1;
  double seconds = 0, write = 0;  // of both together; to complete the output after that
  Json output;                    // what statistics say of it, or null
};

// What is triangulated, and how.
struct PartsTask {
  const PointInput& input;
  const Launch& launch;
  delaunay::Options how;
  TilesChoice tiles;
  std::string output;               // beside which scratch files may go; may be empty
  RanksOutput* to = nullptr;        // where simplices go; null: nowhere
  std::uint64_t kept_free = 0;      // of --memory, for what `to` takes
  delaunay::SinkDiskUse disk = {};  // of `to`
};

// Runs all ranks; `done` is called on rank 0 within their run. Throws what triangulate_parts()
// does.
void triangulate_in_parts(Session& session, const PartsTask& task,
                          const std::function<void(const PartsMade&)>& done);

Json tiles_json(const delaunay::PartsResult& result);

}  // namespace delray::apps
