#include "scenes/internal/split.h"

#include <cassert>
#include <vector>

namespace delray::scenes::internal {
namespace {

template <class T>
void append_copies(std::vector<T>& attribute, std::span<const std::uint32_t> sources) {
  if (attribute.empty()) return;
  attribute.reserve(attribute.size() + sources.size());
  for (const std::uint32_t source : sources) attribute.push_back(attribute[source]);
}

}  // namespace

void split_vertices(Mesh& mesh, std::span<const std::uint32_t> labels) {
  assert(labels.size() == 3 * mesh.triangles.size());
  constexpr std::uint32_t kNoLabel = 0xFFFFFFFFU;
  // label[v]: what vertex v stands for; next[v]: the next copy of the same vertex.
  std::vector<std::uint32_t> label(mesh.positions.size(), kNoLabel);
  std::vector<std::uint32_t> next(mesh.positions.size(), kNone);
  std::vector<std::uint32_t> sources;
  for (std::size_t c = 0; c < labels.size(); ++c) {
    std::uint32_t& corner = mesh.triangles[c / 3][static_cast<int>(c % 3)];
    const std::uint32_t original = corner;
    if (label[original] == kNoLabel) label[original] = labels[c];
    std::uint32_t vertex = original;
    while (label[vertex] != labels[c] && next[vertex] != kNone) vertex = next[vertex];
    if (label[vertex] != labels[c]) {
      const auto copy = static_cast<std::uint32_t>(label.size());
      next[vertex] = copy;
      label.push_back(labels[c]);
      next.push_back(kNone);
      sources.push_back(original);
      vertex = copy;
    }
    corner = vertex;
  }
  append_copies(mesh.positions, sources);
  append_copies(mesh.normals, sources);
  append_copies(mesh.uvs, sources);
  append_copies(mesh.tangents, sources);
  append_copies(mesh.colours, sources);
}

}  // namespace delray::scenes::internal
