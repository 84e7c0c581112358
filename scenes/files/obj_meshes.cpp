// Ranges find which meshes they have elements of, and number these by first use; one table for all
// corners finds the first of equal ones; then ranges make vertices, triangles, points and segments,
// which are put behind each other.
#include "scenes/files/obj_meshes.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "parallel/grow.h"
#include "parallel/parallel_for.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/first_of_equal.h"
#include "scenes/geometry/noise.h"
#include "scenes/geometry/polygon.h"

namespace delray::scenes::internal {
namespace {

constexpr std::size_t kCornersAtOnce = 1 << 14;  // corners: tens of microseconds

// What a mesh is made of; the order means nothing.
enum Kind : std::uint32_t { kPlainFaces, kFacesWithNormals, kLines, kPoints, kKinds };

class MeshMaker {
 public:
  MeshMaker(const ObjText& text, std::vector<ObjElements>&& elements,
            const std::vector<std::vector<ObjMaterialRun>>& runs)
      : text_(text), elements_(std::move(elements)), runs_(runs), ranges_(elements_.size()) {}

  std::vector<Mesh> run(std::uint64_t& left_out) {
    parallel::parallel_for(0, ranges_.size(), 1, [&](std::size_t i) { find_meshes(i); });
    for (const Range& range : ranges_) left_out += range.left_out;
    number_meshes();
    join_corners();
    number_vertices();
    make_vertices();
    parallel::parallel_for(0, ranges_.size(), 1, [&](std::size_t i) { make_primitives(i); });
    join_primitives();
    return std::move(meshes_);
  }

 private:
  struct Range {
    std::vector<std::uint32_t> keys;          // kKinds * material + kind, in the order of first use
    std::vector<std::uint32_t> mesh;          // numbers of these
    std::vector<std::uint32_t> element_mesh;  // of each element that is kept, index into `keys`
    std::vector<std::vector<glm::uvec3>> primitives;  // of each of `keys`
    std::uint64_t left_out = 0;
  };

  static std::uint32_t kind_of(const ObjElement& element, std::span<const ObjCorner> corners) {
    if (element.kind == ObjElement::line) return kLines;
    if (element.kind == ObjElement::points) return kPoints;
    const bool normals =
        std::ranges::all_of(corners, [](const ObjCorner& c) { return c[2] != kNone; });
    return normals ? kFacesWithNormals : kPlainFaces;
  }

  static bool is_kept(const ObjElement& element) {
    constexpr std::array<std::uint32_t, 3> kLeast = {3, 2, 1};
    return element.corners >= kLeast[element.kind];
  }

  // And drops what is not kept.
  void find_meshes(std::size_t number) {
    Range& range = ranges_[number];
    ObjElements& from = elements_[number];
    std::unordered_map<std::uint32_t, std::uint32_t> found;
    std::uint32_t last_key = kNone, last = 0;
    auto run = runs_[number].begin();
    std::size_t at = 0, kept_corners = 0, kept = 0;
    for (std::size_t e = 0; e < from.elements.size(); ++e) {
      while (run + 1 != runs_[number].end() && (run + 1)->begin <= e) ++run;
      const ObjElement element = from.elements[e];
      const std::span<ObjCorner> corners(from.corners.data() + at, element.corners);
      at += element.corners;
      if (!is_kept(element)) {
        ++range.left_out;
        continue;
      }
      const std::uint32_t kind = kind_of(element, corners), key = run->material * kKinds + kind;
      if (key != last_key) {
        const auto [entry, is_new] =
            found.try_emplace(key, static_cast<std::uint32_t>(range.keys.size()));
        if (is_new) range.keys.push_back(key);
        last_key = key;
        last = entry->second;
      }
      range.element_mesh.push_back(last);
      from.elements[kept++] = element;
      for (ObjCorner corner : corners) {
        if (kind != kFacesWithNormals) corner[2] = kNone;
        if (kind >= kLines) corner[1] = kNone;
        from.corners[kept_corners++] = corner;
      }
    }
    from.elements.resize(kept);
    from.corners.resize(kept_corners);
  }

