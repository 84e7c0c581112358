// Bends meshes vertex by vertex in double precision: displacements of morph targets, then the
// weighted sum of the joints' transforms (linear blend skinning, Magnenat-Thalmann et al. 1988),
// normals by its cofactors. Normals that the file does not have are summed over triangles.
#include "scenes/animation/deform.h"

#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "parallel/parallel_for.h"
#include "scenes/geometry/normals.h"

namespace delray::scenes::internal {
namespace {

constexpr std::size_t kVerticesPerBlock = 4096;  // some hundred microseconds with a skin
constexpr double kLargest = 1e18;

glm::vec3 unit_or_z(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : glm::vec3(0, 0, 1);
}

// The targets that displace anything, with their weights.
struct ActiveTarget {
  const MorphTarget* target;
  double weight;
};

std::vector<ActiveTarget> active_targets(const Deformation& deformation,
                                         std::span<const double> weights) {
  std::vector<ActiveTarget> active;
  for (std::size_t k = 0; k < deformation.targets.size(); ++k)
    if (weights[k] != 0) active.push_back({&deformation.targets[k], weights[k]});
  return active;
}

template <class Of>
glm::dvec3 displaced(glm::dvec3 v, std::span<const ActiveTarget> active, std::size_t i, Of&& of) {
  for (const ActiveTarget& a : active) {
    const std::vector<glm::vec3>& values = of(*a.target);
    if (!values.empty()) v += a.weight * glm::dvec3(values[i]);
  }
  return v;
}

// Of normals: the transform times this keeps them at right angles to the surface.
glm::dmat3 cofactors_of(const glm::dmat3& m) {
  const glm::dmat3 c(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::dot(m[0], c[0]) < 0 ? -c : c;
}

// Area-weighted, in the order of the triangles.
void sum_normals(const DeformedMesh& deformed, Mesh& mesh) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0));
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 p(mesh.positions[t.x]);
    const glm::dvec3 area =
        glm::cross(glm::dvec3(mesh.positions[t.y]) - p, glm::dvec3(mesh.positions[t.z]) - p);
    for (int k = 0; k < 3; ++k) sums[deformed.normal_groups[t[k]]] += area;
  }
  parallel::parallel_for(0, sums.size(), kVerticesPerBlock, [&](std::size_t i) {
    mesh.normals[i] = unit_or_z(sums[deformed.normal_groups[i]]);
  });
}

}  // namespace

bool deform(const DeformedMesh& deformed, std::span<const double> weights,
            std::span<const glm::dmat4> joints, Mesh& mesh) {
  const Deformation& by = deformed.deformation;
  const std::vector<ActiveTarget> active = active_targets(by, weights);
  const bool has_normals = !deformed.normals.empty() && deformed.normal_groups.empty();
  const bool has_tangents = !deformed.tangents.empty();
  std::atomic<bool> fits = true;
  parallel::parallel_blocks(
      0, deformed.positions.size(), kVerticesPerBlock, [&](std::size_t first, std::size_t last) {
        bool all_fit = true;
        for (std::size_t i = first; i < last; ++i) {
          glm::dvec3 p = displaced(
              glm::dvec3(deformed.positions[i]), active, i,
              [](const MorphTarget& t) -> auto& { return t.positions; });
          glm::dvec3 n(0), t(0);
          if (has_normals) {
            n = displaced(
                glm::dvec3(deformed.normals[i]), active, i,
                [](const MorphTarget& target) -> auto& { return target.normals; });
          }
          if (has_tangents) {
            t = displaced(
                glm::dvec3(deformed.tangents[i]), active, i,
                [](const MorphTarget& target) -> auto& { return target.tangents; });
          }
          if (by.influences > 0) {
            glm::dmat4 sum(0.0);
            for (std::size_t k = i * by.influences; k < (i + 1) * by.influences; ++k)
              if (by.weights[k] != 0) sum += joints[by.joints[k]] * double{by.weights[k]};
            p = glm::dvec3(sum * glm::dvec4(p, 1.0));
            const glm::dmat3 linear(sum);
            if (has_normals) n = cofactors_of(linear) * n;
            if (has_tangents) t = linear * t;
          }
          p -= deformed.origin;
          const double reach = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
          all_fit = all_fit && reach <= kLargest && p == p;
          mesh.positions[i] = p;
          if (has_normals) mesh.normals[i] = unit_or_z(n);
          if (has_tangents) mesh.tangents[i] = glm::vec4(unit_or_z(t), deformed.tangents[i].w);
        }
        if (!all_fit) fits = false;
      });
  if (!deformed.normal_groups.empty()) sum_normals(deformed, mesh);
  return fits;
}

