// STL (3D Systems 1989): facets of three corners each, as text or in records of 50 bytes.
//
// Normals of facets are not read: they follow from the corners. Two bytes of a binary facet are a
// colour of 15 bits where the highest is set: red first as SolidView has it, blue first in files of
// Materialise, whose header gives the colour of all other facets after "COLOR=".
#include <algorithm>
#include <atomic>
#include <cstring>

#include "parallel/grow.h"
#include "scenes/files/for_each_block.h"
#include "scenes/files/readers.h"
#include "scenes/files/stl_text.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/origin.h"
#include "scenes/geometry/weld.h"

namespace delray::scenes::internal {
namespace {

constexpr std::size_t kStlHeader = 84, kFacet = 50;  // bytes

constexpr std::size_t kFacetsPerBlock = 1 << 12;  // some ten microseconds, and in the cache

// Two bytes of a facet. REQUIRES: 50 bytes.
std::uint16_t colour_code(const char* facet) {
  std::uint16_t code = 0;
  std::memcpy(&code, facet + kFacet - sizeof code, sizeof code);
  return code;
}

constexpr std::uint32_t kHasColour = 0x8000;  // of a code

// What the header says of the facets' colours.
class FacetColours {
 public:
  explicit FacetColours(std::string_view header) {
    constexpr std::string_view kMark = "COLOR=";
    const std::size_t mark = header.find(kMark);
    if (mark == std::string_view::npos || header.size() - mark < kMark.size() + 4) return;
    of_materialise_ = true;
    for (int k = 0; k < 4; ++k) {
      const auto at = mark + kMark.size() + static_cast<std::size_t>(k);
      default_[k] = static_cast<unsigned char>(header[at]) / 255.0;
    }
  }
  glm::vec4 of(std::uint16_t code) const {
    if ((code & kHasColour) == 0) return linear_colour(default_);
    glm::dvec4 colour((code >> 10 & 31) / 31.0, (code >> 5 & 31) / 31.0, (code & 31) / 31.0, 1);
    if (of_materialise_) std::swap(colour.r, colour.b);
    return linear_colour(colour);
  }
  // The header gives one to all facets.
  bool any() const { return of_materialise_; }

 private:
  glm::dvec4 default_{0.6, 0.6, 0.6, 1};
  bool of_materialise_ = false;
};

// Calls f(number, facet) for all facets, a block at a time in parallel.
template <class F>
void for_each_facet(const files::FileBytes& bytes, std::uint32_t count, F&& f) {
  for_each_block((count + kFacetsPerBlock - 1) / kFacetsPerBlock, [&](std::size_t block) {
    std::string buffer;
    const std::size_t first = block * kFacetsPerBlock;
    const std::size_t last = std::min<std::size_t>(count, first + kFacetsPerBlock);
    const char* facet =
        bytes.read(kStlHeader + first * kFacet, (last - first) * kFacet, buffer).data();
    for (std::size_t i = first; i < last; ++i, facet += kFacet) f(i, facet);
  });
}

Scene read_binary_stl(const Source& source, const files::FileBytes& bytes, std::uint32_t count) {
  Mesh mesh;
  if (count > kNone / 3) source.fail("byte 80", "a mesh is too large");
  source.require_memory(count * (3 * (sizeof(glm::vec3) + sizeof(glm::vec4)) + sizeof(glm::uvec3)));
  parallel::grow(mesh.positions, std::size_t{count} * 3);
  parallel::grow(mesh.triangles, count);
  std::string buffer;
  const FacetColours colours(bytes.read(0, kStlHeader - 4, buffer));
  std::atomic<bool> coloured{colours.any()};
  for_each_facet(bytes, count, [&](std::size_t i, const char* facet) {
    for (std::size_t k = 0; k < 3; ++k) {
      glm::vec3 p;
      std::memcpy(&p, facet + (k + 1) * sizeof p, sizeof p);
      if (const char* wrong = wrong_with(p)) source.fail("facet " + std::to_string(i), wrong);
      mesh.positions[3 * i + k] = p;
    }
    const auto corner = static_cast<std::uint32_t>(3 * i);
    mesh.triangles[i] = {corner, corner + 1, corner + 2};
    if ((colour_code(facet) & kHasColour) != 0) coloured.store(true, std::memory_order_relaxed);
  });
  if (coloured) {
    parallel::grow(mesh.colours, mesh.positions.size());
    for_each_facet(bytes, count, [&](std::size_t i, const char* facet) {
      std::fill_n(&mesh.colours[3 * i], 3, colours.of(colour_code(facet)));
    });
  }
  const geometry::Box3d box = box_of(mesh.positions);
  warn_if_coarse(source, reach_of(box), glm::length(box.size()));
  const glm::dvec3 origin = origin_of(box);
  make_relative_to(origin, mesh.positions);
  return scene_of(std::move(mesh), origin);
}

Scene read_facets(const Source& source) {
  const files::FileBytes bytes = source.bytes();
  std::string buffer;
  const std::string_view start =
      bytes.read(0, std::min<std::uint64_t>(bytes.size(), kStlHeader), buffer);
  if (start.size() >= kStlHeader) {
    std::uint32_t count = 0;
    std::memcpy(&count, start.data() + kStlHeader - sizeof count, sizeof count);
    const std::uint64_t size = kStlHeader + std::uint64_t{count} * kFacet;
    if (size == bytes.size()) return read_binary_stl(source, bytes, count);
    if (!start.starts_with("solid")) {
      source.fail("byte 80", "the header claims " + std::to_string(count) +
                                 " triangles, which are " + std::to_string(size) +
                                 " bytes; the file has " + std::to_string(bytes.size()));
    }
  }
  if (!start.starts_with("solid")) source.fail("", "this is not an STL file");
  return read_stl_text(source, bytes);
}

}  // namespace

Scene read_stl(const Source& source) {
  Scene scene = read_facets(source);
  if (scene.meshes[0].triangles.empty()) source.fail("", kNoTriangles);
  weld(scene.meshes[0]);
  return scene;
}

}  // namespace delray::scenes::internal
