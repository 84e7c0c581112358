// The text of an OBJ file: its vertices, and where everything else is.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "files/line_ranges.h"
#include "geometry/box.h"
#include "scenes/files/source.h"
#include "scenes/files/text_lines.h"

namespace delray::scenes::internal {

using ObjCounts = std::array<std::int64_t, 3>;  // of v, vt and vn
inline constexpr std::array<std::string_view, 3> kObjVertexKeys = {"v", "vt", "vn"};

// A line that is neither a vertex nor an element (face, line or points).
struct ObjCommand {
  enum Kind : std::uint8_t { library, material } kind;
  std::uint64_t elements_before;  // in its range
  std::string name;
};

// What there is in a range of lines.
struct ObjRange {
  ObjCounts counts{};
  std::vector<ObjCommand> commands;
  std::uint64_t elements = 0, splats = 0, free_forms = 0;  // splats: elements that are no faces
};

// Vertices of all ranges behind each other; those without colour are white.
struct ObjVertices {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> colours;  // of positions, if any has one
  std::vector<glm::vec2> uvs;
  glm::dvec3 origin{0.0};  // that positions are relative to
};

class ObjText {
 public:
  // Reads the text once, but for what stands on the lines of elements; where vertices are far from
  // 0, twice. Parallel. Refers to the source. Throws FileError.
  explicit ObjText(const Source& source);

  const Source& source() const { return source_; }
  std::vector<ObjRange>& ranges() { return ranges_; }
  const std::vector<ObjRange>& ranges() const { return ranges_; }
  ObjVertices& vertices() { return vertices_; }
  const ObjVertices& vertices() const { return vertices_; }
  // Of vertices before a range, and of all.
  const ObjCounts& before(std::size_t range) const { return before_[range]; }
  const ObjCounts& all() const { return before_.back(); }

  // The lines of a range, continued ones joined, in `buffer` where that is needed.
  std::string_view text_of(std::size_t range, std::string& buffer) const;

  // Calls f(lines) for the lines of a range, of which the numbers in messages are right although
  // they are not known: then the range is read once more.
  template <class F>
  void with_lines(std::size_t range, F&& f) const {
    std::string buffer;
    const std::string_view text = text_of(range, buffer);
    try {
      f(Lines(text));
    } catch (const files::FileError& error) {
      if (error.cause() == files::Cause::memory) throw;
      f(Lines(text, lines_before(range)));
      throw;
    }
  }

 private:
  struct RangeVertices {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> colours;  // of positions, as many as the last that has one
    std::vector<glm::vec2> uvs;
    geometry::Box3d box;  // of positions, in double precision
  };

  std::uint64_t lines_before(std::size_t range) const;
  void read_range(std::size_t number, const glm::dvec3& origin);
  void read_line(std::string_view key, Words& words, const Lines& lines, const glm::dvec3& origin,
                 ObjRange& range, RangeVertices& vertices) const;
  static void add_position(const glm::dvec3& p, const glm::dvec3& origin, RangeVertices& vertices);
  static void read_vertex_colour(Words words, RangeVertices& vertices);
  void join_vertices();

  const Source& source_;
  files::FileBytes bytes_;
  files::LineRanges lines_;
  std::vector<ObjRange> ranges_;
  std::vector<RangeVertices> parts_;  // of ranges, until they are joined
  std::vector<ObjCounts> before_;
  ObjVertices vertices_;
};

// Skips blanks; whether a word ends there.
inline const char* skip_blanks(const char* at, const char* end) {
  while (at != end && (*at == ' ' || *at == '\t')) ++at;
  return at;
}
inline bool is_word_end(const char* at, const char* end) {
  return at == end || *at == ' ' || *at == '\t';
}

}  // namespace delray::scenes::internal
