// Cuts a mesh greedily into runs of consecutive triangles, closed when they have too many triangles
// or vertices, and bounds each by a box, a cone of normals and the least height of its triangles.
//
// Vertices are numbered through a small hash table with open addressing. Blocks of many clusters
// are made in parallel, when they are first asked for. O(triangles).
//
// Degenerate: triangles with two corners at one place do not count for the cone; others without
// area, or normals too far apart, leave none; positions that are not finite give an infinite box.
#include "raster/pipeline/mesh_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "parallel/parallel_for.h"

namespace delray::raster {
namespace {

// Local numbers of the vertices of the cluster at hand: open addressing, at most half full.
class VertexNumbers {
 public:
  static constexpr std::uint32_t kSlots = 2 * kClusterVertices;

  void clear() { vertex_.fill(kFree); }
  // The vertex's number, or `next` after remembering that.
  std::uint32_t number(std::uint32_t vertex, std::uint32_t next) {
    const std::uint32_t slot = find(vertex);
    if (vertex_[slot] == vertex) return number_[slot];
    vertex_[slot] = vertex;
    number_[slot] = static_cast<std::uint8_t>(next);
    return next;
  }
  bool knows(std::uint32_t vertex) const { return vertex_[find(vertex)] == vertex; }

 private:
  static constexpr std::uint32_t kFree = 0xFFFFFFFFU;

  std::uint32_t find(std::uint32_t vertex) const {
    // Fibonacci hashing (Knuth 1973, 6.4).
    std::uint32_t slot = (vertex * 0x9E3779B9U) >> 23;
    while (vertex_[slot] != vertex && vertex_[slot] != kFree) slot = (slot + 1) % kSlots;
    return slot;
  }

