// Pieces as binary PLY files (Turk 1994). PLY has integers of 32 bits at most: a row is two of
// them. A vertex takes the bytes that it has in memory.
#include <algorithm>
#include <bit>
#include <cstring>

#include "delaunay/pieces/piece_layout.h"
#include "files/format.h"

namespace delray::delaunay::internal {
namespace {

static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(RowPoint) == 32 && offsetof(RowPoint, row) == 24);

constexpr std::size_t kFaceBytes = 13;       // how many corners, and these
constexpr std::size_t kFacesAtOnce = 16384;  // faces that are converted: 200 kB

std::string ply_header(const PieceShape& shape) {
  return "ply\nformat binary_little_endian 1.0\ncomment " + std::string(files::kWrittenByDelray) +
         "\nelement vertex " + std::to_string(shape.points) +
         "\nproperty double x\nproperty double y\nproperty double z\n"
         "property uint row_low\nproperty uint row_high\nelement face " +
         std::to_string(shape.simplices) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::uint64_t ply_bytes(const PieceShape& shape) {
  return ply_header(shape).size() + shape.points * sizeof(RowPoint) + shape.simplices * kFaceBytes;
}

void write_ply_piece(ByteSink& sink, const PieceShape& shape, std::span<const RowPoint> points,
                     std::span<const std::uint32_t> corners) {
  sink.write(ply_header(shape));
  sink.write({reinterpret_cast<const char*>(points.data()), points.size_bytes()});
  std::string faces(kFacesAtOnce * kFaceBytes, '\3');
  for (std::size_t first = 0; first < shape.simplices; first += kFacesAtOnce) {
    const std::size_t n = std::min<std::size_t>(kFacesAtOnce, shape.simplices - first);
    for (std::size_t i = 0; i < n; ++i) {
      std::memcpy(faces.data() + i * kFaceBytes + 1, &corners[(first + i) * 3], kFaceBytes - 1);
    }
    sink.write(std::string_view(faces).substr(0, n * kFaceBytes));
  }
}

void read_ply_piece(ByteSource& source, const PieceShape& shape, std::span<RowPoint> points,
                    std::span<std::uint32_t> corners) {
  source.expect(ply_header(shape));
  source.read({reinterpret_cast<char*>(points.data()), points.size_bytes()});
  std::string faces(std::min<std::size_t>(kFacesAtOnce, shape.simplices) * kFaceBytes, '\0');
  for (std::size_t first = 0; first < shape.simplices; first += kFacesAtOnce) {
    const std::size_t n = std::min<std::size_t>(kFacesAtOnce, shape.simplices - first);
    source.read(std::span(faces).first(n * kFaceBytes));
    for (std::size_t i = 0; i < n; ++i) {
      const char* face = faces.data() + i * kFaceBytes;
      if (*face != '\3') source.fail("face " + std::to_string(first + i) + " is no triangle");
      std::memcpy(&corners[(first + i) * 3], face + 1, kFaceBytes - 1);
    }
  }
}

}  // namespace

const PieceCodec kPlyPieces = {{"ply", "binary PLY pieces, of triangles", false},
                               ".ply",
                               &ply_bytes,
                               &write_ply_piece,
                               &read_ply_piece,
                               "",
                               nullptr};

}  // namespace delray::delaunay::internal