  void number_meshes() {
    std::unordered_map<std::uint32_t, std::uint32_t> numbers;
    for (Range& range : ranges_) {
      for (const std::uint32_t key : range.keys) {
        const auto [entry, is_new] =
            numbers.try_emplace(key, static_cast<std::uint32_t>(meshes_.size()));
        range.mesh.push_back(entry->second);
        if (!is_new) continue;
        Mesh& mesh = meshes_.emplace_back();
        mesh.material = key / kKinds;
        if (key % kKinds == kLines) mesh.shape = kLineShape;
        if (key % kKinds == kPoints) mesh.shape = kPointShape;
        has_normals_.push_back(key % kKinds == kFacesWithNormals);
      }
    }
  }

  void join_corners() {
    begins_ = {0};
    for (const ObjElements& part : elements_)
      begins_.push_back(begins_.back() + part.corners.size());
    if (begins_.back() >= kNone) text_.source().fail("", "a mesh is too large");
    constexpr std::uint64_t kTables = 14;  // bytes for each corner: mesh, first and table
    text_.source().require_memory(begins_.back() * (sizeof(ObjCorner) + kTables));
    parallel::grow(corners_, begins_.back());
    parallel::grow(mesh_of_, begins_.back());
    parallel::parallel_for(0, ranges_.size(), 1, [&](std::size_t i) {
      std::vector<ObjCorner>& from = elements_[i].corners;
      std::ranges::copy(from, corners_.begin() + static_cast<std::ptrdiff_t>(begins_[i]));
      std::vector<ObjCorner>().swap(from);
      std::size_t at = begins_[i];
      for (std::size_t e = 0; e < elements_[i].elements.size(); ++e) {
        const std::uint32_t mesh = ranges_[i].mesh[ranges_[i].element_mesh[e]];
        for (std::uint32_t k = 0; k < elements_[i].elements[e].corners; ++k) mesh_of_[at++] = mesh;
      }
    });
  }

  // vertex_[c] becomes the number of corner c's vertex; those of first corners are marked.
  void number_vertices() {
    const auto hash = [&](std::uint32_t c) {
      const auto pair = [](std::uint64_t a, std::uint32_t b) { return a << 32 | b; };
      return scatter(scatter(pair(corners_[c][0], corners_[c][1])) ^
                     pair(corners_[c][2], mesh_of_[c]));
    };
    const auto equal = [&](std::uint32_t a, std::uint32_t b) {
      return corners_[a] == corners_[b] && mesh_of_[a] == mesh_of_[b];
    };
    parallel::grow(vertex_, corners_.size());
    {
      FirstOfEqual first(corners_.size(), hash, equal);
      first.insert_all();
      parallel::parallel_for(0, corners_.size(), kCornersAtOnce, [&](std::size_t c) {
        vertex_[c] = first.find(static_cast<std::uint32_t>(c));
      });
    }
    is_first_.resize(corners_.size());
    counts_.resize(meshes_.size(), 0);
    for (std::size_t c = 0; c < corners_.size(); ++c) {
      const bool is_first = vertex_[c] == c;
      is_first_[c] = is_first ? 1 : 0;
      vertex_[c] = is_first ? counts_[mesh_of_[c]]++ : vertex_[vertex_[c]];
    }
  }

