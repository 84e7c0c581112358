// Corners are read into the mesh's triangles; an array by position finds the first corner of each.
#include "scenes/files/obj_triangles.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include "parallel/grow.h"
#include "parallel/parallel_for.h"

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

// Numbers vertices by their first corners and drops those that are none.
void number_by_first_corner(Mesh& mesh) {
  constexpr std::size_t kBlock = 1 << 14;  // triangles: some ten microseconds
  std::vector<std::uint32_t> number(mesh.positions.size(), kNone);
  parallel::parallel_for(0, mesh.triangles.size(), kBlock, [&](std::size_t t) {
    for (int k = 0; k < 3; ++k) {
      const auto corner = static_cast<std::uint32_t>(3 * t) + static_cast<std::uint32_t>(k);
      std::atomic_ref<std::uint32_t> first(number[mesh.triangles[t][k]]);
      std::uint32_t held = first.load(std::memory_order_relaxed);
      while (corner < held &&
             !first.compare_exchange_weak(held, corner, std::memory_order_relaxed)) {
      }
    }
  });
  // How many first corners there are before each block. A vertex that has its new number, which is
  // below its first corner, is nobody's first any more.
  const std::size_t count = mesh.triangles.size(), blocks = (count + kBlock - 1) / kBlock;
  std::vector<std::uint32_t> before(blocks + 1, 0);
  const auto for_first_corners = [&](std::size_t block, auto&& f) {
    for (std::size_t t = block * kBlock; t < std::min(count, (block + 1) * kBlock); ++t) {
      for (int k = 0; k < 3; ++k) {
        std::atomic_ref<std::uint32_t> first(number[mesh.triangles[t][k]]);
        if (first.load(std::memory_order_relaxed) == 3 * t + static_cast<std::size_t>(k)) f(first);
      }
    }
  };
  parallel::parallel_for(0, blocks, 1, [&](std::size_t b) {
    std::uint32_t firsts = 0;
    for_first_corners(b, [&](auto&) { ++firsts; });
    before[b + 1] = firsts;
  });
  std::partial_sum(before.begin(), before.end(), before.begin());
  parallel::parallel_for(0, blocks, 1, [&](std::size_t b) {
    std::uint32_t next = before[b];
    for_first_corners(b, [&](auto& first) { first.store(next++, std::memory_order_relaxed); });
  });
  parallel::parallel_for(0, count, kBlock, [&](std::size_t t) {
    for (int k = 0; k < 3; ++k) mesh.triangles[t][k] = number[mesh.triangles[t][k]];
  });
  put_in_place(number, before.back(), mesh);
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
  if (faces == 0 || splats > 0 || faces > kNone / 3 || text.all()[1] > 0 || text.all()[2] > 0)
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
  number_by_first_corner(mesh);
  return true;
}

}  // namespace delray::scenes::internal
