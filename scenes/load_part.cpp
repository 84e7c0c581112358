// Every rank reads its run of triangles with their vertices, and looks at an equal part of all
// vertices; what load() decides by the whole scene (origin, order, axes, normals that are missing)
// is agreed on by sums and boxes over all ranks.
//
// Runs begin at multiples of those that order_for_locality measures; where triangles are dropped,
// ranks read again from where that is so. Normals are made from the rank's triangles and those of
// other ranks around its vertices, in the order of the whole mesh, so that sums have the same bits.
// Whatever is wrong, or would be done otherwise, ends with nothing on all ranks.
#include "scenes/load_part.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "files/format.h"
#include "files/read_file.h"
#include "parallel/parallel_for.h"
#include "scenes/files/finish.h"
#include "scenes/files/triangle_file.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/order.h"
#include "scenes/geometry/origin.h"
#include "scenes/geometry/up_axis.h"
#include "scenes/parts/border_triangles.h"
#include "scenes/parts/read_run.h"

namespace delray::scenes {
namespace {

using files::Format;
using internal::Source;
using internal::TriangleFile;

constexpr std::size_t kTrianglesAtOnce = 1 << 14;  // triangles: tens of microseconds

template <class T>
geometry::Box<T> of_all(comm::Communicator& communicator, const geometry::Box<T>& box) {
  return comm::all_reduce_value(communicator, box,
                                [](geometry::Box<T> a, const geometry::Box<T>& b) {
                                  a.include(b);
                                  return a;
                                });
}

// What there is to know of the vertices of a file.
struct VertexFacts {
  geometry::Box3d box;
  // Whether all directions have a length; if not, there are none (normalize_or_clear).
  bool normals = true, tangents = true;
};

template <class T>
bool have_length(std::vector<T> directions) {
  const bool any = !directions.empty();
  internal::normalize_or_clear(directions);
  return any == !directions.empty();
}

// Whether what a material needs of the whole mesh are no more than normals.
bool is_simple(const Material& material, const Mesh& mesh) {
  const bool glows = glm::any(glm::greaterThan(material.emission, glm::vec3(0)));
  return !glows && (material.normal_texture == kNone || !mesh.tangents.empty());
}

class PartLoader {
 public:
  PartLoader(comm::Communicator& communicator, const Source& source)
      : communicator_(communicator),
        source_(source),
        rank_(static_cast<std::uint64_t>(communicator.rank())),
        ranks_(static_cast<std::uint64_t>(communicator.size())) {}

  std::optional<ScenePart> run() {
    const bool found = all_agree([&] { return open(); });
    if (!found) return std::nullopt;
    if (!all_agree([&] { return look_at_vertices(); })) return std::nullopt;
    facts_.box = of_all(communicator_, facts_.box);
    facts_.normals = agreed(facts_.normals);
    facts_.tangents = agreed(facts_.tangents);

    std::uint64_t begin = boundary(rank_), end = boundary(rank_ + 1);
    if (!all_agree([&] { return read(begin, end); }) || !place()) return std::nullopt;
    std::uint64_t dropped = drop_degenerate(), first = begin;
    const std::uint64_t all_dropped = comm::all_reduce_value(communicator_, dropped, std::plus<>());
    if (all_dropped > 0) {
      const std::optional<std::uint64_t> moved = move_begin(begin, end);
      if (!moved) return std::nullopt;
      first = *moved;
      if (!all_agree([&] { return read(begin, end); }) || !place()) return std::nullopt;
      drop_degenerate();
      source_.warn(std::to_string(all_dropped) +
                   " triangles with two corners in one place left out");
    }
    const std::uint64_t triangles = file_->triangles() - all_dropped;
    if (!is_ordered()) return std::nullopt;
    find_up();
    add_normals(first);
    if (!all_agree([&] { return is_simple(material(), mesh()); })) return std::nullopt;
    file_->warn(facts_.box);
    return ScenePart{std::move(scene_), static_cast<std::uint32_t>(first), triangles,
                     file_->vertices()};
  }

 private:
  Mesh& mesh() { return scene_.meshes[0]; }
  const Material& material() const { return scene_.materials[scene_.meshes[0].material]; }

  bool agreed(bool mine) {
    return comm::all_reduce_value(communicator_, std::uint8_t{mine},
                                  [](auto a, auto b) { return std::min(a, b); }) != 0;
  }
  // Whether f() on all ranks, where what is wrong with the file counts as false. Throws what all
  // ranks throw.
  template <class F>
  bool all_agree(F&& f) {
    const bool mine = comm::all_or_none(communicator_, comm::Phase::load, [&] {
      try {
        return f();
      } catch (const files::FileError& error) {
        if (error.cause() == files::Cause::memory) throw;
        return false;
      }
    });
    return agreed(mine);
  }

