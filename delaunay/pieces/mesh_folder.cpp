// Reads mesh folders: each file below the descriptor of the folder, by a plain name, never through
// a link; its size is compared with its counts before anything is allocated for it.
#include "delaunay/mesh_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "delaunay/files/input.h"
#include "delaunay/pieces/piece_layout.h"
#include "files/read_file.h"

namespace delray::delaunay {
namespace {

using internal::PieceCodec;
using internal::PieceShape;

[[noreturn]] void fail_file(const std::string& name, const std::string& what) {
  throw files::FileError(files::Cause::input, name, "", what);
}

class FileSource : public internal::ByteSource {
 public:
  FileSource(int folder, const std::string& file, std::string name) : name_(std::move(name)) {
    descriptor_ = ::openat(folder, file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor_ < 0) {
      fail(errno == ELOOP ? "is a link, which pieces are not" : std::strerror(errno));
    }
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
      ::close(descriptor_);
      fail("is not a regular file");
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
    ::posix_fadvise(descriptor_, 0, 0, POSIX_FADV_SEQUENTIAL);
  }
  ~FileSource() override { ::close(descriptor_); }
  FileSource(const FileSource&) = delete;
  FileSource& operator=(const FileSource&) = delete;

  std::uint64_t size() const { return size_; }
  void read(std::span<char> bytes) override {
    while (!bytes.empty()) {
      const ssize_t got = ::read(descriptor_, bytes.data(), bytes.size());
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail(std::strerror(errno));
      if (got == 0) fail("ends too early");
      bytes = bytes.subspan(static_cast<std::size_t>(got));
      at_ += static_cast<std::uint64_t>(got);
    }
  }
  void expect(std::string_view bytes) override {
    std::array<char, 4096> block;
    while (!bytes.empty()) {
      const std::size_t n = std::min(block.size(), bytes.size());
      const std::uint64_t at = at_;
      read(std::span(block).first(n));
      const auto differs = std::mismatch(block.data(), block.data() + n, bytes.data()).first;
      if (differs != block.data() + n) {
        const auto byte = at + static_cast<std::uint64_t>(differs - block.data());
        throw files::FileError(files::Cause::input, name_, at_byte(byte),
                               "is not what a piece with these counts has there");
      }
      bytes.remove_prefix(n);
    }
  }
  [[noreturn]] void fail(const std::string& what) override { fail_file(name_, what); }

 private:
  std::string name_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0, at_ = 0;
};

void check_size(FileSource& source, const MeshPiece& entry, std::uint64_t bytes) {
  if (source.size() == bytes) return;
  source.fail("has " + std::to_string(source.size()) + " bytes; with " +
              std::to_string(entry.points) + " points and " + std::to_string(entry.simplices) +
              " simplices, as the index says, it would have " + std::to_string(bytes));
}

void check_content(const PieceMesh& mesh, const std::string& name) {
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const glm::dvec3& p = mesh.points[i].position;
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      throw files::FileError(files::Cause::input, name, "point " + std::to_string(i),
                             "not a finite number");
    }
  }
  const auto bad = std::ranges::find_if(
      mesh.simplices, [&](std::uint32_t corner) { return corner >= mesh.points.size(); });
  if (bad == mesh.simplices.end()) return;
  throw files::FileError(
      files::Cause::input, name, "corner " + std::to_string(bad - mesh.simplices.begin()),
      "is point " + std::to_string(*bad) + " of " + std::to_string(mesh.points.size()));
}

MeshIndex read_index(const std::filesystem::path& folder, const files::MemoryBudget& memory) {
  const std::filesystem::path path = folder / kMeshIndex;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(path, ignored))) {
    fail_file(folder.string(),
              "is a folder without " + std::string(kMeshIndex) + ", the index of a mesh in pieces");
  }
  const std::string text = files::read_file(path, memory);
  return parse_mesh_index({path.string(), text, memory});
}

constexpr std::array kFormats = {&internal::kVtuPieces, &internal::kPlyPieces};

}  // namespace

const internal::PieceCodec* internal::find_piece_codec(std::string_view name) {
  const auto found =
      std::ranges::find(kFormats, name, [](const PieceCodec* codec) { return codec->format.name; });
  return found == kFormats.end() ? nullptr : *found;
}

