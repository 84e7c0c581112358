// Passes over a folder of pieces: which rows are corners, and of how many pieces; a sample of the
// points, as colours and the middle of a scene in memory are found by; the borders; and, piece by
// piece, triangles with the normals that the whole gives them.
#include "apps/pack/pack_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>

#include "apps/input/colour_by.h"
#include "apps/input/relief.h"
#include "apps/pack/piece_borders.h"
#include "apps/pack/placement.h"
#include "apps/pack/row_bits.h"
#include "delaunay/mesh_folder.h"
#include "files/error.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "scenes/complete_part.h"

namespace delray::apps {
namespace {

// For a triangle of a piece that becomes a part of a scene, its points and normals included;
// measured of scenes in memory.
constexpr std::uint64_t kBytesPerTriangle = 180;

class FolderPacker {
 public:
  FolderPacker(const SceneInput& input, parallel::Progress* progress)
      : input_(input),
        memory_(input.file.limits.budget()),
        folder_(input.file.path, memory_),
        index_(folder_.index()),
        progress_(progress) {
    folder_.check_sizes();  // so that the index can be believed
    std::uint64_t largest = 0;
    for (const delaunay::MeshPiece& piece : index_.pieces)
      largest = std::max(largest, piece.simplices * kBytesPerTriangle);
    memory_.require(largest + 4 * RowBits::bytes(index_.points), input.file.path,
                    "its largest piece");
    at_once_ = std::clamp<std::size_t>(memory_.left() / (2 * largest + 1), 1,
                                       static_cast<std::size_t>(parallel::arena_threads()));
    if (progress_ != nullptr) progress_->start(4 * index_.pieces.size());
  }

  void pack(packs::PackWriter& writer) {
    find_rows();
    place();
    find_borders();
    write(writer);
  }

 private:
  // Any thread, several pieces at a time.
  template <class F>
  void for_each_piece(F&& f) const {
    std::vector<delaunay::PieceMesh> pieces(at_once_);
    for (std::size_t first = 0; first < index_.pieces.size(); first += at_once_) {
      const std::size_t count = std::min(at_once_, index_.pieces.size() - first);
      parallel::parallel_for(0, count, 1, [&](std::size_t i) {
        folder_.read(first + i, pieces[i]);
        f(first + i, pieces[i]);
        if (progress_ != nullptr) progress_->advance();
      });
    }
  }

  void find_rows() {
    RowBits seen(index_.points);
    shared_.emplace(index_.points);
    std::mutex mutex;
    for_each_piece([&](std::size_t number, const delaunay::PieceMesh& piece) {
      geometry::Box3d box;
      for (std::size_t i = 0; i < piece.points.size(); ++i) {
        const delaunay::RowPoint& point = piece.points[i];
        if (point.row >= index_.points) {
          throw files::FileError(
              files::Cause::input, folder_.name(number), fmt::format("point {}", i),
              fmt::format("is row {} of {} of the index", point.row, index_.points));
        }
        if (seen.set(point.row)) shared_->set(point.row);
        box.include(point.position);
      }
      const std::lock_guard lock(mutex);
      box_.include(box);
    });
    vertices_ = seen.count();
    sample_points(seen);
  }

  // As usual_range of all vertices, in the order of their rows, takes them.
  void sample_points(const RowBits& rows) {
    const std::vector<std::uint64_t> sampled =
        rows.every(std::max<std::uint64_t>(1, vertices_ / kSampledValues));
    RowBits is_sampled(index_.points);
    for (const std::uint64_t row : sampled) is_sampled.set(row);
    sample_.has_z = true;
    sample_.positions.resize(sampled.size());
    for_each_piece([&](std::size_t, const delaunay::PieceMesh& piece) {
      for (const delaunay::RowPoint& point : piece.points) {
        if (!is_sampled.test(point.row)) continue;
        const auto place = std::ranges::lower_bound(sampled, point.row) - sampled.begin();
        // Pieces that have a point have it alike.
        const std::lock_guard lock(sample_mutex_);
        sample_.positions[static_cast<std::size_t>(place)] = point.position;
      }
    });
  }

  void place() {
    placement_ = place_points(input_, sample_, box_, vertices_,
                              [&](const glm::dvec3& scale, const geometry::Box3d& limits) {
                                return look_for_inliers(scale, limits);
                              });
    const geometry::Box3d& box = placement_.box;
    scenes::Scene& scene = placement_.scene;
    colouring_ = !input_.colour_by.empty() ? input_.colour_by
                 : box.low.z == box.high.z ? "simplex"
                                           : "z";
    if (colouring_ == "material") return;
    whiten(scene);
    if (colouring_ == "simplex") return;
    if (colouring_ != "z") {
      throw UsageError(
          fmt::format("--color-by {}: the points of a mesh in pieces have no such", colouring_));
    }
    const int up = placement_.up();
    heights_ = usual_range(sample_.size(), [&](std::size_t i) {
      return in_relief(sample_.positions[i], scene.origin, input_.exaggeration)[up];
    });
    scene.colour_scale = height_scale(heights_, scene.origin[up], input_.exaggeration);
  }