  std::uint64_t boundary(std::uint64_t rank) const {
    const std::uint64_t all = file_->triangles();
    if (rank == ranks_) return all;
    return all * rank / ranks_ / internal::kTrianglesOfRun * internal::kTrianglesOfRun;
  }

  bool open() {
    if (files::is_stream(source_.path)) return false;
    constexpr std::size_t kFirstBytes = std::size_t{1} << 20;  // enough to know any format by
    start_ = files::read_start(source_.path, kFirstBytes, source_.memory);
    const Format format = files::identify(start_, source_.bytes().size(), source_.path).format;
    is_gltf_ = format == Format::gltf || format == Format::glb;
    if (is_gltf_) {
      file_ = internal::open_gltf_triangles(source_);
    } else if (format == Format::ply) {
      file_ = internal::open_ply_triangles(source_);
    }
    if (file_ == nullptr || file_->vertices() >= kNone || file_->triangles() >= kNone ||
        file_->triangles() < kLeastTrianglesOfPart * ranks_) {
      return false;
    }
    scene_ = file_->rest();
    return std::ranges::all_of(scene_.materials, [](const Material& m) {
      return !glm::any(glm::greaterThan(m.emission, glm::vec3(0)));
    });
  }

  // This rank's n-th of all vertices, whether triangles have them or not.
  bool look_at_vertices() {
    constexpr std::uint64_t kAtOnce = std::uint64_t{1} << 18;  // vertices: some megabytes
    const std::uint64_t end = file_->vertices() * (rank_ + 1) / ranks_;
    for (std::uint64_t first = file_->vertices() * rank_ / ranks_; first < end; first += kAtOnce) {
      const Mesh some = file_->read_vertices(first, std::min(end, first + kAtOnce));
      facts_.box.include(internal::box_of(some.positions));
      facts_.normals &= have_length(some.normals);
      facts_.tangents &= have_length(some.tangents);
    }
    return true;
  }

  bool read(std::uint64_t begin, std::uint64_t end) {
    Mesh fresh = file_->rest().meshes[0];
    mesh() = {};
    if (!internal::read_run(source_, *file_, begin, end, fresh)) return false;
    if (!facts_.normals) fresh.normals.clear();
    if (fresh.normals.empty() || !facts_.tangents) fresh.tangents.clear();
    internal::normalize_or_clear(fresh.normals);
    internal::normalize_or_clear(fresh.tangents);
    mesh() = std::move(fresh);
    return true;
  }

  // Collective.
  bool place() {
    const geometry::Box3d used = of_all(communicator_, internal::box_of(mesh().positions));
    const std::optional<glm::dvec3> origin = file_->origin(facts_.box, used);
    if (!origin) return false;
    scene_.origin = *origin;
    internal::make_relative_to(*origin, mesh().positions);
    box_ = of_all(communicator_, bounds(scene_));
    const double reach =
        internal::reach_of({glm::dvec3(box_.low) + *origin, glm::dvec3(box_.high) + *origin});
    return reach <= double{static_cast<float>(internal::kLargestCoordinate)};
  }

  // Returns how many.
  std::uint64_t drop_degenerate() {
    dropped_.clear();
    for (std::uint32_t t = 0; t < mesh().triangles.size(); ++t)
      if (internal::is_degenerate(mesh(), mesh().triangles[t])) dropped_.push_back(t);
    std::erase_if(mesh().triangles,
                  [&](const glm::uvec3& t) { return internal::is_degenerate(mesh(), t); });
    return dropped_.size();
  }

  // Moves this rank's run of the file's triangles so that of those that are kept multiples of a run
  // come before. Returns how many do; nothing where a rank keeps too few. Collective.
  std::optional<std::uint64_t> move_begin(std::uint64_t& begin, std::uint64_t& end) {
    const std::uint64_t kept = mesh().triangles.size();
    std::uint64_t before = kept;
    comm::exclusive_scan(communicator_, std::span(&before, 1), std::uint64_t{0}, std::plus<>());
    constexpr std::uint64_t kRun = internal::kTrianglesOfRun;
    const std::uint64_t first = (before + kRun - 1) / kRun * kRun;
    std::uint64_t skipped = first - before;
    if (!agreed(kept > kRun)) return std::nullopt;
    for (const std::uint32_t t : dropped_) skipped += t <= skipped ? 1 : 0;
    std::uint64_t mine = begin + skipped;
    const auto begins = comm::all_gather(communicator_, comm::Buffer::of_value(mine));
    begin = mine;
    if (rank_ + 1 < ranks_) end = begins[rank_ + 1].as<std::uint64_t>()[0];
    return first;
  }

