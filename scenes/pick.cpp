// One ray against all primitives, in blocks that threads share: no structure is built, as a person
// clicks seldom. Triangles by Möller and Trumbore (1997) in the space of their mesh; points and
// segments by their distance on the screen.
//
// Degenerate: triangles without area, and those that the ray lies in, are never met.
#include "scenes/pick.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "parallel/parallel_for.h"

namespace delray::scenes {
namespace {

// Primitives that a task looks at: some 50 us.
constexpr std::size_t kTrianglesOfTask = 8192;

struct Ray {
  glm::dvec3 origin, direction;  // its part along the view is 1
};

struct Block {
  std::uint32_t instance = 0;
  std::size_t begin = 0, end = 0;
};

bool is_nearer(const Pick& a, const Pick& b) { return a.depth < b.depth; }

// Whether the ray meets a box before `depth`.
bool meets(const Ray& ray, const geometry::Box3& box) {
  if (box.empty()) return false;
  double from = 0, to = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    const double low = box.low[axis], high = box.high[axis];
    if (d == 0.0) {
      if (o < low || o > high) return false;
      continue;
    }
    const double a = (low - o) / d, b = (high - o) / d;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to * (1 + 1e-9);
}

Ray in_mesh(const Ray& ray, const glm::mat4x3& transform) {
  const glm::dmat3 linear{glm::dvec3(transform[0]), glm::dvec3(transform[1]),
                          glm::dvec3(transform[2])};
  const glm::dmat3 inverse = glm::inverse(linear);
  return {inverse * (ray.origin - glm::dvec3(transform[3])), inverse * ray.direction};
}

class Picker {
 public:
  Picker(const Scene& scene, const View& view, float x, float y)
      : scene_(scene),
        view_(view),
        place_(x, y),
        ray_{glm::dvec3(view.origin(x, y)), glm::dvec3(view.ray(x, y))} {}

  std::optional<Pick> nearest() const {
    const std::vector<Block> blocks = candidates();
    std::vector<std::optional<Pick>> found(blocks.size());
    parallel::parallel_for(0, blocks.size(), 1, [&](std::size_t i) { found[i] = look(blocks[i]); });
    std::optional<Pick> best;
    for (const std::optional<Pick>& one : found)
      if (one && (!best || is_nearer(*one, *best))) best = one;
    return best;
  }

 private:
  const Mesh& mesh_of(std::uint32_t instance) const {
    return scene_.meshes[scene_.instances[instance].mesh];
  }

  // Boxes are worth their while for meshes that are placed often.
  std::vector<geometry::Box3> boxes() const {
    std::vector<std::uint32_t> uses(scene_.meshes.size());
    for (const Instance& instance : scene_.instances) ++uses[instance.mesh];
    std::vector<geometry::Box3> result(scene_.meshes.size());
    parallel::parallel_for(0, result.size(), 1, [&](std::size_t m) {
      if (uses[m] < 2) return;
      for (const glm::vec3& p : scene_.meshes[m].positions) result[m].include(p);
    });
    return result;
  }

  std::vector<Block> candidates() const {
    const std::vector<geometry::Box3> box = boxes();
    std::vector<Block> blocks;
    for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
      const Instance& instance = scene_.instances[i];
      const Mesh& mesh = scene_.meshes[instance.mesh];
      const geometry::Box3& around = box[instance.mesh];
      if (mesh.has_triangles() && !around.empty() &&
          !meets(in_mesh(ray_, instance.transform), around)) {
        continue;
      }
      for (std::size_t begin = 0; begin < mesh.triangles.size(); begin += kTrianglesOfTask)
        blocks.push_back({i, begin, std::min(begin + kTrianglesOfTask, mesh.triangles.size())});
    }
    return blocks;
  }

