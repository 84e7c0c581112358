// Vertex normals with creases, weighted by area.
//
// Vertices of equal position are found by a hash table. Around each position the triangles form a
// graph, connected across edges that bend by the crease angle or less; union-find joins them, and
// every component gets the sum of its area vectors as its normal and, if there are several, a copy
// of the vertex. O(vertices + triangles), parallel over positions.
//
// Degenerate: triangles without area are connected to none and add nothing; a sum of 0 becomes (0,
// 0, 1). Edges of more than two triangles connect those that follow each other in the order of the
// mesh.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

#include "parallel/parallel_for.h"
#include "scenes/geometry/normals.h"
#include "scenes/geometry/split.h"

namespace delray::scenes::internal {
namespace {

constexpr std::size_t kTrianglesPerBlock = 4096;  // tens of microseconds of cross products
constexpr std::size_t kVerticesPerBlock = 1024;   // each with about six triangles to connect

std::uint64_t hash_of(const glm::vec3& p) {
  // Adding zero makes -0 and 0 one key, as they are one position.
  const auto bits = [](float x) { return std::uint64_t{std::bit_cast<std::uint32_t>(x + 0.0F)}; };
  std::uint64_t h = bits(p.x) * 0x9E3779B97F4A7C15U;
  h = (h ^ (h >> 29) ^ bits(p.y)) * 0xBF58476D1CE4E5B9U;
  h = (h ^ (h >> 32) ^ bits(p.z)) * 0x94D049BB133111EBU;
  return h ^ (h >> 31);
}

// For each vertex the first vertex that has the same position.
std::vector<std::uint32_t> first_at_position(std::span<const glm::vec3> positions) {
  std::vector<std::uint32_t> first(positions.size());
  std::vector<std::uint32_t> table(std::bit_ceil(positions.size() * 2 + 1), kNone);
  const std::size_t mask = table.size() - 1;
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    std::size_t slot = hash_of(positions[v]) & mask;
    while (table[slot] != kNone && positions[table[slot]] != positions[v]) slot = (slot + 1) & mask;
    if (table[slot] == kNone) table[slot] = v;
    first[v] = table[slot];
  }
  return first;
}

// The corners of each position: those of vertex v are corners[begin[v]] to corners[begin[v + 1] -
// 1], ascending.
struct CornersOfVertex {
  std::vector<std::uint64_t> begin;
  std::vector<std::uint32_t> corners;
};

CornersOfVertex corners_of(std::span<const glm::uvec3> triangles,
                           std::span<const std::uint32_t> position) {
  CornersOfVertex result{std::vector<std::uint64_t>(position.size() + 1, 0),
                         std::vector<std::uint32_t>(triangles.size() * 3)};
  const auto vertex = [&](std::size_t c) {
    return position[triangles[c / 3][static_cast<int>(c % 3)]];
  };
  const std::size_t count = result.corners.size();
  for (std::size_t c = 0; c < count; ++c) ++result.begin[vertex(c) + 1];
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
  std::vector<std::uint64_t> cursor(result.begin.begin(), result.begin.end() - 1);
  for (std::size_t c = 0; c < count; ++c) {
    result.corners[cursor[vertex(c)]++] = static_cast<std::uint32_t>(c);
  }
  return result;
}

struct Fan {
  struct Spoke {
    std::uint32_t other_end, corner;  // position at the other end of the edge; index into `parent`
    bool operator<(const Spoke& s) const {
      return other_end != s.other_end ? other_end < s.other_end : corner < s.corner;
    }
  };
  std::vector<Spoke> spokes;
  std::vector<std::uint32_t> parent;
  std::vector<std::uint32_t>
      order;  // corners by area vectors, so that that of triangles is no matter
  std::vector<glm::dvec3> sum;

  std::uint32_t root(std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent[std::max(a, b)] = std::min(a, b);
  }
};

struct Surface {
  std::span<const glm::uvec3> triangles;
  std::span<const std::uint32_t> position;
  std::span<const glm::vec3> area;  // per triangle: normal times twice the area
  float crease_cosine;

