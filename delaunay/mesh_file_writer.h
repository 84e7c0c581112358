// A triangulation of which memory holds little at a time, in one file: PLY or VTU.
//
// Such a file has all points in the order of their rows, then all simplices. These come in any
// order, so they wait on disk, by runs of the rows of their lowest vertices, and are sorted when
// all are there: each begins with its lowest row (a tetrahedron goes on with its next lowest), and
// they ascend. So the file is the same for every number of tiles, ranks and threads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/point_parts.h"
#include "delaunay/tile_sink.h"
#include "delaunay/triangulate_parts.h"
#include "parallel/progress.h"

namespace delray::delaunay {

// Whether simplices of that dimension can be written to such a path by MeshFileWriter; "-" is
// standard output, as PLY. PLY has no tetrahedra.
bool can_write_in_parts(const std::filesystem::path& path, int dim);

// Bytes of such a file for each point, as uniform points have them, and what waits on disk besides.
struct MeshFileBytes {
  std::uint64_t file = 0, scratch = 0;
};
MeshFileBytes mesh_file_bytes_of_point(const std::filesystem::path& path, int dim);

// How a file is written.
struct MeshFileOptions {
  static constexpr std::uint64_t kMostPoints = 0xffffffff;  // vertices have 32 bits

  int dim = 2;
  std::uint64_t points = 0;  // rows are below
  bool has_z = false;
  PointAttributes attributes;                // that the file gets, where its format has them
  std::filesystem::path scratch;             // the folder of what waits
  std::uint64_t memory = ~std::uint64_t{0};  // bytes that may be resident
  int threads = 1;                           // of each rank that calls write()
  int ranks = 1;                             // of this process
  // Of several processes that write one file, each with simplices of its own: 0 makes it.
  int writer = 0;
  parallel::Progress* progress = nullptr;  // may stop write()
};

// Writes the file, which appears whole or not at all (files::AtomicFile).
class MeshFileWriter : public TileSink {
 public:
  static constexpr std::uint64_t kBytesOfThread = std::uint64_t{16} << 20;  // that take()s

  // Throws FileError (device). REQUIRES: can_write_in_parts(); points <= kMostPoints.
  MeshFileWriter(const std::filesystem::path& path, const MeshFileOptions& options);
  ~MeshFileWriter() override;

  void take(const TilePiece& piece) override;
  void take_heights(std::span<const RowPoint> points) override;

  // Points as a rank reads them again: its share of the parts.
  struct Source {
    const PointParts& parts;
    PartRows rows;
    bool is_shared = true;  // whether ranks have one writer, as threads have; else each its own
  };
  // Collective, after the last take(): writes points and simplices, each rank a share of them; the
  // first rank all of them to a stream, which comes in its order. Memory: some of the runs that
  // simplices wait in, a part of the points for each thread. O(n). Throws FileError: device; memory
  // where one of the runs has too many simplices. Throws parallel::Interrupted.
  void write(comm::Communicator& communicator, const Source& source);
  // Gives the file its name. Writer 0 only, after write().
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace delray::delaunay
