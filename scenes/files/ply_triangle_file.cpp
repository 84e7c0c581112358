// Binary PLY whose vertices have no lists and whose faces are all triangles: rows of one size, of
// which any run can be read.
#include <atomic>
#include <optional>

#include "parallel/parallel_for.h"
#include "scenes/files/ply_blocks.h"
#include "scenes/files/ply_faces.h"
#include "scenes/files/ply_texture.h"
#include "scenes/files/ply_vertices.h"
#include "scenes/files/triangle_file.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/origin.h"

namespace delray::scenes::internal {
namespace {

constexpr std::uint64_t kRowsPerBlock = 1 << 14;  // some hundred kilobytes

class PlyTriangleFile final : public TriangleFile {
 public:
  explicit PlyTriangleFile(const Source& source)
      : source_(source), bytes_(source.bytes()), header_(read_ply_header(source, bytes_, start_)) {}

  // Whether the file is one that can be read so.
  bool open() {
    if (file_.is_text() || header_.vertices >= kNone) return false;
    PlyBlocks blocks(file_);
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      if (element.name == "vertex") {
        if (reader_) return false;
        reader_.emplace(file_, element);
        if (!reader_->direct() || reader_->layout().stride == 0) return false;
        vertices_at_ = blocks.begin();
        const std::vector<PlyBlock> all = blocks.next(element);
        if (!is_whole(all, element.count, reader_->layout().stride)) return false;
        vertices_ = element.count;
      } else {
        // Behind lists there may be anything; only the last element may have them.
        faces_ = even_triangles(file_, element);
        if (!faces_ || &element != &header_.elements.back()) return false;
        const std::vector<PlyBlock> all = blocks.even(element);
        if (all.empty()) return false;
        faces_at_ = all.front().begin;
        row_bytes_ = all.front().bytes / all.front().rows;
        triangles_ = element.count;
      }
    }
    if (!reader_ || !faces_) return false;
    make_rest();
    return true;
  }

  bool read_triangles(std::uint64_t first, std::span<glm::uvec3> to) const override {
    std::atomic<bool> good{true};
    parallel::parallel_blocks(0, to.size(), kRowsPerBlock, [&](std::size_t begin, std::size_t end) {
      const PlyBlock block{faces_at_ + (first + begin) * row_bytes_, (end - begin) * row_bytes_,
                           first + begin, end - begin};
      if (!read_even_triangles(file_, *faces_, block, to.data() + begin)) good = false;
    });
    return good;
  }

  Mesh read_vertices(std::uint64_t first, std::uint64_t last) const override {
    Mesh mesh;
    std::vector<glm::dvec3> places;
    reader_->allocate(last - first, mesh, places);
    const std::uint64_t stride = reader_->layout().stride;
    parallel::parallel_blocks(first, last, kRowsPerBlock, [&](std::size_t begin, std::size_t end) {
      const PlyBlock block{vertices_at_ + begin * stride, (end - begin) * stride, begin,
                           end - begin};
      reader_->read(block, begin - first, mesh, places);
    });
    return mesh;
  }

  std::optional<glm::dvec3> origin(const geometry::Box3d& all,
                                   const geometry::Box3d&) const override {
    return origin_of(all);
  }
  void warn(const geometry::Box3d& all) const override {
    warn_if_coarse(source_, reach_of(all), glm::length(all.size()));
  }

 private:
  static bool is_whole(const std::vector<PlyBlock>& blocks, std::uint64_t rows,
                       std::uint64_t stride) {
    std::uint64_t bytes = 0;
    for (const PlyBlock& block : blocks) bytes += block.bytes;
    return bytes == rows * stride;
  }

  void make_rest() {
    Mesh mesh = read_vertices(0, 0);
    if (reader_->layout().colours()) mesh.colours.resize(1);  // so that its material is white
    rest_ = scene_of(std::move(mesh), glm::dvec3(0));
    rest_.meshes[0].colours.clear();
    if (reader_->layout().uvs()) add_ply_texture(source_, header_, rest_);
  }

  const Source& source_;
  files::FileBytes bytes_;
  std::string start_;
  PlyHeader header_;
  PlyFile file_{source_, bytes_, header_};
  std::optional<PlyVertexReader> reader_;
  std::optional<EvenTriangles> faces_;
  std::uint64_t vertices_at_ = 0, faces_at_ = 0, row_bytes_ = 0;
};

}  // namespace

std::unique_ptr<TriangleFile> open_ply_triangles(const Source& source) {
  auto file = std::make_unique<PlyTriangleFile>(source);
  if (!file->open()) return nullptr;
  return file;
}

}  // namespace delray::scenes::internal
