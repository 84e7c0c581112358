// Ranges of lines are read at the same time; most lines of vertices are three short numbers.
#include "scenes/files/obj_text.h"

#include <algorithm>

#include "parallel/grow.h"
#include "parallel/parallel_for.h"
#include "scenes/files/for_each_block.h"
#include "scenes/files/growth_watch.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/origin.h"

namespace delray::scenes::internal {
namespace {

constexpr std::uint64_t kRangeBytes = std::uint64_t{1} << 19;  // some milliseconds

// A backslash at the end of a line continues it; blanks instead leave one long line.
void join_continued_lines(std::string& text) {
  for (std::size_t i = text.find('\\'); i != std::string::npos; i = text.find('\\', i + 1)) {
    std::size_t end = i + 1;
    while (end < text.size() && text[end] == '\r') ++end;
    if (end < text.size() && text[end] == '\n') std::fill(&text[i], &text[end] + 1, ' ');
  }
}

// Three numbers and nothing else, which is what most lines of vertices are.
bool read_three(std::string_view words, glm::dvec3& p) {
  const char *at = words.data(), *const end = at + words.size();
  for (int k = 0; k < 3; ++k) {
    at = files::read_short_decimal(skip_blanks(at, end), end, p[k]);
    if (at == nullptr || !is_word_end(at, end)) return false;
  }
  return skip_blanks(at, end) == end && wrong_with(p) == nullptr;
}

template <class T>
void move_to(std::vector<T>& from, std::int64_t at, std::vector<T>& to) {
  if (!from.empty()) std::ranges::copy(from, to.begin() + at);
  std::vector<T>().swap(from);
}

}  // namespace

ObjText::ObjText(const Source& source)
    : source_(source),
      bytes_(source.bytes()),
      lines_(bytes_, 0, kRangeBytes, '\\'),
      ranges_(lines_.ranges()),
      parts_(ranges_.size()) {
  for_each_block(ranges_.size(), [&](std::size_t i) { read_range(i, glm::dvec3(0)); });
  join_vertices();
}

std::string_view ObjText::text_of(std::size_t range, std::string& buffer) const {
  const std::string_view text = lines_.read(range, buffer);
  if (text.find('\\') == text.npos) return text;
  std::string joined(text);
  join_continued_lines(joined);
  buffer = std::move(joined);
  return buffer;
}

// Reads them again, for messages.
std::uint64_t ObjText::lines_before(std::size_t range) const {
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < range; ++i) {
    std::string buffer;
    std::string_view line;
    Lines lines(text_of(i, buffer));
    while (lines.next(line)) {
    }
    before += lines.number();
  }
  return before;
}

// Relative to the origin.
void ObjText::read_range(std::size_t number, const glm::dvec3& origin) {
  with_lines(number, [&](Lines lines) {
    ObjRange& range = ranges_[number] = ObjRange();
    RangeVertices& vertices = parts_[number] = RangeVertices();
    GrowthWatch watch(source_);
    std::string_view line;
    while (lines.next(line)) {
      watch.step();
      if (line.starts_with("v ")) {
        glm::dvec3 p;
        if (read_three(line.substr(2), p)) {
          add_position(p, origin, vertices);
          continue;
        }
      }
      Words words(line);
      read_line(words.next(), words, lines, origin, range, vertices);
    }
    range.counts = {static_cast<std::int64_t>(vertices.positions.size()),
                    static_cast<std::int64_t>(vertices.uvs.size()),
                    static_cast<std::int64_t>(vertices.normals.size())};
  });
}

void ObjText::add_position(const glm::dvec3& p, const glm::dvec3& origin, RangeVertices& vertices) {
  vertices.box.include(p);
  if (vertices.positions.empty()) vertices.positions.reserve(kRangeBytes / 8);  // "v 0 0 0\n"
  vertices.positions.emplace_back(p - origin);
}

void ObjText::read_line(std::string_view key, Words& words, const Lines& lines,
                        const glm::dvec3& origin, ObjRange& range, RangeVertices& vertices) const {
  if (key == "v") {
    add_position(read_coordinates<3>(source_, lines, words), origin, vertices);
    read_vertex_colour(words, vertices);
  } else if (key == "vt") {
    const float u = static_cast<float>(read_coordinates<1>(source_, lines, words).x);
    const bool has_v = !Words(words).next().empty();
    const double v = has_v ? read_coordinates<1>(source_, lines, words).x : 0;
    vertices.uvs.emplace_back(u, 1 - v);  // v of OBJ grows upwards
  } else if (key == "vn") {
    vertices.normals.emplace_back(read_coordinates<3>(source_, lines, words));
  } else if (key == "f") {
    ++range.elements;
  } else if (key == "l" || key == "p") {
    ++range.elements;
    ++range.splats;
  } else if (key == "mtllib") {
    range.commands.push_back({ObjCommand::library, range.elements, std::string(words.rest())});
  } else if (key == "usemtl") {
    range.commands.push_back({ObjCommand::material, range.elements, std::string(words.rest())});
  } else if (key == "curv" || key == "curv2" || key == "surf") {
    ++range.free_forms;
  }
}

// Three more numbers are a colour; one is a weight, which polygons do not use.
void ObjText::read_vertex_colour(Words words, RangeVertices& vertices) {
  glm::dvec4 colour(1);
  for (int k = 0; k < 3; ++k) {
    if (!parse(words.next(), colour[k])) return;
  }
  vertices.colours.resize(vertices.positions.size() - 1, glm::vec4(1));
  vertices.colours.push_back(linear_colour(colour));
}

// Puts the vertices of all ranges behind each other, relative to the origin.
void ObjText::join_vertices() {
  geometry::Box3d box;
  for (const RangeVertices& part : parts_) box.include(part.box);
  vertices_.origin = origin_of(box);
  // Far from 0 they are coarse so far.
  if (vertices_.origin != glm::dvec3(0)) {
    for_each_block(ranges_.size(), [&](std::size_t i) { read_range(i, vertices_.origin); });
  }
  bool colours = false;
  before_.assign(1, ObjCounts{});
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    colours |= !parts_[i].colours.empty();
    before_.push_back(before_.back());
    for (std::size_t k = 0; k < kObjVertexKeys.size(); ++k)
      before_.back()[k] += ranges_[i].counts[k];
  }
  if (*std::ranges::max_element(all()) >= std::int64_t{kNone}) {
    source_.fail("", "a mesh is too large");
  }
  source_.require_memory(static_cast<std::uint64_t>(all()[0]) * sizeof(glm::vec3));
  parallel::grow(vertices_.positions, static_cast<std::size_t>(all()[0]));
  parallel::grow(vertices_.uvs, static_cast<std::size_t>(all()[1]));
  parallel::grow(vertices_.normals, static_cast<std::size_t>(all()[2]));
  if (colours) vertices_.colours.resize(vertices_.positions.size(), glm::vec4(1));
  parallel::parallel_for(0, ranges_.size(), 1, [&](std::size_t i) {
    move_to(parts_[i].positions, before_[i][0], vertices_.positions);
    move_to(parts_[i].colours, before_[i][0], vertices_.colours);
    move_to(parts_[i].uvs, before_[i][1], vertices_.uvs);
    move_to(parts_[i].normals, before_[i][2], vertices_.normals);
  });
  std::vector<RangeVertices>().swap(parts_);
}

}  // namespace delray::scenes::internal
