// Simplices wait in buckets by runs of rows until all are there.
#include "delaunay/mesh_file_writer.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>
#include <vector>

#include "delaunay/files/mesh_layout.h"
#include "delaunay/pieces/piece_layout.h"
#include "delaunay/pieces/sort_simplices.h"
#include "delaunay/pieces/write_mesh_file.h"

namespace delray::delaunay {
namespace {

constexpr std::size_t kSlice = std::size_t{1} << 17;        // simplices that take() sorts at a time
constexpr std::uint64_t kFewRows = std::uint64_t{1} << 14;  // of a bucket
constexpr std::uint64_t kManyBuckets = 256;

// Of a bucket while it is sorted: random rows have up to 6 simplices in the plane, and 27 in space,
// of which they are the lowest.
std::uint64_t bytes_of_row(int dim) { return dim == 2 ? 256 : 1024; }

std::uint64_t rows_of_bucket(const MeshFileOptions& options) {
  const auto threads = static_cast<std::uint64_t>(std::max(1, options.threads * options.ranks));
  const std::uint64_t share = options.memory / 4 / threads;
  const std::uint64_t most = std::max(kFewRows / 16, share / bytes_of_row(options.dim));
  return std::min(std::max(options.points / kManyBuckets + 1, kFewRows), most);
}

}  // namespace

struct MeshFileWriter::State : internal::MeshFileState {
  State(const std::filesystem::path& path, const MeshFileOptions& given)
      : State(path, given, rows_of_bucket(given)) {}
  State(const std::filesystem::path& path, const MeshFileOptions& given, std::uint64_t rows)
      : internal::MeshFileState{given,
                                mesh_writer_for(path),
                                rows,
                                {given.points / rows + 1, given.scratch},
                                {given.points / rows + 1, given.scratch},
                                {path, given.writer == 0}},
        corners(static_cast<std::size_t>(given.dim) + 1) {}

  template <std::size_t Corners>
  void take(const TilePiece& piece, std::size_t first, std::size_t last);

  std::size_t corners;
};

// Sorts simplices by buckets first, so that each bucket is asked for once.
template <std::size_t Corners>
void MeshFileWriter::State::take(const TilePiece& piece, std::size_t first, std::size_t last) {
  using Simplex = std::array<std::uint32_t, Corners>;
  std::vector<Simplex> given(last - first), sorted(last - first);
  std::vector<std::uint32_t> bucket_of(last - first), ends(simplices.size() + 1);
  for (std::size_t i = 0; i < given.size(); ++i) {
    for (std::size_t k = 0; k < Corners; ++k) {
      const std::uint64_t row = piece.points[piece.simplices[(first + i) * Corners + k]].row;
      assert(row < options.points);
      given[i][k] = static_cast<std::uint32_t>(row);
    }
    internal::turn_to_lowest(given[i]);
    bucket_of[i] = static_cast<std::uint32_t>(given[i][0] / bucket_rows);
    ++ends[bucket_of[i]];
  }
  std::uint32_t sum = 0;
  for (std::uint32_t& end : ends) sum += std::exchange(end, sum);
  for (std::size_t i = 0; i < given.size(); ++i) sorted[ends[bucket_of[i]]++] = given[i];
  std::size_t at = 0;
  for (std::size_t bucket = 0; bucket < simplices.size(); ++bucket) {
    const std::size_t end = ends[bucket];
    if (end > at) simplices.add(bucket, std::as_bytes(std::span(sorted).subspan(at, end - at)));
    at = end;
  }
}

bool can_write_in_parts(const std::filesystem::path& path, int dim) {
  const MeshWriter& writer = mesh_writer_for(path);
  return writer.layout != nullptr && (dim == 2 || writer.tetrahedra);
}

MeshFileBytes mesh_file_bytes_of_point(const std::filesystem::path& path, int dim) {
  MeshFileBytes bytes;
  const auto corners = static_cast<std::uint64_t>(dim) + 1;
  MeshShape shape;
  shape.simplices = internal::simplices_of_point(dim);
  shape.points = 1;
  shape.corners = dim + 1;
  for (const MeshArray& array : mesh_writer_for(path).layout(shape).arrays) {
    bytes.file += array.row_bytes * (array.of_points ? 1 : shape.simplices);
  }
  bytes.scratch = shape.simplices * corners * sizeof(std::uint32_t);
  return bytes;
}

MeshFileWriter::MeshFileWriter(const std::filesystem::path& path, const MeshFileOptions& options)
    : state_(std::make_unique<State>(path, options)) {
  assert(can_write_in_parts(path, options.dim) && options.points <= MeshFileOptions::kMostPoints);
}
MeshFileWriter::~MeshFileWriter() = default;

void MeshFileWriter::take(const TilePiece& piece) {
  const std::size_t n = piece.simplices.size() / state_->corners;
  for (std::size_t first = 0; first < n; first += kSlice) {
    const std::size_t last = std::min(n, first + kSlice);
    if (state_->corners == 3) {
      state_->take<3>(piece, first, last);
    } else {
      state_->take<4>(piece, first, last);
    }
  }
}

void MeshFileWriter::take_heights(std::span<const RowPoint> points) {
  for (const RowPoint& point : points) {
    const internal::RowHeight height{point.row, point.position.z};
    state_->heights.add(point.row / state_->bucket_rows, std::as_bytes(std::span(&height, 1)));
  }
}

void MeshFileWriter::write(comm::Communicator& communicator, const Source& source) {
  internal::write_mesh_file(communicator, *state_, source);
}

void MeshFileWriter::commit() { state_->target.commit(); }

}  // namespace delray::delaunay
