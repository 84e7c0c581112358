// Ranges of lines are read at the same time, each from its first line that begins a facet on: what
// is before belongs to a facet of an earlier range, and is read when that is known. Where something
// is wrong the text is read once more, as a whole, for the number of the line.
#include "scenes/files/stl_text.h"

#include <optional>

#include "files/line_ranges.h"
#include "parallel/grow.h"
#include "parallel/parallel_for.h"
#include "scenes/files/for_each_block.h"
#include "scenes/files/growth_watch.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/origin.h"

namespace delray::scenes::internal {
namespace {

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
    source.require_memory(first);
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

}  // namespace

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

}  // namespace delray::scenes::internal
