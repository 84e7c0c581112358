// Nearest points by a tree of boxes over triangles (Ericson 2005, 5.1.5 for one triangle), the
// place at hand first where the last one was found. Two-sided, as Cignoni, Rocchini and Scopigno
// (1998) measure it, but not from random samples: from vertices, and from the middles of edges and
// triangles, each once.
//
// Errors of what lies beneath are added where they are, by the triangle inequality, and not the
// largest to the largest: those are rarely at one place. An edge of several triangles is measured
// in the first of them.
//
// Degenerate: triangles without area count as their edges; without triangles the error is 0.
#include "packs/build/surface_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "geometry/box.h"

namespace delray::packs::internal {
namespace {

using Weights = glm::vec3;  // of a triangle's corners
constexpr float kHalf = 0.5F;

// Weights of the place of a triangle that is nearest to a point.
Weights nearest_in(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::vec3 ab = b - a, ac = c - a, ap = p - a;
  const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const glm::vec3 bp = p - b;
  const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const float v = d1 > d3 ? d1 / (d1 - d3) : 0;
    return {1 - v, v, 0};
  }
  const glm::vec3 cp = p - c;
  const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const float w = d2 > d6 ? d2 / (d2 - d6) : 0;
    return {1 - w, 0, w};
  }
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const float sum = (d4 - d3) + (d5 - d6);
    const float w = sum > 0 ? (d4 - d3) / sum : 0;
    return {0, 1 - w, w};
  }
  const float sum = va + vb + vc;
  if (!(sum > 0)) return {1, 0, 0};
  const float v = vb / sum, w = vc / sum;
  return {1 - v - w, v, w};
}

template <class T>
T at(const std::vector<T>& values, const glm::uvec3& corners, const Weights& w) {
  return values[corners.x] * w.x + values[corners.y] * w.y + values[corners.z] * w.z;
}

// A triangle's place, and where it is.
struct Place {
  std::uint32_t triangle = 0;
  Weights weights{1, 0, 0};
  float squared = std::numeric_limits<float>::max();  // distance
};

class TriangleTree {
 public:
  explicit TriangleTree(const scenes::Mesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    boxes_.reserve(order_.size());
    centres_.reserve(order_.size());
    for (const glm::uvec3& t : mesh.triangles) {
      geometry::Box3 box;
      for (int k = 0; k < 3; ++k) box.include(mesh.positions[t[k]]);
      boxes_.push_back(box);
      centres_.push_back(box.centre());
    }
    nodes_.reserve(order_.size());
    if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
  }

  // `hint` is a triangle that may be near.
  Place nearest(const glm::vec3& p, std::uint32_t hint) const {
    Place best;
    look_at(p, hint, best);
    descend(p, 0, best);
    return best;
  }

 private:
  static constexpr std::uint32_t kLeaf = 4;
  struct Node {
    geometry::Box3 box;
    std::uint32_t first = 0, count = 0;  // of a leaf; otherwise count is 0
    std::uint32_t second = 0;            // the other child; the first follows the node
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t last) {
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    geometry::Box3 box, centres;
    for (std::uint32_t i = first; i < last; ++i) {
      box.include(boxes_[order_[i]]);
      centres.include(centres_[order_[i]]);
    }
    nodes_[number].box = box;
    if (last - first <= kLeaf) {
      nodes_[number].first = first;
      nodes_[number].count = last - first;
      return number;
    }
    const glm::vec3 size = centres.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = first + (last - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                     [&](std::uint32_t a, std::uint32_t b) {
                       const float of_a = centres_[a][axis], of_b = centres_[b][axis];
                       return of_a < of_b || (of_a == of_b && a < b);
                     });
    build(first, middle);
    const std::uint32_t second = build(middle, last);
    nodes_[number].second = second;
    return number;
  }

  void look_at(const glm::vec3& p, std::uint32_t triangle, Place& best) const {
    const glm::uvec3& t = mesh_.triangles[triangle];
    const glm::vec3 &a = mesh_.positions[t.x], &b = mesh_.positions[t.y], &c = mesh_.positions[t.z];
    const Weights weights = nearest_in(p, a, b, c);
    const glm::vec3 way = a * weights.x + b * weights.y + c * weights.z - p;
    const float squared = glm::dot(way, way);
    if (squared < best.squared) best = {triangle, weights, squared};
  }

