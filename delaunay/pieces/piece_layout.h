// The formats of pieces: texts and arrays of numbers in one fixed order, so that a reader knows
// from the counts where each byte has to be.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "delaunay/mesh_folder.h"

namespace delray::delaunay::internal {

struct PieceShape {
  int dim = 2;
  std::uint64_t points = 0, simplices = 0;
  std::uint64_t corners() const { return simplices * (static_cast<std::uint64_t>(dim) + 1); }
};

// Of uniform points, about.
constexpr std::uint64_t simplices_of_point(int dim) { return dim == 2 ? 2 : 7; }

// Pieces have signed indices of 32 bits.
inline constexpr std::uint64_t kMostCorners = (std::uint64_t{1} << 31) - 1;

// Where bytes go: may be called often, with few bytes.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  virtual void write(std::string_view bytes) = 0;
};

// Where they come from, in order.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  // Fills `bytes`. Throws FileError (input) where the file ends before.
  virtual void read(std::span<char> bytes) = 0;
  // Reads as many bytes, which must be these: throws FileError (input) otherwise.
  virtual void expect(std::string_view bytes) = 0;
  // Throws FileError (input).
  [[noreturn]] virtual void fail(const std::string& what) = 0;
};

// Writes, and reads back, the files of one format.
struct PieceCodec {
  PieceFormat format;
  std::string_view suffix;
  std::uint64_t (*bytes)(const PieceShape& shape);  // of the whole file
  void (*write)(ByteSink& sink, const PieceShape& shape, std::span<const RowPoint> points,
                std::span<const std::uint32_t> corners);
  // Into spans of the right size; coordinates and corners may be anything.
  void (*read)(ByteSource& source, const PieceShape& shape, std::span<RowPoint> points,
               std::span<std::uint32_t> corners);
  // A further file of the folder that names all pieces, and its content; none if empty.
  std::string_view summary;
  std::string (*write_summary)(const MeshIndex& index);
};

// None if there is no such format.
const PieceCodec* find_piece_codec(std::string_view name);

extern const PieceCodec kVtuPieces, kPlyPieces;

}  // namespace delray::delaunay::internal
