// The second half of writing a large mesh in one file, when all simplices are there.
#pragma once

#include <cstdint>

#include "comm/communicator.h"
#include "delaunay/mesh_file_writer.h"
#include "delaunay/pieces/mesh_file_target.h"
#include "delaunay/pieces/row_buckets.h"
#include "delaunay/write_mesh.h"

namespace delray::delaunay::internal {

// A height that a row has instead of its own.
struct RowHeight {
  std::uint64_t row;
  double z;
};

// What a writer has.
struct MeshFileState {
  MeshFileOptions options;
  const MeshWriter& writer;
  std::uint64_t bucket_rows;  // of each bucket
  RowBuckets simplices;       // dim + 1 rows each, turned to the lowest
  RowBuckets heights;         // of RowHeight
  MeshFileTarget target;
};

// Collective: MeshFileWriter::write().
void write_mesh_file(comm::Communicator& communicator, MeshFileState& state,
                     const MeshFileWriter::Source& source);

}  // namespace delray::delaunay::internal
