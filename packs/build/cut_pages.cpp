// Cuts triangles greedily, in their order, into clusters, and takes kPageClusters of them for a
// page; bounds each cluster by a box and a cone of normals (Shirman and Abi-Ezzi 1993).
//
// Degenerate: triangles with two corners at one place do not count for cones; others without
// area, or normals too far apart, leave none.
#include "packs/build/cut_pages.h"

#include <algorithm>
#include <cmath>

namespace delray::packs::internal {
namespace {

// What the triangles of a cluster or page say of their normals, in double precision.
class ConeOfTriangles {
 public:
  void add(const glm::vec3& p, const glm::vec3& q, const glm::vec3& r) {
    const glm::dvec3 a(p), b(q), c(r);
    if (a == b || b == c || c == a) return;  // nothing of it is ever drawn
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    const double area = glm::length(cross);
    const auto squared = [](const glm::dvec3& edge) { return glm::dot(edge, edge); };
    const double longest = std::sqrt(std::max({squared(b - a), squared(c - b), squared(a - c)}));
    least_height_ = std::min(least_height_, area / longest);
    if (!(area > 0)) {
      flat_ = true;
      return;
    }
    normals_.push_back(cross / area);
    sum_ += cross / area;
  }

  NormalCone cone() const {
    const double length = glm::length(sum_);
    if (flat_ || normals_.empty() || !(length > 0)) return {};
    const glm::vec3 axis(sum_ / length);
    double cosine = 1;
    for (const glm::dvec3& normal : normals_)
      cosine = std::min(cosine, glm::dot(normal, glm::dvec3(axis)));
    constexpr double kRounding = 1e-6;  // of axis and cosine to single precision
    if (cosine < 0.02) return {};       // no eye sees nothing but backs
    return {axis, static_cast<float>(cosine - kRounding),
            static_cast<float>(least_height_ * (1 - kRounding))};
  }

 private:
  std::vector<glm::dvec3> normals_;
  glm::dvec3 sum_{0.0};
  double least_height_ = std::numeric_limits<double>::infinity();
  bool flat_ = false;
};

// Numbers for the vertices of a page or cluster, by first use: a hash table that is forgotten at
// once.
class VertexNumbers {
 public:
  // The number of a vertex, and whether it is new.
  std::pair<std::uint32_t, bool> add(std::uint32_t vertex) {
    Slot& slot = slot_of(vertex);
    const bool is_new = slot.round != round_;
    if (is_new) slot = {vertex, count_++, round_};
    return {slot.number, is_new};
  }
  bool contains(std::uint32_t vertex) { return slot_of(vertex).round == round_; }
  std::uint32_t count() const { return count_; }
  void clear() {
    count_ = 0;
    ++round_;
  }

 private:
  // Four times as many as a page has vertices at most.
  static constexpr std::size_t kSlots = std::size_t{4} * kPageClusters * kClusterVertices;
  struct Slot {
    std::uint32_t vertex = 0, number = 0, round = 0;
  };
  Slot& slot_of(std::uint32_t vertex) {
    std::size_t i = (vertex * 0x9E3779B97F4A7C15U >> 32) % kSlots;
    while (slots_[i].round == round_ && slots_[i].vertex != vertex) i = (i + 1) % kSlots;
    return slots_[i];
  }

  std::vector<Slot> slots_{kSlots};
  std::uint32_t count_ = 0, round_ = 1;
};

// Makes one page after the other of a mesh.
class PageCutter {
 public:
  explicit PageCutter(const scenes::Mesh& mesh) : mesh_(mesh) {}

  // Takes triangles from `begin` on, before `end`. Returns where it stopped.
  std::uint32_t cut(std::uint32_t begin, std::uint32_t end, Page& page) {
    number_.clear();
    source_.clear();
    std::uint32_t t = begin;
    while (t < end && page.clusters.size() < kPageClusters) t = cut_cluster(t, end, page);
    page.mesh.shape = mesh_.shape;
    page.mesh.material = mesh_.material;
    gather(mesh_.positions, page.mesh.positions);
    gather(mesh_.normals, page.mesh.normals);
    gather(mesh_.uvs, page.mesh.uvs);
    gather(mesh_.uvs2, page.mesh.uvs2);
    gather(mesh_.tangents, page.mesh.tangents);
    gather(mesh_.colours, page.mesh.colours);
    for (PageCluster& cluster : page.clusters) bound(page, cluster);
    return t;
  }

