// What `triangulate` writes: a mesh in one file, a folder of pieces, or a raster of heights.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "apps/input/point_input.h"
#include "apps/statistics.h"
#include "comm/communicator.h"
#include "delaunay/mesh_file_writer.h"
#include "delaunay/mesh_folder.h"
#include "delaunay/points.h"
#include "delaunay/tile_sink.h"
#include "delaunay/triangulation.h"
#include "files/coordinate_system.h"
#include "geometry/box.h"

namespace CLI {
class App;
}

namespace delray::apps {

enum class OutputKind : std::uint8_t { none, file, folder, raster };

// -o and what belongs to it.
struct TriangulationOutput {
  std::string path;
  std::string pieces;       // empty: vtu
  std::string interpolate;  // empty: linear
  double cell_size = 0;     // of the raster

  OutputKind kind() const;
  // Whether simplices can go there as soon as they are final: to any folder and raster, and to
  // files whose format allows that.
  bool takes_parts(int dim) const;
  // What it takes on disk where it does, but for rasters.
  delaunay::SinkDiskUse disk_use(int dim) const;
};

// Adds -o, --pieces and --interpolate.
void add_output_options(CLI::App& command, TriangulationOutput& output);

// Throws UsageError for what does not go together. Takes --cell-size from the input, where it is
// that of elevation pictures, for a raster.
void check_output(TriangulationOutput& output, PointInput& input, int dim);
// Throws the FileError of an output that cannot be written, and UsageError if it is an input.
void check_output_paths(const TriangulationOutput& output, const std::string& statistics,
                        const std::vector<std::string>& inputs);

// Throws what write_triangulation() would, as far as points tell: UsageError, FileError.
void check_output_of(const TriangulationOutput& output, const PointInput& input,
                     const delaunay::PointCloud& points);

// Where simplices go as soon as they are final: the folder, the raster or the file.
class SimplexOutput {
 public:
  virtual ~SimplexOutput() = default;
  virtual delaunay::TileSink& sink() = 0;
  // As of delaunay::MeshFolderWriter; a raster has nothing to go on from.
  virtual void keep_tiles(const std::function<bool(std::uint64_t tile)>& finished) = 0;
  virtual void keep_unfinished() = 0;
  // From another process to that of rank 0, which takes it all in.
  virtual void send_to_first(comm::Communicator& communicator) = 0;
  virtual void receive(comm::Communicator& communicator, int from) = 0;
  // Collective, of all ranks, threads or processes, after that: what they write together.
  virtual void write(comm::Communicator& /*communicator*/,
                     const delaunay::MeshFileWriter::Source& /*points*/) {}
  // Completes what is written; a raster is written here, from its blocks. The statistics of it, or
  // null.
  virtual Json commit(const delaunay::MeshFolderWriter::Counts& counts) = 0;
};

// What an output is to know before the first simplex.
struct OutputFacts {
  int dim = 2;
  geometry::Box3d box;                    // of the points
  std::optional<geometry::Box3d> bounds;  // of the raster; none: those of the points
  files::CoordinateSystem coordinate_system;
  std::uint64_t memory = std::uint64_t{256} << 20;  // for blocks of a raster
  std::string scratch;                              // a folder for others; empty: the system's
  delaunay::MeshFileOptions file;  // of a mesh in one file; its numbers are those of the points
  bool resume = false;
  int writer = 0;  // of several processes
};

// REQUIRES: the output takes parts. Throws FileError and UsageError.
std::unique_ptr<SimplexOutput> open_simplex_output(const TriangulationOutput& output,
                                                   const OutputFacts& facts);

// Writes a triangulation in memory to whatever the output is; nothing for none. What statistics say
// of it, or null. In parallel in the caller's arena.
Json write_triangulation(const TriangulationOutput& output, const PointInput& input,
                         const delaunay::PointCloud& points, const delaunay::Triangulation& result,
                         std::span<const std::uint16_t> created_by);

}  // namespace delray::apps
