// Finds equal vertices by a hash over the bits of all attributes.
// Degenerate: 0 and -0 differ, and equal NaN are equal, as bits are what is compared.
#include "scenes/geometry/weld.h"

#include <bit>
#include <numeric>

#include "parallel/grow.h"
#include "parallel/parallel_for.h"
#include "scenes/geometry/first_of_equal.h"
#include "scenes/geometry/noise.h"

namespace delray::scenes::internal {
namespace {

constexpr std::size_t kWeldBlock = 1 << 12;  // tens of microseconds

template <class T>
std::uint64_t hash_value(std::uint64_t hash, const std::vector<T>& values, std::size_t i) {
  if (values.empty()) return hash;
  for (int k = 0; k < T::length(); ++k) {
    hash = scatter(hash ^ std::bit_cast<std::uint32_t>(values[i][k]));
  }
  return hash;
}

template <class T>
bool same(const std::vector<T>& values, std::size_t i, std::size_t j) {
  if (values.empty()) return true;
  for (int k = 0; k < T::length(); ++k) {
    const auto bits = [&](std::size_t at) { return std::bit_cast<std::uint32_t>(values[at][k]); };
    if (bits(i) != bits(j)) return false;
  }
  return true;
}

template <class T>
void keep(std::vector<T>& values, const std::vector<std::uint32_t>& kept) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
  values.resize(kept.size());
}

}  // namespace

std::vector<std::uint32_t> weld(Mesh& mesh) {
  const std::size_t n = mesh.positions.size();
  const auto hash = [&mesh](std::size_t i) {
    std::uint64_t h = hash_value(0, mesh.positions, i);
    h = hash_value(h, mesh.normals, i);
    h = hash_value(h, mesh.uvs, i);
    h = hash_value(h, mesh.uvs2, i);
    h = hash_value(h, mesh.tangents, i);
    return hash_value(h, mesh.colours, i);
  };
  const auto equal = [&mesh](std::size_t i, std::size_t j) {
    return same(mesh.positions, i, j) && same(mesh.normals, i, j) && same(mesh.uvs, i, j) &&
           same(mesh.uvs2, i, j) && same(mesh.tangents, i, j) && same(mesh.colours, i, j);
  };
  std::vector<std::uint32_t> new_index;
  {
    FirstOfEqual first(n, hash, equal);
    first.insert_all();
    if (first.distinct() < n) {
      parallel::grow(new_index, n);
      parallel::parallel_for(0, n, kWeldBlock, [&](std::size_t i) {
        new_index[i] = first.find(static_cast<std::uint32_t>(i));
      });
    }
  }
  if (new_index.empty()) {  // all differ
    new_index.resize(n);
    std::iota(new_index.begin(), new_index.end(), 0U);
    return new_index;
  }
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < n; ++i) {
    if (new_index[i] == i) {
      new_index[i] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(i);
    } else {
      new_index[i] = new_index[new_index[i]];
    }
  }
  keep(mesh.positions, kept);
  keep(mesh.normals, kept);
  keep(mesh.uvs, kept);
  keep(mesh.uvs2, kept);
  keep(mesh.tangents, kept);
  keep(mesh.colours, kept);
  parallel::parallel_for(0, mesh.triangles.size(), kWeldBlock, [&](std::size_t i) {
    glm::uvec3& t = mesh.triangles[i];
    t = {new_index[t.x], new_index[t.y], new_index[t.z]};
  });
  return new_index;
}

}  // namespace delray::scenes::internal