  static float squared_distance(const glm::vec3& p, const geometry::Box3& box) {
    const glm::vec3 way = glm::max(glm::max(box.low - p, p - box.high), glm::vec3(0.0F));
    return glm::dot(way, way);
  }

  void descend(const glm::vec3& p, std::uint32_t number, Place& best) const {
    const Node& node = nodes_[number];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      look_at(p, order_[i], best);
    if (node.count > 0) return;
    std::array<std::uint32_t, 2> child = {number + 1, node.second};
    std::array<float, 2> distance = {squared_distance(p, nodes_[child[0]].box),
                                     squared_distance(p, nodes_[child[1]].box)};
    if (distance[1] < distance[0]) {
      std::swap(child[0], child[1]);
      std::swap(distance[0], distance[1]);
    }
    for (int k = 0; k < 2; ++k)
      if (distance[k] < best.squared) descend(p, child[k], best);
  }

  const scenes::Mesh& mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<geometry::Box3> boxes_;  // by triangle
  std::vector<glm::vec3> centres_;     // of them
  std::vector<Node> nodes_;
};

// How much attributes differ, squared.
float difference(const scenes::Mesh& a, const glm::uvec3& of_a, const Weights& in_a,
                 const scenes::Mesh& b, const glm::uvec3& of_b, const Weights& in_b) {
  float sum = 0;
  const auto add = [&](const auto& from_a, const auto& from_b) {
    if (from_a.empty()) return;
    const auto way = at(from_a, of_a, in_a) - at(from_b, of_b, in_b);
    sum += glm::dot(way, way);
  };
  add(a.normals, b.normals);
  add(a.colours, b.colours);
  add(a.uvs, b.uvs);
  add(a.uvs2, b.uvs2);
  return sum;
}

// A place of a mesh, in one of the triangles that have it.
struct Sample {
  std::uint32_t triangle = 0;
  Weights weights;
};

// Middles of edges and of triangles, each once, in the order of triangles.
std::vector<Sample> middles_of(const scenes::Mesh& mesh) {
  constexpr float kThird = 1.0F / 3.0F;
  constexpr std::array<Weights, 3> kEdges = {
      Weights{kHalf, kHalf, 0}, {0, kHalf, kHalf}, {kHalf, 0, kHalf}};
  struct Edge {
    std::uint64_t ends;
    std::uint32_t triangle, side;
  };
  const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<Edge> edges;
  edges.reserve(std::size_t{3} * triangles);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint64_t a = mesh.triangles[t][static_cast<int>(k)];
      const std::uint64_t b = mesh.triangles[t][static_cast<int>((k + 1) % 3)];
      edges.push_back({std::min(a, b) << 32 | std::max(a, b), t, k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.ends != b.ends ? a.ends < b.ends : a.triangle < b.triangle;
  });
  std::vector<Sample> samples;
  samples.reserve(edges.size() / 2 + triangles);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i > 0 && edges[i - 1].ends == edges[i].ends) continue;
    samples.push_back({edges[i].triangle, kEdges[edges[i].side]});
  }
  for (std::uint32_t t = 0; t < triangles; ++t) samples.push_back({t, {kThird, kThird, kThird}});
  // Neighbours follow each other, as triangles do.
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return a.triangle < b.triangle; });
  return samples;
}

// For each vertex a triangle that has it, and which corner of that it is.
std::vector<Sample> vertices_of(const scenes::Mesh& mesh) {
  constexpr std::array<Weights, 3> kCorners = {Weights{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<Sample> samples(mesh.positions.size(), {scenes::kNone, {}});
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      Sample& sample = samples[mesh.triangles[t][k]];
      if (sample.triangle == scenes::kNone) sample = {t, kCorners[static_cast<std::size_t>(k)]};
    }
  }
  return samples;
}