  // Whether load() leaves the triangles in the order of the file. Collective.
  bool is_ordered() {
    if (is_gltf_) return true;
    const internal::RunSizes sizes = comm::all_reduce_value(
        communicator_, internal::sizes_of_runs(mesh()), std::plus<internal::RunSizes>());
    return internal::are_compact(sizes);
  }

  // Collective.
  void find_up() {
    const char up = files::up_axis(start_);
    if (is_gltf_ || up != '\0') {
      scene_.z_up = !is_gltf_ && up == 'z';
      return;
    }
    const internal::FlatAreas areas = comm::all_reduce_value(
        communicator_, internal::flat_areas(scene_, box_), std::plus<internal::FlatAreas>());
    scene_.z_up = internal::guess_z_up(box_, areas, false);
  }

  // Those of complete_surfaces where there are none; `first`: number of the first triangle.
  // Collective.
  void add_normals(std::uint64_t first) {
    if (!agreed(mesh().normals.empty())) return;
    const std::vector<internal::BorderTriangle> border =
        internal::border_triangles(communicator_, mesh(), first);
    comm::all_or_none(communicator_, comm::Phase::load, [&] {
      const auto before = static_cast<std::size_t>(
          std::ranges::lower_bound(border, first, {}, &internal::BorderTriangle::number) -
          border.begin());
      const std::size_t own = mesh().triangles.size();
      add_border(border, before);
      complete_surfaces(scene_);
      keep_triangles(before, own);
    });
  }

  // Puts the first `before` triangles in front of the mesh's, the others behind.
  void add_border(const std::vector<internal::BorderTriangle>& border, std::size_t before) {
    std::vector<glm::uvec3> triangles;
    triangles.reserve(border.size());
    for (const internal::BorderTriangle& t : border) {
      const auto next = static_cast<std::uint32_t>(mesh().positions.size());
      mesh().positions.insert(mesh().positions.end(), std::begin(t.corners), std::end(t.corners));
      triangles.emplace_back(next, next + 1, next + 2);
    }
    const std::size_t vertices = mesh().positions.size();
    if (!mesh().uvs.empty()) mesh().uvs.resize(vertices);
    if (!mesh().uvs2.empty()) mesh().uvs2.resize(vertices);
    if (!mesh().colours.empty()) mesh().colours.resize(vertices);
    const auto middle = triangles.begin() + static_cast<std::ptrdiff_t>(before);
    mesh().triangles.insert(mesh().triangles.end(), middle, triangles.end());
    mesh().triangles.insert(mesh().triangles.begin(), triangles.begin(), middle);
  }

  // Keeps triangles [first, first + count) and the vertices that they have.
  void keep_triangles(std::size_t first, std::size_t count) {
    std::vector<glm::uvec3>& triangles = mesh().triangles;
    triangles.erase(triangles.begin() + static_cast<std::ptrdiff_t>(first + count),
                    triangles.end());
    triangles.erase(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(first));
    std::vector<std::uint32_t> number(mesh().positions.size(), kNone);
    for (const glm::uvec3& t : triangles) number[t.x] = number[t.y] = number[t.z] = 0;
    std::uint32_t kept = 0;
    for (std::uint32_t& n : number) n = n == kNone ? kNone : kept++;
    internal::for_each_attribute(mesh(), mesh(), [&](auto& values, auto&) {
      if (values.empty()) return;
      for (std::size_t i = 0; i < number.size(); ++i)
        if (number[i] != kNone) values[number[i]] = values[i];
      values.resize(kept);
    });
    parallel::parallel_for(0, triangles.size(), kTrianglesAtOnce, [&](std::size_t t) {
      glm::uvec3& v = triangles[t];
      v = {number[v.x], number[v.y], number[v.z]};
    });
  }

  comm::Communicator& communicator_;
  const Source& source_;
  std::uint64_t rank_, ranks_;
  std::string start_;
  bool is_gltf_ = false;
  std::unique_ptr<TriangleFile> file_;
  VertexFacts facts_;
  Scene scene_;
  geometry::Box3 box_;                  // of all ranks' vertices, placed
  std::vector<std::uint32_t> dropped_;  // triangles of the run that was read
};

}  // namespace

std::optional<ScenePart> load_part(comm::Communicator& communicator,
                                   const std::filesystem::path& path,
                                   std::vector<std::string>& warnings, const LoadOptions& options) {
  std::vector<std::string> own;
  const Source source{path, "", own, options.memory, options.outside, false};
  std::optional<ScenePart> part = PartLoader(communicator, source).run();
  if (!part) return part;
  if (communicator.rank() == 0) warnings.insert(warnings.end(), own.begin(), own.end());
  part->scene.files = internal::named_files(source);
  return part;
}

}  // namespace delray::scenes
