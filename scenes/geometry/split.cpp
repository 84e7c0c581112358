// Vertices are split by sorting: of the corners that do not carry their vertex's own label, those
// of one vertex and label come to stand together and share a copy. O(n log n) of those, O(1) of
// others.
#include "scenes/geometry/split.h"

#include <algorithm>
#include <cassert>
#include <tuple>
#include <vector>

namespace delray::scenes::internal {
namespace {

template <class T>
void append_copies(std::vector<T>& attribute, std::span<const std::uint32_t> sources) {
  if (attribute.empty()) return;
  attribute.reserve(attribute.size() + sources.size());
  for (const std::uint32_t source : sources) attribute.push_back(attribute[source]);
}

// A corner that does not keep its vertex.
struct Other {
  std::uint32_t vertex, label, corner;
  auto operator<=>(const Other&) const = default;
};

std::uint32_t& vertex_at(Mesh& mesh, std::size_t corner) {
  return mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
}

std::vector<Other> others(Mesh& mesh, std::span<const std::uint32_t> labels) {
  std::vector<std::uint32_t> first_corner(mesh.positions.size(), kNone);
  std::vector<Other> result;
  for (std::size_t c = 0; c < labels.size(); ++c) {
    const std::uint32_t vertex = vertex_at(mesh, c), corner = static_cast<std::uint32_t>(c);
    if (first_corner[vertex] == kNone) first_corner[vertex] = corner;
    if (labels[c] != labels[first_corner[vertex]]) result.push_back({vertex, labels[c], corner});
  }
  return result;
}

}  // namespace

void split_vertices(Mesh& mesh, std::span<const std::uint32_t> labels) {
  assert(labels.size() == 3 * mesh.triangles.size());
  std::vector<Other> corners = others(mesh, labels);
  std::sort(corners.begin(), corners.end());
  struct Copy {
    std::uint32_t first_corner;
    std::size_t begin, end;  // its corners, in `corners`
  };
  std::vector<Copy> copies;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const bool is_new = i == 0 || std::tie(corners[i].vertex, corners[i].label) !=
                                      std::tie(corners[i - 1].vertex, corners[i - 1].label);
    if (is_new) copies.push_back({corners[i].corner, i, i});
    copies.back().end = i + 1;
  }
  // Copies are numbered in the order of the triangles.
  std::sort(copies.begin(), copies.end(),
            [](const Copy& a, const Copy& b) { return a.first_corner < b.first_corner; });
  std::vector<std::uint32_t> sources;
  for (const Copy& copy : copies) {
    const auto number = static_cast<std::uint32_t>(mesh.positions.size() + sources.size());
    sources.push_back(corners[copy.begin].vertex);
    for (std::size_t i = copy.begin; i < copy.end; ++i) vertex_at(mesh, corners[i].corner) = number;
  }
  append_copies(mesh.positions, sources);
  append_copies(mesh.normals, sources);
  append_copies(mesh.uvs, sources);
  append_copies(mesh.uvs2, sources);
  append_copies(mesh.tangents, sources);
  append_copies(mesh.colours, sources);
}

}  // namespace delray::scenes::internal