  std::optional<Pick> look(const Block& block) const {
    const Mesh& mesh = mesh_of(block.instance);
    const glm::mat4x3& transform = scene_.instances[block.instance].transform;
    const Ray ray = in_mesh(ray_, transform);
    std::optional<Pick> best;
    for (std::size_t t = block.begin; t < block.end; ++t) {
      const std::optional<Pick> hit = mesh.has_triangles()
                                          ? meet_triangle(mesh, mesh.triangles[t], ray)
                                          : meet_splat(mesh, mesh.triangles[t], transform);
      if (!hit || !(hit->depth > view_.near) || (best && !is_nearer(*hit, *best))) continue;
      best = hit;
      best->instance = block.instance;
      best->triangle = static_cast<std::uint32_t>(t);
    }
    return best;
  }

  std::optional<Pick> meet_triangle(const Mesh& mesh, const glm::uvec3& corners,
                                    const Ray& ray) const {
    const glm::dvec3 a(mesh.positions[corners.x]), b(mesh.positions[corners.y]),
        c(mesh.positions[corners.z]);
    const glm::dvec3 ab = b - a, ac = c - a, p = glm::cross(ray.direction, ac);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0.0 || !std::isfinite(determinant)) return std::nullopt;
    const glm::dvec3 from = ray.origin - a;
    const double u = glm::dot(from, p) / determinant;
    if (!(u >= 0.0 && u <= 1.0)) return std::nullopt;
    const glm::dvec3 q = glm::cross(from, ab);
    const double v = glm::dot(ray.direction, q) / determinant;
    if (!(v >= 0.0 && u + v <= 1.0)) return std::nullopt;
    Pick hit;
    hit.depth = glm::dot(ac, q) / determinant;
    hit.position = ray_.origin + ray_.direction * hit.depth;
    hit.weights = glm::vec3(1 - u - v, u, v);
    return hit;
  }

  struct OnScreen {
    glm::dvec2 place{0.0};
    double depth = 0, pixels_per_unit = 0;
  };
  OnScreen project(const glm::dvec3& p) const {
    const glm::dvec3 from = p - glm::dvec3(view_.eye);
    OnScreen result;
    result.depth = glm::dot(from, glm::dvec3(view_.forward));
    result.pixels_per_unit = view_.scale / (view_.orthographic ? 1.0 : result.depth);
    result.place = {
        view_.half_width + glm::dot(from, glm::dvec3(view_.right)) * result.pixels_per_unit,
        view_.half_height - glm::dot(from, glm::dvec3(view_.up)) * result.pixels_per_unit};
    return result;
  }

  // A segment from its second to its third corner, or a point where these are one.
  std::optional<Pick> meet_splat(const Mesh& mesh, const glm::uvec3& corners,
                                 const glm::mat4x3& transform) const {
    const auto placed = [&](std::uint32_t i) {
      return glm::dvec3(transform * glm::vec4(mesh.positions[i], 1.0F));
    };
    const glm::dvec3 a = placed(corners.y), b = placed(corners.z);
    const OnScreen from = project(a), to = project(b);
    if (!(from.depth > view_.near && to.depth > view_.near)) return std::nullopt;
    const glm::dvec2 along = to.place - from.place;
    const double length2 = glm::dot(along, along);
    const double t =
        length2 > 0.0 ? std::clamp(glm::dot(place_ - from.place, along) / length2, 0.0, 1.0) : 0.0;
    const double scale = from.pixels_per_unit + (to.pixels_per_unit - from.pixels_per_unit) * t;
    const double reach =
        std::max<double>(kPickReach, mesh.shape.radius * (mesh.shape.in_pixels ? 1.0 : scale));
    if (!(glm::length(place_ - (from.place + along * t)) <= reach)) return std::nullopt;
    Pick hit;
    hit.position = a + (b - a) * t;
    hit.depth = from.depth + (to.depth - from.depth) * t;
    hit.weights = glm::vec3(0, 1 - t, t);
    return hit;
  }

  const Scene& scene_;
  const View& view_;
  glm::dvec2 place_;
  Ray ray_;
};

}  // namespace

std::optional<Pick> pick(const Scene& scene, const View& view, float x, float y) {
  return Picker(scene, view, x, y).nearest();
}

}  // namespace delray::scenes