std::span<const PieceFormat> piece_formats() {
  static const std::array<PieceFormat, kFormats.size()> formats = {kFormats[0]->format,
                                                                   kFormats[1]->format};
  return formats;
}

bool is_mesh_folder(const std::filesystem::path& path) {
  std::error_code ignored;
  return path != "-" && std::filesystem::is_regular_file(
                            std::filesystem::symlink_status(path / kMeshIndex, ignored));
}

MeshFolder::MeshFolder(const std::filesystem::path& path, const files::MemoryBudget& memory)
    : path_(path), memory_(memory), index_(read_index(path, memory)) {
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) fail_file(path_.string(), std::strerror(errno));
}

MeshFolder::~MeshFolder() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::string MeshFolder::name(std::size_t piece) const {
  return (path_ / index_.pieces[piece].file).string();
}

void MeshFolder::check_sizes() const {
  const PieceCodec& codec = *internal::find_piece_codec(index_.format);
  for (std::size_t piece = 0; piece < index_.pieces.size(); ++piece) {
    const MeshPiece& entry = index_.pieces[piece];
    FileSource source(descriptor_, entry.file, name(piece));
    check_size(source, entry, codec.bytes({index_.dim, entry.points, entry.simplices}));
  }
}

void MeshFolder::read(std::size_t piece, PieceMesh& mesh) const {
  const MeshPiece& entry = index_.pieces[piece];
  const PieceCodec& codec = *internal::find_piece_codec(index_.format);
  const PieceShape shape{index_.dim, entry.points, entry.simplices};
  FileSource source(descriptor_, entry.file, name(piece));
  check_size(source, entry, codec.bytes(shape));
  const std::uint64_t needed = shape.points * sizeof(RowPoint) + shape.corners() * 4;
  const std::uint64_t held =
      mesh.points.capacity() * sizeof(RowPoint) + mesh.simplices.capacity() * 4;
  if (needed > held) memory_.require(needed - held, name(piece));
  mesh.points.resize(shape.points);
  mesh.simplices.resize(shape.corners());
  codec.read(source, shape, mesh.points, mesh.simplices);
  check_content(mesh, name(piece));
}

PointMesh read_mesh_folder(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  const MeshFolder folder(path, memory);
  const MeshIndex& index = folder.index();
  const std::uint64_t corners = index.simplices * (static_cast<std::uint64_t>(index.dim) + 1);
  // What the index says is believed of files that have the sizes for it.
  folder.check_sizes();
  std::uint64_t copies = 0, largest = 0;  // of points; bytes of a piece
  for (const MeshPiece& each : index.pieces) {
    copies += each.points;
    largest = std::max(largest, each.points * sizeof(RowPoint) +
                                    each.simplices * (static_cast<std::uint64_t>(index.dim) + 1) *
                                        sizeof(std::uint32_t));
  }
  memory.require(
      copies * (sizeof(RowPoint) + sizeof(glm::dvec3)) + corners * sizeof(std::uint32_t) + largest,
      path.string(), "all pieces in memory");
  std::vector<RowPoint> points;
  points.reserve(copies);
  PieceMesh piece;
  for (std::size_t i = 0; i < index.pieces.size(); ++i) {
    folder.read(i, piece);
    points.insert(points.end(), piece.points.begin(), piece.points.end());
  }
  std::ranges::sort(points, {}, &RowPoint::row);
  const auto same = [](const RowPoint& a, const RowPoint& b) { return a.row == b.row; };
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  if (points.size() > internal::kMostCorners) {
    fail_file(path.string(), "has more points than a mesh in memory may have");
  }
  PointMesh mesh;
  mesh.triangulation.dim = index.dim;
  mesh.triangulation.vertices.reserve(corners);
  for (std::size_t i = 0; i < index.pieces.size(); ++i) {
    folder.read(i, piece);
    for (const std::uint32_t corner : piece.simplices) {
      const auto at =
          std::ranges::lower_bound(points, piece.points[corner].row, {}, &RowPoint::row);
      mesh.triangulation.vertices.push_back(static_cast<std::uint32_t>(at - points.begin()));
    }
  }
  mesh.points.has_z = true;
  mesh.points.positions.reserve(points.size());
  for (const RowPoint& point : points) mesh.points.positions.push_back(point.position);
  return mesh;
}

}  // namespace delray::delaunay