  Inliers look_for_inliers(const glm::dvec3& scale, const geometry::Box3d& limits) const {
    Inliers inliers;
    std::vector<std::uint64_t> outside;
    std::mutex mutex;
    for_each_piece([&](std::size_t, const delaunay::PieceMesh& piece) {
      geometry::Box3d box;
      std::vector<std::uint64_t> rows;
      for (const delaunay::RowPoint& point : piece.points) {
        const glm::dvec3 p = point.position * scale;
        if (is_within(p, limits))
          box.include(p);
        else
          rows.push_back(point.row);
      }
      const std::lock_guard lock(mutex);
      inliers.box.include(box);
      outside.insert(outside.end(), rows.begin(), rows.end());
    });
    std::ranges::sort(outside);
    inliers.outside =
        static_cast<std::size_t>(std::ranges::unique(outside).begin() - outside.begin());
    return inliers;
  }

  scenes::Mesh mesh_of(const delaunay::PieceMesh& piece) const {
    scenes::Mesh mesh;
    mesh.positions.reserve(piece.points.size());
    for (const delaunay::RowPoint& point : piece.points)
      mesh.positions.push_back(placement_(point.position));
    mesh.triangles.resize(piece.simplices.size() / 3);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      mesh.triangles[i] = from_lowest_row(
          {piece.simplices[3 * i], piece.simplices[3 * i + 1], piece.simplices[3 * i + 2]},
          [&](std::uint32_t point) { return piece.points[point].row; });
    }
    return mesh;
  }

  Places places_of(const delaunay::PieceMesh& piece, const scenes::Mesh& mesh) const {
    std::vector<std::uint8_t> shared(piece.points.size());
    for (std::size_t i = 0; i < shared.size(); ++i)
      shared[i] = shared_->test(piece.points[i].row) ? 1 : 0;
    return border_places(mesh.positions, shared);
  }

  void find_borders() {
    borders_.resize(index_.pieces.size());
    for_each_piece([&](std::size_t number, const delaunay::PieceMesh& piece) {
      const scenes::Mesh mesh = mesh_of(piece);
      borders_[number] = border_of(mesh, places_of(piece, mesh));
    });
  }

  void colour(std::uint64_t first, scenes::Mesh& mesh) const {
    if (colouring_ == "z") {
      const int up = placement_.up();
      std::vector<float> heights;
      heights.reserve(mesh.positions.size());
      for (const glm::vec3& p : mesh.positions) heights.push_back(p[up]);
      mesh.colours = height_colours(heights, heights_);
    } else if (colouring_ == "simplex") {
      colour_simplices(first, mesh);
    }
  }

  void write(packs::PackWriter& writer) {
    delaunay::PieceMesh piece;
    std::uint64_t first = 0;
    for (std::size_t number = 0; number < index_.pieces.size(); ++number) {
      memory_.require(index_.pieces[number].simplices * kBytesPerTriangle, folder_.name(number));
      folder_.read(number, piece);
      scenes::Mesh mesh = mesh_of(piece);
      const Places places = places_of(piece, mesh);
      const auto own = static_cast<std::uint32_t>(mesh.triangles.size());
      colour(first, mesh);
      const std::uint32_t before = add_neighbours(borders_, number, places, mesh);
      scenes::complete_part(mesh, before, own);
      writer.append_part(mesh);
      first += own;
      if (progress_ != nullptr) progress_->advance();
    }
    borders_ = {};
    writer.end_mesh(kReliefName, 0, vertices_);
    writer.commit(placement_.scene, false);
  }

  const SceneInput& input_;
  const files::MemoryBudget memory_;
  const delaunay::MeshFolder folder_;
  const delaunay::MeshIndex& index_;
  parallel::Progress* const progress_;
  std::size_t at_once_ = 1;  // pieces in memory

  std::optional<RowBits> shared_;  // rows that several pieces have
  std::uint64_t vertices_ = 0;     // rows that any has
  geometry::Box3d box_;            // of all points
  delaunay::PointCloud sample_;    // scaled by place()
  std::mutex sample_mutex_;
  Placement placement_;
  std::string colouring_;
  std::pair<float, float> heights_;  // that colours run between
  std::vector<PieceBorder> borders_;
};

}  // namespace

bool is_surface_in_pieces(const SceneInput& input) {
  if (input.file.is_set() || !delaunay::is_mesh_folder(input.file.path)) return false;
  const delaunay::MeshFolder folder(input.file.path, input.file.limits.budget());
  return folder.index().dim == 2 && folder.index().simplices > 0;
}

void pack_folder(const SceneInput& input, const std::string& output,
                 const packs::WriteOptions& options, parallel::Progress* progress) {
  refuse_options_of_points(input, InputKind::mesh);
  refuse_outside(input.file.path, input.file.limits);
  FolderPacker packer(input, progress);
  packs::PackWriter writer(output, options);
  packer.pack(writer);
}

}  // namespace delray::apps