  bool smooth(std::uint32_t a, std::uint32_t b) const {
    const glm::dvec3 p(area[a]), q(area[b]);
    const double lengths = std::sqrt(glm::dot(p, p) * glm::dot(q, q));
    return lengths > 0 && glm::dot(p, q) >= crease_cosine * lengths;
  }
};

// Labels every corner of one position with the first corner of its smooth part of the fan and gives
// it that part's normal.
void connect(const Surface& surface, std::span<const std::uint32_t> corners, Fan& fan,
             std::span<std::uint32_t> labels, std::span<glm::vec3> normals) {
  fan.spokes.clear();
  fan.parent.resize(corners.size());
  fan.sum.assign(corners.size(), glm::dvec3(0));
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    fan.parent[i] = i;
    const glm::uvec3& triangle = surface.triangles[corners[i] / 3];
    for (std::uint32_t side = 1; side <= 2; ++side) {
      const auto k = static_cast<int>((corners[i] % 3 + side) % 3);
      fan.spokes.push_back({surface.position[triangle[k]], i});
    }
  }
  std::sort(fan.spokes.begin(), fan.spokes.end());
  for (std::size_t s = 1; s < fan.spokes.size(); ++s) {
    const Fan::Spoke &a = fan.spokes[s - 1], &b = fan.spokes[s];
    if (a.other_end == b.other_end &&
        surface.smooth(corners[a.corner] / 3, corners[b.corner] / 3)) {
      fan.join(a.corner, b.corner);
    }
  }
  fan.order.resize(corners.size());
  std::iota(fan.order.begin(), fan.order.end(), 0U);
  std::sort(fan.order.begin(), fan.order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const glm::vec3 &p = surface.area[corners[a] / 3], &q = surface.area[corners[b] / 3];
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
  });
  for (const std::uint32_t i : fan.order)
    fan.sum[fan.root(i)] += glm::dvec3(surface.area[corners[i] / 3]);
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    const std::uint32_t part = fan.root(i);
    const double length = glm::length(fan.sum[part]);
    labels[corners[i]] = corners[part];
    normals[corners[i]] = length > 0 ? glm::vec3(fan.sum[part] / length) : glm::vec3(0, 0, 1);
  }
}

std::vector<glm::vec3> area_vectors(const Mesh& mesh) {
  std::vector<glm::vec3> area(mesh.triangles.size());
  parallel::parallel_for(0, area.size(), kTrianglesPerBlock, [&](std::size_t t) {
    const glm::uvec3& v = mesh.triangles[t];
    const glm::dvec3 p(mesh.positions[v.x]);
    area[t] = glm::cross(glm::dvec3(mesh.positions[v.y]) - p, glm::dvec3(mesh.positions[v.z]) - p);
  });
  return area;
}

}  // namespace

void compute_normals(Mesh& mesh, float crease_cosine) {
  const std::vector<std::uint32_t> position = first_at_position(mesh.positions);
  const std::vector<glm::vec3> area = area_vectors(mesh);
  const CornersOfVertex fans = corners_of(mesh.triangles, position);
  std::vector<std::uint32_t> labels(mesh.triangles.size() * 3);
  std::vector<glm::vec3> normals(labels.size());
  const Surface surface{mesh.triangles, position, area, crease_cosine};
  parallel::parallel_blocks(
      0, position.size(), kVerticesPerBlock, [&](std::size_t first, std::size_t last) {
        Fan fan;
        for (std::size_t v = first; v < last; ++v) {
          const std::span<const std::uint32_t> corners(fans.corners.data() + fans.begin[v],
                                                       fans.begin[v + 1] - fans.begin[v]);
          if (!corners.empty()) connect(surface, corners, fan, labels, normals);
        }
      });
  mesh.normals.clear();
  split_vertices(mesh, labels);
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0, 0, 1));
  for (std::size_t c = 0; c < normals.size(); ++c) {
    mesh.normals[mesh.triangles[c / 3][static_cast<int>(c % 3)]] = normals[c];
  }
}

}  // namespace delray::scenes::internal