  std::array<std::uint32_t, kSlots> vertex_;
  std::array<std::uint8_t, kSlots> number_;
};
static_assert(VertexNumbers::kSlots == 1U << (32 - 23));

bool finite(const glm::vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

void bound(const scenes::Mesh& mesh, const ClusterBlock& block, MeshCluster& cluster) {
  for (const std::uint32_t vertex : block.vertices_of(cluster)) {
    const glm::vec3& p = mesh.positions[vertex];
    if (!finite(p)) {
      constexpr float kInfinity = std::numeric_limits<float>::infinity();
      cluster.box = {glm::vec3(-kInfinity), glm::vec3(kInfinity)};
      return;
    }
    cluster.box.include(p);
  }

  std::array<glm::dvec3, kClusterTriangles> normals;
  std::uint32_t known = 0;
  glm::dvec3 sum(0.0);
  double least_height = std::numeric_limits<double>::infinity();
  for (std::uint32_t t = cluster.first; t < cluster.first + cluster.count; ++t) {
    const glm::uvec3& v = mesh.triangles[t];
    const glm::dvec3 a(mesh.positions[v.x]), b(mesh.positions[v.y]), c(mesh.positions[v.z]);
    // Two corners at one place are at one place on the screen: nothing is ever drawn.
    if (a == b || b == c || c == a) continue;
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    const double area = glm::length(cross);
    const auto squared = [](const glm::dvec3& edge) { return glm::dot(edge, edge); };
    const double longest = std::sqrt(std::max({squared(b - a), squared(c - b), squared(a - c)}));
    least_height = std::min(least_height, area / longest);
    if (!(area > 0)) return;
    normals[known++] = cross / area;
    sum += cross / area;
  }
  const double length = glm::length(sum);
  if (known == 0 || !(length > 0)) return;
  const glm::vec3 axis(sum / length);
  double cosine = 1;
  for (std::uint32_t i = 0; i < known; ++i)
    cosine = std::min(cosine, glm::dot(normals[i], glm::dvec3(axis)));
  constexpr double kRounding = 1e-6;  // of axis and cosine to single precision
  if (cosine < 0.02) return;          // no eye sees nothing but backs
  cluster.axis = axis;
  cluster.cosine = static_cast<float>(cosine - kRounding);
  cluster.least_height = static_cast<float>(least_height * (1 - kRounding));
}

bool normals_agree(const scenes::Mesh& mesh, const MeshCluster& cluster) {
  if (mesh.normals.empty()) return false;
  for (std::uint32_t t = cluster.first; t < cluster.first + cluster.count; ++t) {
    const glm::uvec3& corners = mesh.triangles[t];
    const glm::vec3 edges = cross_of_edges(mesh, corners);
    for (int k = 0; k < 3; ++k)
      if (!normal_agrees(mesh, corners[k], edges)) return false;
  }
  return true;
}

std::unique_ptr<ClusterBlock> make_block(const scenes::Mesh& mesh, std::uint32_t begin,
                                         std::uint32_t end) {
  auto block = std::make_unique<ClusterBlock>();
  block->clusters.reserve((end - begin + kClusterTriangles - 1) / kClusterTriangles);
  VertexNumbers numbers;
  for (std::uint32_t t = begin; t < end;) {
    MeshCluster cluster;
    cluster.first = t;
    cluster.first_vertex = static_cast<std::uint32_t>(block->vertices.size());
    cluster.first_corner = static_cast<std::uint32_t>(block->corners.size());
    numbers.clear();
    std::array<std::array<std::uint8_t, kClusterTriangles>, 3> corners{};
    for (; t < end && cluster.count < kClusterTriangles; ++t) {
      const glm::uvec3& v = mesh.triangles[t];
      const auto fresh = static_cast<std::uint32_t>(!numbers.knows(v.x)) +
                         static_cast<std::uint32_t>(!numbers.knows(v.y)) +
                         static_cast<std::uint32_t>(!numbers.knows(v.z));
      if (cluster.vertices + fresh > kClusterVertices) break;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t number = numbers.number(v[k], cluster.vertices);
        if (number == cluster.vertices) {
          ++cluster.vertices;
          block->vertices.push_back(v[k]);
        }
        corners[static_cast<std::size_t>(k)][cluster.count] = static_cast<std::uint8_t>(number);
      }
      ++cluster.count;
    }
    for (const auto& corner : corners) {
      block->corners.insert(block->corners.end(), corner.begin(),
                            corner.begin() + cluster.corner_stride());
    }
    bound(mesh, *block, cluster);
    cluster.normals_agree = normals_agree(mesh, cluster);
    cluster.first_in_mesh = first_of_consecutive(block->vertices_of(cluster));
    block->box.include(cluster.box);
    block->clusters.push_back(cluster);
  }
  block->clusters.shrink_to_fit();
  block->vertices.shrink_to_fit();
  block->corners.shrink_to_fit();
  return block;
}

}  // namespace

std::uint32_t first_of_consecutive(std::span<const std::uint32_t> vertices) {
  // A few at a time, without branches.
  constexpr std::size_t kAtOnce = 16;
  for (std::size_t first = 0; first < vertices.size(); first += kAtOnce) {
    std::uint32_t differences = 0;
    const std::size_t end = std::min(first + kAtOnce, vertices.size());
    for (std::size_t i = first; i < end; ++i)
      differences |= vertices[i] ^ (vertices[0] + static_cast<std::uint32_t>(i));
    if (differences != 0) return scenes::kNone;
  }
  return vertices.empty() ? scenes::kNone : vertices[0];
}

void MeshClusters::make(const scenes::Mesh& mesh, std::uint32_t first, std::uint32_t count) {
  const auto all = static_cast<std::uint32_t>(mesh.triangles.size());
  blocks.resize((all + kBlockTriangles - 1) / kBlockTriangles);
  if (count == 0) return;
  const std::uint32_t last = (first + count - 1) >> kBlockBits;
  std::vector<std::uint32_t> missing;
  for (std::uint32_t k = first >> kBlockBits; k <= last; ++k)
    if (blocks[k] == nullptr) missing.push_back(k);
  parallel::parallel_for(0, missing.size(), 1, [&](std::size_t i) {
    const std::uint32_t begin = missing[i] << kBlockBits;
    blocks[missing[i]] = make_block(mesh, begin, std::min(begin + kBlockTriangles, all));
  });
}

}  // namespace delray::raster
