// Triangulations of any size: a folder with a piece for each tile, and an index.
//
// `mesh.json` is the index. Pieces are either VTU files, with `mesh.pvtu` beside them, which
// ParaView opens, or binary PLY files. Every piece stands for itself: it has the points that its
// simplices have as corners, each with its row of the whole input, in 64 bits (VTU: "row", the
// global identifiers of VTK; PLY: row_low and row_high, its two halves).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "delaunay/read_mesh.h"
#include "delaunay/tile_sink.h"
#include "files/memory_budget.h"
#include "geometry/box.h"

namespace delray::delaunay {

struct Input;

inline constexpr std::string_view kMeshIndex = "mesh.json";

// An entry of the index.
struct MeshPiece {
  std::string file;  // a name in the folder
  std::uint64_t tile = 0, points = 0, simplices = 0;
  geometry::Box3d box;  // of its points
  Hash128 hash;         // of its simplices
};

// What the index says.
struct MeshIndex {
  std::string format;  // of piece_formats()
  int dim = 2;
  std::uint64_t points = 0;  // of the input
  std::uint64_t distinct = 0, simplices = 0, hull_facets = 0;
  Hash128 hash;
  std::vector<MeshPiece> pieces;  // by ascending tiles

  geometry::Box3d box() const;
};

// A kind of pieces.
struct PieceFormat {
  std::string_view name;         // "vtu"
  std::string_view description;  // one line
  bool tetrahedra;               // otherwise of triangles only
};
std::span<const PieceFormat> piece_formats();

// The content of a piece.
struct PieceMesh {
  std::vector<RowPoint> points;
  std::vector<std::uint32_t> simplices;  // dim + 1 indices of `points` each
};

// Throws FileError (input) for anything but an index as MeshFolderWriter writes it: counts that do
// not add up, names that are not those of files in the folder itself.
MeshIndex parse_mesh_index(const Input& input);

// Whether it is a folder with an index.
bool is_mesh_folder(const std::filesystem::path& path);

// A mesh folder that is read piece by piece.
class MeshFolder {
 public:
  // Throws FileError (input) if there is no index or it is broken.
  explicit MeshFolder(const std::filesystem::path& path, const files::MemoryBudget& memory = {});
  ~MeshFolder();
  MeshFolder(const MeshFolder&) = delete;
  MeshFolder& operator=(const MeshFolder&) = delete;

  const MeshIndex& index() const { return index_; }
  // Replaces `mesh` by a piece. Any thread. Only files of the folder itself are opened, no links.
  // Throws FileError (input) if it is not what the index says, byte for byte of what is not points
  // and corners, if a coordinate is not finite or a corner is not one of its points; FileError
  // (memory). REQUIRES: piece < index().pieces.size().
  void read(std::size_t piece, PieceMesh& mesh) const;
  // Throws FileError (input) unless each piece has the size that the index says. Opens all of them.
  void check_sizes() const;
  // A piece by its file, for messages.
  std::string name(std::size_t piece) const;

 private:
  std::filesystem::path path_;
  files::MemoryBudget memory_;
  int descriptor_ = -1;
  MeshIndex index_;
};

// A whole folder in memory, vertices in the order of their rows and numbered by it.
PointMesh read_mesh_folder(const std::filesystem::path& path,
                           const files::MemoryBudget& memory = {});

// How a folder is written.
struct MeshFolderOptions {
  int dim = 2;
  std::string format = "vtu";  // of piece_formats()
  // Pieces that an unfinished run left stay; keep_tiles() chooses among them.
  bool resume = false;
  // Of several processes that write one folder, each with tiles of its own: 0 makes the folder
  // before the others begin, and commits it when they have ended.
  int writer = 0;
};

// Writes the folder, which appears whole or not at all (files::AtomicFolder).
class MeshFolderWriter : public TileSink {
 public:
  static constexpr std::uint64_t kBytesOfThread = std::uint64_t{16} << 20;  // that take()s

  // Throws FileError (device); std::invalid_argument for a format that does not exist or does not
  // hold simplices of that dimension.
  MeshFolderWriter(const std::filesystem::path& path, const MeshFolderOptions& options);
  ~MeshFolderWriter() override;

  // Bytes of all pieces for each point, as uniform points have them.
  static std::uint64_t bytes_of_point(const std::string& format, int dim);

  // A file for the piece, written in large blocks by the calling thread; points that no simplex has
  // are left out. Nothing for a piece without simplices.
  void take(const TilePiece& piece) override;

  // Of the pieces that this writer left in an unfinished run keeps those whose tile `finished` says
  // yes to, and removes the others. For a resumed folder, before the first take().
  void keep_tiles(const std::function<bool(std::uint64_t tile)>& finished);
  // What has been written stays for a run that resumes it, should this one not end well.
  void keep_unfinished();

  // What other writers than 0 have written, for add_pieces() of that one. Not while others take().
  std::string pieces() const;
  void add_pieces(const std::string& pieces);

  // What all pieces have together, so far. Not while others take().
  std::uint64_t simplices() const;
  Hash128 hash() const;

  // Writes the index, and gives the folder its name. Simplices and hash are those of its pieces.
  struct Counts {
    std::uint64_t points = 0;  // of the input
    std::uint64_t distinct = 0, hull_facets = 0;
    // Of the simplices, where it is known: pieces that do not have it are FileError (device).
    std::optional<Hash128> hash = std::nullopt;
  };
  void commit(const Counts& counts);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Whether a path that is to be written means a folder: it ends in a slash, or a folder is there.
bool names_folder(const std::filesystem::path& path);

}  // namespace delray::delaunay
