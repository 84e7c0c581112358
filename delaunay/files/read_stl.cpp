// STL: triangles with the coordinates of their corners as 32-bit floats, in binary or as text. It
// has no vertex numbers: corners at one place become one vertex.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>

#include "delaunay/files/point_readers.h"
#include "delaunay/mesh/equal_points.h"

namespace delray::delaunay {
namespace {

constexpr std::size_t kHeader = 84, kRecord = 50;

using Corners = std::vector<glm::dvec3>;  // three for each triangle

Corners read_binary_stl(const Input& input, std::uint32_t triangles) {
  Corners corners(std::size_t{triangles} * 3);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t at = kHeader + i / 3 * kRecord + (1 + i % 3) * sizeof(glm::vec3);
    std::array<float, 3> p{};
    std::memcpy(p.data(), input.content.data() + at, sizeof p);
    if (!std::ranges::all_of(p, [](float x) { return std::isfinite(x); })) {
      fail(input, at_byte(at), "a coordinate that is not a finite number");
    }
    corners[i] = {p[0], p[1], p[2]};
  }
  return corners;
}

// Words, with the numbers of their lines.
class StlWords {
 public:
  explicit StlWords(const Input& input) : input_(input) {}

  std::string_view next() {
    const std::string_view text = input_.content;
    for (; at_ < text.size() && is_blank(text[at_]); ++at_) line_ += text[at_] == '\n' ? 1 : 0;
    const std::size_t begin = at_;
    while (at_ < text.size() && !is_blank(text[at_])) ++at_;
    return text.substr(begin, at_ - begin);
  }
  float number() {
    std::string_view word = next();
    if (word.starts_with('+')) word.remove_prefix(1);
    float value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::result_out_of_range && end == word.data() + word.size()) {
      double wide = 0;  // too small for a float is zero, too large an error
      std::from_chars(word.data(), end, wide);
      if (std::abs(wide) < 1) return 0;
    }
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
      fail(input_, at_line(line_), "a finite number is expected");
    }
    return value;
  }
  [[noreturn]] void complain(const std::string& what) const { fail(input_, at_line(line_), what); }

 private:
  static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f';
  }

  const Input& input_;
  std::size_t at_ = 0, line_ = 1;
};

// The names of solids, normals and loops say nothing about the triangles.
Corners read_text_stl(const Input& input) {
  Corners corners;
  StlWords words(input);
  std::size_t of_facet = 3;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word == "facet") {
      if (of_facet != 3) words.complain("a facet begins before the last has three corners");
      of_facet = 0;
    } else if (word == "vertex" && of_facet == 3) {
      words.complain("a facet has more than three corners");
    } else if (word == "vertex") {
      const float x = words.number(), y = words.number(), z = words.number();
      corners.emplace_back(x, y, z);
      ++of_facet;
    }
  }
  if (of_facet != 3) words.complain("the file ends within a facet");
  return corners;
}

}  // namespace

PointMesh read_stl_mesh(const Input& input) {
  std::uint32_t triangles = 0;
  if (input.content.size() >= kHeader) {
    std::memcpy(&triangles, input.content.data() + kHeader - sizeof triangles, sizeof triangles);
  }
  const bool is_binary = input.content.size() >= kHeader &&
                         input.content.size() == kHeader + std::uint64_t{triangles} * kRecord;
  if (!is_binary && !input.content.starts_with("solid")) {
    fail(input, "", "the number of triangles in the header and the size of the file do not agree");
  }
  constexpr std::uint64_t kBytesOfTriangle = 3 * (2 * sizeof(glm::dvec3) + 3 * sizeof(int));
  constexpr std::uint64_t kShortestText = 36;  // of three corners, "vertex 0 0 0" each
  input.require_memory((is_binary ? triangles : input.content.size() / kShortestText) *
                       kBytesOfTriangle);
  const Corners corners = is_binary ? read_binary_stl(input, triangles) : read_text_stl(input);
  PointMesh mesh;
  mesh.has_float_coordinates = true;
  mesh.points.has_z = true;
  std::vector<std::uint32_t>& vertices = mesh.triangulation.vertices;
  vertices = lowest_equal_rows(view(corners), 3);
  std::vector<std::uint32_t> numbers(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (vertices[i] == i) {
      numbers[i] = static_cast<std::uint32_t>(mesh.points.size());
      mesh.points.positions.push_back(corners[i]);
    }
    vertices[i] = numbers[vertices[i]];
  }
  return mesh;
}

}  // namespace delray::delaunay