// Distances of places of one mesh from another.
class Distances {
 public:
  Distances(const scenes::Mesh& from, const scenes::Mesh& to, float attribute_scale)
      : from_(from), to_(to), tree_(to), squared_scale_(attribute_scale * attribute_scale) {}

  // The nearest triangle, and how far it is. Fast where it is near that of the call before.
  std::pair<std::uint32_t, float> operator()(const Sample& sample) {
    const glm::uvec3& corners = from_.triangles[sample.triangle];
    const Place place = tree_.nearest(at(from_.positions, corners, sample.weights), hint_);
    hint_ = place.triangle;
    const float attributes = difference(from_, corners, sample.weights, to_,
                                        to_.triangles[place.triangle], place.weights);
    return {place.triangle, std::sqrt(place.squared + squared_scale_ * attributes)};
  }

 private:
  const scenes::Mesh &from_, &to_;
  TriangleTree tree_;
  float squared_scale_;
  std::uint32_t hint_ = 0;
};

}  // namespace

SurfaceErrors surface_errors(const FineSurface& fine, const scenes::Mesh& simplified,
                             float attribute_scale) {
  SurfaceErrors errors;
  errors.triangles.assign(simplified.triangles.size(), 0);
  errors.nearest.assign(fine.mesh.positions.size(), scenes::kNone);
  if (fine.mesh.triangles.empty() || simplified.triangles.empty()) return errors;
  const auto before = [&](std::uint32_t t) { return fine.before.empty() ? 0.0F : fine.before[t]; };
  const auto add = [&](std::uint32_t t, float error) {
    errors.triangles[t] = std::max(errors.triangles[t], error);
    errors.largest = std::max(errors.largest, error);
  };
  Distances to_simplified(fine.mesh, simplified, attribute_scale);
  const std::vector<Sample> vertices = vertices_of(fine.mesh);
  std::vector<float> distance(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (vertices[v].triangle == scenes::kNone) continue;
    if (!fine.measured.empty() && fine.measured[v] == 0) continue;
    std::tie(errors.nearest[v], distance[v]) = to_simplified(vertices[v]);
  }
  for (std::uint32_t t = 0; t < fine.mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = fine.mesh.triangles[t][k];
      if (errors.nearest[v] == scenes::kNone) continue;
      add(errors.nearest[v], before(t) + distance[v]);
      // The middle of an edge is no farther from a triangle than its ends, but may be from two.
      const std::uint32_t w = fine.mesh.triangles[t][(k + 1) % 3];
      if (v > w || errors.nearest[w] == scenes::kNone || errors.nearest[v] == errors.nearest[w])
        continue;
      Weights middle{kHalf, kHalf, kHalf};
      middle[(k + 2) % 3] = 0;
      const auto [nearest, far] = to_simplified({t, middle});
      add(nearest, before(t) + far);
    }
  }
  Distances to_fine(simplified, fine.mesh, attribute_scale);
  for (const Sample& sample : middles_of(simplified)) {
    const auto [nearest, far] = to_fine(sample);
    add(sample.triangle, before(nearest) + far);
    errors.beneath.emplace_back(sample.triangle, nearest);
  }
  return errors;
}

float surface_error(const scenes::Mesh& a, const scenes::Mesh& b, float attribute_scale) {
  float largest = 0;
  for (const auto& [from, to] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    if (from->triangles.empty() || to->triangles.empty()) return 0;
    Distances distances(*from, *to, attribute_scale);
    for (const Sample& sample : vertices_of(*from))
      if (sample.triangle != scenes::kNone) largest = std::max(largest, distances(sample).second);
    for (const Sample& sample : middles_of(*from))
      largest = std::max(largest, distances(sample).second);
  }
  return largest;
}

float mean_edge(const scenes::Mesh& mesh) {
  double sum = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      sum += glm::length(glm::dvec3(mesh.positions[t[k]]) -
                         glm::dvec3(mesh.positions[t[(k + 1) % 3]]));
    }
  }
  return mesh.triangles.empty()
             ? 0
             : static_cast<float>(sum / (3.0 * static_cast<double>(mesh.triangles.size())));
}

}  // namespace delray::packs::internal
