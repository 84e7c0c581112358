// Corners are read into the mesh's triangles, and vertices are numbered by their first corners.
#include "scenes/files/obj_triangles.h"

#include <algorithm>
#include <atomic>

#include "parallel/grow.h"
#include "parallel/parallel_for.h"
#include "scenes/geometry/number_by_use.h"

namespace delray::scenes::internal {
namespace {

// Three whole numbers of 1 to `most` and nothing else, which is what most faces are. Less one.
bool read_triangle(std::string_view words, std::uint64_t most, std::uint32_t* corners) {
  const char *at = words.data(), *const end = at + words.size();
  for (int k = 0; k < 3; ++k) {
    constexpr std::ptrdiff_t kMostDigits = 18;
    const char* const first = at = skip_blanks(at, end);
    std::uint64_t index = 0;
    for (; at != end && static_cast<unsigned>(*at - '0') < 10; ++at) {
      index = index * 10 + static_cast<unsigned>(*at - '0');
    }
    if (at - first > kMostDigits || index == 0 || index > most || !is_word_end(at, end))
      return false;
    corners[k] = static_cast<std::uint32_t>(index - 1);
  }
  return skip_blanks(at, end) == end;
}

bool read_range(const ObjText& text, std::size_t range, glm::uvec3* to) {
  std::string buffer;
  std::string_view line;
  const auto most = static_cast<std::uint64_t>(text.all()[0]);
  for (Lines lines(text.text_of(range, buffer)); lines.next(line);) {
    if (line.starts_with("f ")) {
      if (!read_triangle(line.substr(2), most, &to->x)) return false;
      ++to;
    } else if (!line.starts_with("v ") && Words(line).next() == "f") {
      return false;
    }
  }
  return true;
}

// Gives each vertex its number, by swaps along the cycles of the permutation: there is no room
// for the vertices twice.
void put_in_place(std::vector<std::uint32_t>& number, std::size_t used, Mesh& mesh) {
  auto next = static_cast<std::uint32_t>(used);
  for (std::uint32_t& n : number) {
    if (n == kNone) n = next++;
  }
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    while (number[i] != i) {
      const std::uint32_t to = number[i];
      std::swap(mesh.positions[i], mesh.positions[to]);
      if (!mesh.colours.empty()) std::swap(mesh.colours[i], mesh.colours[to]);
      std::swap(number[i], number[to]);
    }
  }
  mesh.positions.resize(used);
  if (!mesh.colours.empty()) mesh.colours.resize(used);
}

}  // namespace

bool read_obj_triangles(ObjText& text, Mesh& mesh) {
  std::vector<std::uint64_t> before = {0};
  std::uint64_t splats = 0;
  for (const ObjRange& range : text.ranges()) {
    before.push_back(before.back() + range.elements);
    splats += range.splats;
  }
  const std::uint64_t faces = before.back();
  if (faces == 0 || splats > 0 || faces > kMostNumberedTriangles || text.all()[1] > 0 ||
      text.all()[2] > 0)
    return false;
  ObjVertices& vertices = text.vertices();
  text.source().require_memory(faces * sizeof(glm::uvec3) +
                               vertices.positions.size() * sizeof(std::uint32_t));
  std::vector<glm::uvec3> triangles;
  parallel::grow(triangles, faces);
  std::atomic<bool> good{true};
  parallel::parallel_for(0, text.ranges().size(), 1, [&](std::size_t i) {
    if (good && !read_range(text, i, triangles.data() + before[i])) good = false;
  });
  if (!good) return false;
  mesh.triangles = std::move(triangles);
  mesh.positions = std::move(vertices.positions);
  mesh.colours = std::move(vertices.colours);
  std::vector<std::uint32_t> number(mesh.positions.size(), kNone);
  const std::size_t used = number_by_first_corner(mesh.triangles, number);
  put_in_place(number, used, mesh);
  return true;
}

}  // namespace delray::scenes::internal