 private:
  template <class T>
  void gather(const std::vector<T>& from, std::vector<T>& to) const {
    if (from.empty()) return;
    to.reserve(source_.size());
    for (const std::uint32_t vertex : source_) to.push_back(from[vertex]);
  }

  std::uint32_t cut_cluster(std::uint32_t t, std::uint32_t end, Page& page) {
    PageCluster cluster;
    cluster.first = static_cast<std::uint32_t>(page.mesh.triangles.size());
    cluster.first_vertex = static_cast<std::uint32_t>(page.vertices.size());
    cluster.first_corner = static_cast<std::uint32_t>(page.corners.size());
    in_cluster_.clear();
    std::vector<glm::u8vec3> corners;
    for (; t < end && corners.size() < kClusterTriangles; ++t) {
      const glm::uvec3& v = mesh_.triangles[t];
      std::uint32_t fresh = 0;
      for (int k = 0; k < 3; ++k) fresh += in_cluster_.contains(v[k]) ? 0 : 1;
      if (in_cluster_.count() + fresh > kClusterVertices) break;
      glm::u8vec3 corner;
      glm::uvec3 of_page;
      for (int k = 0; k < 3; ++k) {
        const auto [number, is_new] = in_cluster_.add(v[k]);
        if (is_new) page.vertices.push_back(number_of(v[k]));
        corner[k] = static_cast<std::uint8_t>(number);
        of_page[k] = page.vertices[cluster.first_vertex + number];
      }
      corners.push_back(corner);
      page.mesh.triangles.push_back(of_page);
    }
    cluster.count = static_cast<std::uint32_t>(corners.size());
    cluster.vertices = in_cluster_.count();
    page.corners.resize(page.corners.size() + std::size_t{3} * cluster.corner_stride());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        page.corners[cluster.first_corner + k * cluster.corner_stride() + i] =
            corners[i][static_cast<int>(k)];
      }
    }
    page.clusters.push_back(cluster);
    return t;
  }

  std::uint32_t number_of(std::uint32_t vertex) {
    const auto [number, is_new] = number_.add(vertex);
    if (is_new) source_.push_back(vertex);
    return number;
  }

  static void bound(const Page& page, PageCluster& cluster) {
    ConeOfTriangles cone;
    cluster.normals_agree = !page.mesh.normals.empty();
    for (std::uint32_t i = 0; i < cluster.vertices; ++i)
      cluster.box.include(page.mesh.positions[page.vertices[cluster.first_vertex + i]]);
    for (std::uint32_t t = cluster.first; t < cluster.first + cluster.count; ++t) {
      const glm::uvec3& v = page.mesh.triangles[t];
      const glm::vec3 &a = page.mesh.positions[v.x], &b = page.mesh.positions[v.y],
                      &c = page.mesh.positions[v.z];
      cone.add(a, b, c);
      // In single precision, as the rasterizer decides it at the corners of single triangles.
      const glm::vec3 cross = glm::cross(b - a, c - a);
      for (int k = 0; k < 3 && cluster.normals_agree; ++k)
        cluster.normals_agree = glm::dot(page.mesh.normals[v[k]], cross) >= 0;
    }
    cluster.cone = cone.cone();
  }

  const scenes::Mesh& mesh_;
  VertexNumbers number_, in_cluster_;
  std::vector<std::uint32_t> source_;  // by vertex of the page: that of the mesh
};

}  // namespace

std::vector<Page> cut_pages(const scenes::Mesh& mesh, std::uint32_t begin, std::uint32_t end) {
  std::vector<Page> pages;
  PageCutter cutter(mesh);
  while (begin < end) begin = cutter.cut(begin, end, pages.emplace_back());
  return pages;
}

geometry::Box3 box_of(const Page& page) {
  geometry::Box3 box;
  for (const glm::vec3& p : page.mesh.positions) box.include(p);
  return box;
}

NormalCone cone_of(const Page& page) {
  ConeOfTriangles cone;
  for (const glm::uvec3& v : page.mesh.triangles)
    cone.add(page.mesh.positions[v.x], page.mesh.positions[v.y], page.mesh.positions[v.z]);
  return cone.cone();
}

}  // namespace delray::packs::internal