namespace {

// The vertex that each vertex of a mesh was before `split` appended copies of some.
template <class F>
std::vector<std::uint32_t> sources_of(Mesh& mesh, F&& split) {
  // Its number travels in an attribute that splitting copies and nothing else looks at: 24 bits
  // and 8, which are exact in single precision.
  std::vector<glm::vec4> colours = std::move(mesh.colours);
  mesh.colours.clear();
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i)
    mesh.colours.emplace_back(i & 0xFFFFFFU, i >> 24U, 0, 0);
  split(mesh);
  std::vector<std::uint32_t> sources(mesh.positions.size());
  for (std::size_t i = 0; i < sources.size(); ++i) {
    sources[i] = static_cast<std::uint32_t>(mesh.colours[i].x) |
                 static_cast<std::uint32_t>(mesh.colours[i].y) << 24U;
  }
  mesh.colours.clear();
  if (colours.empty()) return sources;
  for (const std::uint32_t source : sources) mesh.colours.push_back(colours[source]);
  return sources;
}

template <class T>
void append_sources(std::vector<T>& values, std::span<const std::uint32_t> sources,
                    std::size_t width = 1) {
  if (values.empty()) return;
  for (std::size_t i = values.size() / width; i < sources.size(); ++i)
    for (std::size_t k = 0; k < width; ++k) values.push_back(values[sources[i] * width + k]);
}

// Vertices at one place with one normal, which a seam of texture coordinates parts.
std::vector<std::uint32_t> normal_groups_of(const Mesh& mesh) {
  struct Hash {
    std::size_t operator()(const std::array<glm::vec3, 2>& key) const {
      std::size_t hash = 0;
      for (const glm::vec3& v : key)
        for (int k = 0; k < 3; ++k)
          hash = hash * 0x9E3779B97F4A7C15U + std::hash<float>{}(v[k] + 0.0F);
      return hash;
    }
  };
  std::unordered_map<std::array<glm::vec3, 2>, std::uint32_t, Hash> first;
  first.reserve(mesh.positions.size());
  std::vector<std::uint32_t> groups(mesh.positions.size());
  for (std::uint32_t i = 0; i < groups.size(); ++i)
    groups[i] = first.try_emplace({mesh.positions[i], mesh.normals[i]}, i).first->second;
  return groups;
}

void append_sources(std::span<const std::uint32_t> sources, Deformation& by) {
  for (MorphTarget& target : by.targets) {
    append_sources(target.positions, sources);
    append_sources(target.normals, sources);
    append_sources(target.tangents, sources);
  }
  append_sources(by.joints, sources, by.influences);
  append_sources(by.weights, sources, by.influences);
}

}  // namespace

DeformedMesh make_deformed(Mesh& mesh, Deformation&& deformation, const Completion& completion) {
  DeformedMesh deformed;
  Deformation& by = deformed.deformation = std::move(deformation);
  if (mesh.normals.empty() && mesh.has_triangles()) {
    append_sources(sources_of(mesh, [&](Mesh& m) { compute_normals(m, completion.crease_cosine); }),
                   by);
    deformed.normal_groups = normal_groups_of(mesh);
  }
  const int set = completion.tangents_of_set;
  const bool has_coordinates = set >= 0 && !mesh.uvs_of(set).empty();
  if (has_coordinates && mesh.tangents.empty() && mesh.has_triangles()) {
    const std::vector<std::uint32_t> sources =
        sources_of(mesh, [&](Mesh& m) { compute_tangents(m, set); });
    append_sources(sources, by);
    append_sources(deformed.normal_groups, sources);
  }
  deformed.positions = mesh.positions;
  deformed.normals = mesh.normals;
  deformed.tangents = mesh.tangents;
  return deformed;
}

}  // namespace delray::scenes::internal
