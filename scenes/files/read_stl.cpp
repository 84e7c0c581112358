// STL (3D Systems 1989): facets of three corners each, as text or in records of 50 bytes.
//
// Normals of facets are not read: they follow from the corners. Two bytes of a binary facet are a
// colour of 15 bits where the highest is set: red first as SolidView has it, blue first in files of
// Materialise, whose header gives the colour of all other facets after "COLOR=".
#include <array>
#include <cstring>

#include "scenes/files/growth_watch.h"
#include "scenes/files/readers.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/origin.h"
#include "scenes/geometry/weld.h"

namespace delray::scenes::internal {
namespace {

constexpr std::size_t kStlHeader = 84, kFacet = 50;  // bytes

// Adds the triangle of the last three of `corners`.
void add_triangle(std::size_t corners, Mesh& mesh) {
  const auto last = static_cast<std::uint32_t>(corners);
  mesh.triangles.emplace_back(last - 3, last - 2, last - 1);
}

Scene read_text_stl(const Source& source) {
  Mesh mesh;
  std::vector<glm::dvec3> places;
  Lines lines(source.content);
  GrowthWatch watch(source);
  std::string_view line;
  int vertices = 0;
  bool ended = false;
  while (lines.next(line)) {
    watch.step();
    Words words(line);
    const std::string_view key = words.next();
    if (key == "vertex") {
      places.push_back(read_coordinates<3>(source, lines, words));
      ++vertices;
    } else if (key == "facet") {
      vertices = 0;
    } else if (key == "endfacet") {
      if (vertices != 3) {
        source.fail(lines.place(),
                    "the facet has " + std::to_string(vertices) + " vertices, not 3");
      }
      add_triangle(places.size(), mesh);
    } else if (key == "solid" || key == "endsolid") {
      ended = key == "endsolid";
    }
  }
  if (!ended) source.fail(lines.place(), "the file ends before its endsolid");
  source.require_memory(places.size() * sizeof(glm::vec3));
  const glm::dvec3 origin = origin_of(box_of(places));
  mesh.positions = relative_to(origin, places);
  return scene_of(std::move(mesh), origin);
}

// Colours of facets while they are read.
class FacetColours {
 public:
  explicit FacetColours(std::string_view header) {
    constexpr std::string_view kMark = "COLOR=";
    const std::size_t mark = header.find(kMark);
    if (mark == std::string_view::npos || header.size() - mark < kMark.size() + 4) return;
    blue_first_ = any_ = true;
    for (int k = 0; k < 4; ++k) {
      const auto at = mark + kMark.size() + static_cast<std::size_t>(k);
      default_[k] = static_cast<unsigned char>(header[at]) / 255.0;
    }
  }
  // REQUIRES: 50 bytes.
  glm::vec4 operator()(const char* facet) {
    std::uint16_t code = 0;
    std::memcpy(&code, facet + kFacet - sizeof code, sizeof code);
    if ((code & 0x8000U) == 0) return linear_colour(default_);
    any_ = true;
    glm::dvec4 colour((code >> 10 & 31) / 31.0, (code >> 5 & 31) / 31.0, (code & 31) / 31.0, 1);
    if (blue_first_) std::swap(colour.r, colour.b);
    return linear_colour(colour);
  }
  bool any() const { return any_; }

 private:
  glm::dvec4 default_{0.6, 0.6, 0.6, 1};
  bool blue_first_ = false, any_ = false;
};

Scene read_binary_stl(const Source& source, std::uint32_t count) {
  Mesh mesh;
  if (count > kNone / 3) source.fail("byte 80", "a mesh is too large");
  source.require_memory(count * (3 * (sizeof(glm::vec3) + sizeof(glm::vec4)) + sizeof(glm::uvec3)));
  mesh.positions.reserve(std::size_t{count} * 3);
  mesh.triangles.reserve(count);
  FacetColours colour_of(source.content.substr(0, kStlHeader - 4));
  for (std::size_t i = 0; i < count; ++i) {
    const char* facet = source.content.data() + kStlHeader + i * kFacet;
    std::array<float, 9> values{};
    std::memcpy(values.data(), facet + 3 * sizeof(float), sizeof values);
    for (std::size_t k = 0; k < values.size(); k += 3) {
      const glm::vec3 p(values[k], values[k + 1], values[k + 2]);
      if (const char* wrong = wrong_with(p)) source.fail("facet " + std::to_string(i), wrong);
      mesh.positions.push_back(p);
    }
    mesh.colours.insert(mesh.colours.end(), 3, colour_of(facet));
    add_triangle(mesh.positions.size(), mesh);
  }
  if (!colour_of.any()) mesh.colours.clear();
  const geometry::Box3d box = box_of(mesh.positions);
  warn_if_coarse(source, reach_of(box), glm::length(box.size()));
  const glm::dvec3 origin = origin_of(box);
  make_relative_to(origin, mesh.positions);
  return scene_of(std::move(mesh), origin);
}

Scene read_facets(const Source& source) {
  const std::string_view content = source.content;
  if (content.size() >= kStlHeader) {
    std::uint32_t count = 0;
    std::memcpy(&count, content.data() + kStlHeader - sizeof count, sizeof count);
    const std::uint64_t size = kStlHeader + std::uint64_t{count} * kFacet;
    if (size == content.size()) return read_binary_stl(source, count);
    if (!content.starts_with("solid")) {
      source.fail("byte 80", "the header claims " + std::to_string(count) +
                                 " triangles, which are " + std::to_string(size) +
                                 " bytes; the file has " + std::to_string(content.size()));
    }
  }
  if (!content.starts_with("solid")) source.fail("", "this is not an STL file");
  return read_text_stl(source);
}

}  // namespace

Scene read_stl(const Source& source) {
  Scene scene = read_facets(source);
  if (scene.meshes[0].triangles.empty()) source.fail("", kNoTriangles);
  weld(scene.meshes[0]);
  return scene;
}

}  // namespace delray::scenes::internal
