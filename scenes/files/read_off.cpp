// OFF (Geomview's object file format), as text: counts, vertices, faces.
#include "scenes/files/growth_watch.h"
#include "scenes/files/readers.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/origin.h"
#include "scenes/geometry/polygon.h"

namespace delray::scenes::internal {
namespace {

// The words of a file, line by line, without comments.
class OffLines {
 public:
  explicit OffLines(const Source& source) : source_(source), lines_(source.content) {}

  Words next_line(const std::string& what) {
    if (!lines_.next_with_words(line_, '#')) {
      source_.fail("line " + std::to_string(lines_.number() + 1),
                   "the file ends where " + what + " should be");
    }
    return Words(line_);
  }
  std::int64_t count(Words& words, const char* what) const {
    std::int64_t count = 0;
    if (!parse(words.next(), count) || count < 0) {
      fail(std::string("the number of ") + what + " is missing");
    }
    // A vertex, face or corner takes at least two characters.
    if (count > static_cast<std::int64_t>(source_.content.size() / 2)) {
      fail("the header claims " + std::to_string(count) + " " + what +
           ", more than the file has room for");
    }
    return count;
  }
  const Lines& lines() const { return lines_; }
  [[noreturn]] void fail(const std::string& what) const { source_.fail(lines_.place(), what); }

 private:
  const Source& source_;
  Lines lines_;
  std::string_view line_;
};

// The words after the kind of the file, which stand on its line or the next.
Words read_off_header(OffLines& lines) {
  Words words = lines.next_line("the header");
  const std::string_view magic = words.next();
  if (magic.find("OFF") == std::string_view::npos) lines.fail("this is not an OFF file");
  if (magic != "OFF" && magic != "COFF" && magic != "NOFF" && magic != "CNOFF") {
    lines.fail("the variant " + std::string(magic.substr(0, 10)) + " is not supported");
  }
  const std::string_view next = Words(words).next();
  if (next == "BINARY") lines.fail("binary OFF is not supported");
  return next.empty() ? lines.next_line("the counts") : words;
}

void read_off_face(const OffLines& lines, Words& words, std::int64_t vertices, GrowthWatch& watch,
                   std::vector<std::uint32_t>& corners) {
  corners.clear();
  const std::int64_t count = lines.count(words, "corners");
  for (std::int64_t k = 0; k < count; ++k) {
    std::int64_t index = 0;
    if (!parse(words.next(), index)) lines.fail("an index of a face is missing");
    if (index < 0 || index >= vertices) {
      lines.fail("there is no vertex " + std::to_string(index) + " (" + std::to_string(vertices) +
                 " vertices, from 0)");
    }
    watch.step();
    corners.push_back(static_cast<std::uint32_t>(index));
  }
}

}  // namespace

Scene read_off(const Source& source) {
  OffLines lines(source);
  Words counts = read_off_header(lines);
  const std::int64_t vertices = lines.count(counts, "vertices");
  const std::int64_t faces = lines.count(counts, "faces");
  if (vertices >= kNone) lines.fail("a mesh is too large");
  std::vector<glm::dvec3> places;
  GrowthWatch watch(source);
  for (std::int64_t i = 0; i < vertices; ++i) {
    watch.step();
    Words words =
        lines.next_line("vertex " + std::to_string(i) + " of " + std::to_string(vertices));
    places.push_back(read_coordinates<3>(source, lines.lines(), words));
  }
  source.require_memory(places.size() * sizeof(glm::vec3));
  const glm::dvec3 origin = origin_of(box_of(places));
  Mesh mesh;
  mesh.positions = relative_to(origin, places);
  std::vector<glm::dvec3>().swap(places);
  std::vector<std::uint32_t> corners;
  std::int64_t left_out = 0;
  for (std::int64_t i = 0; i < faces; ++i) {
    Words words = lines.next_line("face " + std::to_string(i) + " of " + std::to_string(faces));
    read_off_face(lines, words, vertices, watch, corners);
    if (corners.size() < 3) ++left_out;
    triangulate_polygon(corners, mesh.positions, mesh.triangles);
  }
  if (left_out == faces) source.fail("", kNoTriangles);
  if (left_out > 0) source.warn(std::to_string(left_out) + " points and lines left out");
  return scene_of(std::move(mesh), origin);
}

}  // namespace delray::scenes::internal