  void make_vertices() {
    const ObjVertices& all = text_.vertices();
    std::vector<std::uint8_t> uvs(meshes_.size(), 0);
    for (std::size_t c = 0; c < corners_.size(); ++c)
      if (corners_[c][1] != kNone) uvs[mesh_of_[c]] = 1;
    for (std::size_t m = 0; m < meshes_.size(); ++m) {
      Mesh& mesh = meshes_[m];
      text_.source().require_memory(counts_[m] * (sizeof(glm::vec3) + sizeof(glm::vec2)));
      parallel::grow(mesh.positions, counts_[m]);
      if (!all.colours.empty()) parallel::grow(mesh.colours, counts_[m]);
      if (has_normals_[m]) parallel::grow(mesh.normals, counts_[m]);
      if (uvs[m] != 0) parallel::grow(mesh.uvs, counts_[m]);
    }
    parallel::parallel_for(0, corners_.size(), kCornersAtOnce, [&](std::size_t c) {
      if (is_first_[c] == 0) return;
      Mesh& mesh = meshes_[mesh_of_[c]];
      const ObjCorner& corner = corners_[c];
      const std::uint32_t v = vertex_[c];
      mesh.positions[v] = all.positions[corner[0]];
      if (!mesh.colours.empty()) mesh.colours[v] = all.colours[corner[0]];
      if (!mesh.normals.empty()) mesh.normals[v] = all.normals[corner[2]];
      // Vertices without have 0.
      if (!mesh.uvs.empty() && corner[1] != kNone) mesh.uvs[v] = all.uvs[corner[1]];
    });
    std::vector<ObjCorner>().swap(corners_);
    std::vector<std::uint8_t>().swap(is_first_);
  }

  void make_primitives(std::size_t number) {
    Range& range = ranges_[number];
    range.primitives.resize(range.keys.size());
    const std::uint32_t* corner = vertex_.data() + begins_[number];
    for (std::size_t e = 0; e < elements_[number].elements.size(); ++e) {
      const std::uint32_t key = range.element_mesh[e];
      const std::span<const std::uint32_t> v(corner, elements_[number].elements[e].corners);
      std::vector<glm::uvec3>& to = range.primitives[key];
      const std::uint32_t kind = range.keys[key] % kKinds;
      if (kind == kPoints) {
        for (const std::uint32_t point : v) to.emplace_back(point);
      } else if (kind == kLines) {
        for (std::size_t k = 1; k < v.size(); ++k) to.emplace_back(v[k - 1], v[k], v[k]);
      } else {
        triangulate_polygon(v, meshes_[range.mesh[key]].positions, to);
      }
      corner += v.size();
    }
    elements_[number] = {};
  }

  void join_primitives() {
    // Where each range's begin in their meshes.
    std::vector<std::size_t> sizes(meshes_.size(), 0);
    std::vector<std::vector<std::size_t>> begins(ranges_.size());
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
      for (std::size_t k = 0; k < ranges_[i].keys.size(); ++k) {
        std::size_t& size = sizes[ranges_[i].mesh[k]];
        begins[i].push_back(size);
        size += ranges_[i].primitives[k].size();
      }
    }
    for (std::size_t m = 0; m < meshes_.size(); ++m) {
      text_.source().require_memory(sizes[m] * sizeof(glm::uvec3));
      parallel::grow(meshes_[m].triangles, sizes[m]);
    }
    parallel::parallel_for(0, ranges_.size(), 1, [&](std::size_t i) {
      for (std::size_t k = 0; k < ranges_[i].keys.size(); ++k) {
        std::ranges::copy(ranges_[i].primitives[k], meshes_[ranges_[i].mesh[k]].triangles.begin() +
                                                        static_cast<std::ptrdiff_t>(begins[i][k]));
      }
      ranges_[i].primitives = {};
    });
  }

  const ObjText& text_;
  std::vector<ObjElements> elements_;
  const std::vector<std::vector<ObjMaterialRun>>& runs_;
  std::vector<Range> ranges_;
  std::vector<Mesh> meshes_;
  std::vector<bool> has_normals_;       // of meshes
  std::vector<std::size_t> begins_;     // of the corners of ranges
  std::vector<ObjCorner> corners_;      // of all kept elements
  std::vector<std::uint32_t> mesh_of_;  // of corners
  std::vector<std::uint32_t> vertex_;   // of corners
  std::vector<std::uint8_t> is_first_;  // of corners: whether its vertex has none before
  std::vector<std::uint32_t> counts_;   // vertices of meshes
};

}  // namespace

std::vector<Mesh> make_obj_meshes(const ObjText& text, std::vector<ObjElements>&& elements,
                                  const std::vector<std::vector<ObjMaterialRun>>& runs,
                                  std::uint64_t& left_out) {
  return MeshMaker(text, std::move(elements), runs).run(left_out);
}

}  // namespace delray::scenes::internal
