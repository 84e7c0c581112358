// STL (3D Systems 1989): facets of three corners each, as text or in records of 50 bytes.
//
// Normals of facets are not read: they follow from the corners. Two bytes of a binary facet are a
// colour of 15 bits where the highest is set: red first as SolidView has it, blue first in files of
// Materialise, whose header gives the colour of all other facets after "COLOR=".
//
// Ranges of lines of text are read at the same time, each from its first line that begins a facet
// on: what is before belongs to a facet of an earlier range, and is read when that is known. Where
// something is wrong the text is read once more, as a whole, for the number of the line.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <optional>

#include "files/line_ranges.h"
#include "parallel/grow.h"
#include "parallel/parallel_for.h"
#include "scenes/files/for_each_block.h"
#include "scenes/files/growth_watch.h"
#include "scenes/files/readers.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/origin.h"
#include "scenes/geometry/weld.h"

namespace delray::scenes::internal {
namespace {

constexpr std::size_t kStlHeader = 84, kFacet = 50;  // bytes

constexpr std::size_t kFacetsPerBlock = 1 << 12;  // some ten microseconds, and in the cache

constexpr std::uint64_t kRangeOfFacets = std::uint64_t{1} << 19;  // bytes: some milliseconds

// Some lines that follow each other.
struct StlPart {
  std::vector<glm::dvec3> places;
  std::vector<std::size_t> ends;  // by triangle: how many places there are up to its last corner
  std::uint64_t vertices = 0;     // since the last facet began, behind the last line
  std::optional<bool> is_ended;   // the last of solid and endsolid is the latter; if there is any
};

// `vertices`: since the last facet began, before the first line.
StlPart read_lines(const Source& source, Lines lines, std::uint64_t vertices) {
  StlPart part;
  GrowthWatch watch(source);
  std::string_view line;
  while (lines.next(line)) {
    watch.step();
    Words words(line);
    const std::string_view key = words.next();
    if (key == "vertex") {
      part.places.push_back(read_coordinates<3>(source, lines, words));
      ++vertices;
    } else if (key == "facet") {
      vertices = 0;
    } else if (key == "endfacet") {
      if (vertices != 3) {
        source.fail(lines.place(),
                    "the facet has " + std::to_string(vertices) + " vertices, not 3");
      }
      part.ends.push_back(part.places.size());
    } else if (key == "solid" || key == "endsolid") {
      part.is_ended = key == "endsolid";
    }
  }
  part.vertices = vertices;
  return part;
}

// Where the first line begins that begins a facet; the end where none does.
std::size_t first_facet(std::string_view text) {
  Lines lines(text);
  std::string_view line;
  while (lines.next(line))
    if (Words(line).next() == "facet") return static_cast<std::size_t>(line.data() - text.data());
  return text.size();
}

std::vector<StlPart> read_ranges(const Source& source, const files::FileBytes& bytes) {
  const files::LineRanges ranges(bytes, 0, kRangeOfFacets);
  std::vector<StlPart> facets(ranges.ranges());
  std::vector<std::string> before(facets.size());  // what comes before the first facet
  std::vector<std::uint8_t> has_facets(facets.size());
  for_each_block(facets.size(), [&](std::size_t i) {
    std::string buffer;
    const std::string_view text = ranges.read(i, buffer);
    const std::size_t first = first_facet(text);
    // A line that makes a place of 24 bytes has 13 at least. Ranges are too short for GrowthWatch.
    source.require_memory(first + 2 * text.size());
    before[i] = text.substr(0, first);
    has_facets[i] = first < text.size();
    facets[i] = read_lines(source, Lines(text.substr(first)), 0);
  });
  std::vector<StlPart> parts;
  std::uint64_t vertices = 0;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    parts.push_back(read_lines(source, Lines(before[i]), vertices));
    if (has_facets[i] != 0) parts.push_back(std::move(facets[i]));
    vertices = parts.back().vertices;
  }
  return parts;
}

bool are_ended(const std::vector<StlPart>& parts) {
  bool ended = false;
  for (const StlPart& part : parts) ended = part.is_ended.value_or(ended);
  return ended;
}

// All parts behind each other.
Scene join(const Source& source, std::vector<StlPart>&& parts) {
  std::vector<std::size_t> places = {0}, triangles = {0};
  for (const StlPart& part : parts) {
    places.push_back(places.back() + part.places.size());
    triangles.push_back(triangles.back() + part.ends.size());
  }
  if (places.back() >= kNone) source.fail("", "a mesh is too large");
  source.require_memory(places.back() * sizeof(glm::vec3) + triangles.back() * sizeof(glm::uvec3));
  std::vector<geometry::Box3d> boxes(parts.size());
  parallel::parallel_for(0, parts.size(), 1,
                         [&](std::size_t i) { boxes[i] = box_of(parts[i].places); });
  geometry::Box3d box;
  for (const geometry::Box3d& one : boxes) box.include(one);
  const glm::dvec3 origin = origin_of(box);
  Mesh mesh;
  parallel::grow(mesh.positions, places.back());
  parallel::grow(mesh.triangles, triangles.back());
  parallel::parallel_for(0, parts.size(), 1, [&](std::size_t i) {
    const StlPart part = std::move(parts[i]);
    for (std::size_t k = 0; k < part.places.size(); ++k)
      mesh.positions[places[i] + k] = glm::vec3(part.places[k] - origin);
    for (std::size_t k = 0; k < part.ends.size(); ++k) {
      const auto end = static_cast<std::uint32_t>(places[i] + part.ends[k]);
      mesh.triangles[triangles[i] + k] = {end - 3, end - 2, end - 1};
    }
  });
  return scene_of(std::move(mesh), origin);
}

// As one part.
std::vector<StlPart> read_whole(const Source& source, const files::FileBytes& bytes) {
  std::string buffer;
  const std::string_view text = bytes.read(0, bytes.size(), buffer);
  std::vector<StlPart> parts;
  parts.push_back(read_lines(source, Lines(text), 0));
  if (are_ended(parts)) return parts;
  Lines lines(text);
  std::string_view line;
  while (lines.next(line)) {
  }
  source.fail(lines.place(), "the file ends before its endsolid");
}

Scene read_stl_text(const Source& source, const files::FileBytes& bytes) {
  std::vector<StlPart> parts;
  try {
    parts = read_ranges(source, bytes);
  } catch (const files::FileError& error) {
    if (error.cause() == files::Cause::memory) throw;
    parts.clear();
  }
  if (!are_ended(parts)) parts = read_whole(source, bytes);
  return join(source, std::move(parts));
}

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
