// The octree of COPC 1.0: its description is the first variable length record; pages of nodes, each
// with the place of its chunk or of a further page, form a tree.
#include "delaunay/files/parts/copc.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "delaunay/files/laz/laz_items.h"

namespace delray::delaunay {
namespace {

using laz::load;

struct OctreeNode {
  std::int32_t level, x, y, z;
  std::uint64_t begin;
  std::int32_t size, points;  // of its chunk; points -1: of a page of further nodes
};
constexpr std::size_t kNodeSize = 32;
constexpr int kDeepest = 31;  // of keys of 32 bits

OctreeNode parse_node(const char* at) {
  return {load<std::int32_t>(at),      load<std::int32_t>(at + 4),   load<std::int32_t>(at + 8),
          load<std::int32_t>(at + 12), load<std::uint64_t>(at + 16), load<std::int32_t>(at + 24),
          load<std::int32_t>(at + 28)};
}

// Whether a node's cube touches the bounds. Cubes are a little larger than they say, for the
// rounding of writers.
bool touches(const CopcOctree& octree, const OctreeNode& node, const geometry::Box3d& bounds) {
  constexpr double kRounding = 1e-9;
  const double side = std::ldexp(2 * octree.half_size, -node.level);
  const glm::dvec3 low =
      octree.centre - octree.half_size + side * glm::dvec3(node.x, node.y, node.z);
  const glm::dvec3 reach = glm::abs(octree.centre) + octree.half_size;
  const double margin = kRounding * std::max({reach.x, reach.y, reach.z});
  return glm::all(glm::lessThanEqual(low - margin, bounds.high)) &&
         glm::all(glm::greaterThanEqual(low + side + margin, bounds.low));
}

bool is_wanted(const CopcOctree& octree, const OctreeNode& node, const PointFilter& filter) {
  if (filter.bounds && !touches(octree, node, *filter.bounds)) return false;
  // The points of the levels above are as near to each other as those of the parent.
  return filter.resolution == 0 || node.level == 0 ||
         std::ldexp(octree.spacing, 1 - node.level) > filter.resolution;
}

}  // namespace

std::optional<CopcOctree> parse_copc(const ByteSource& source, const LasHeader& header) {
  constexpr std::size_t kSize = 160;
  const std::string_view record = find_las_record(header, "copc", 1);
  if (!header.compressed || record.size() < kSize) return std::nullopt;
  CopcOctree octree;
  for (int k = 0; k < 3; ++k) octree.centre[k] = load<double>(record.data() + 8 * k);
  octree.half_size = load<double>(record.data() + 24);
  octree.spacing = load<double>(record.data() + 32);
  octree.root_begin = load<std::uint64_t>(record.data() + 40);
  octree.root_size = load<std::uint64_t>(record.data() + 48);
  const bool finite = std::isfinite(octree.centre.x) && std::isfinite(octree.centre.y) &&
                      std::isfinite(octree.centre.z) && std::isfinite(octree.half_size) &&
                      std::isfinite(octree.spacing);
  if (!finite || octree.half_size <= 0 || octree.spacing <= 0) {
    fail(source.input(), "the record on the octree", "the root has no size");
  }
  return octree;
}

std::vector<laz::Chunk> wanted_chunks(const ByteSource& source, const CopcOctree& octree,
                                      std::vector<laz::Chunk> chunks, const PointFilter& filter) {
  const Input input = source.input();
  std::unordered_map<std::uint64_t, std::size_t> number;  // of the chunk that begins there
  for (std::size_t i = 0; i < chunks.size(); ++i) number[chunks[i].begin] = i;
  std::vector<char> wanted(chunks.size(), 0);
  // Bounds what pages that name each other, or nodes again and again, could cost: empty nodes lie
  // between others, of which each has at most as many ancestors as there are levels.
  std::uint64_t nodes_left = (chunks.size() + 1) * (kDeepest + 1);

  struct Page {
    std::uint64_t begin, size;
  };
  std::vector<Page> pages = {{octree.root_begin, octree.root_size}};
  std::string buffer;
  while (!pages.empty()) {
    const Page page = pages.back();
    pages.pop_back();
    if (page.begin > source.size() || page.size > source.size() - page.begin ||
        page.size < kNodeSize) {
      fail(input, at_byte(page.begin), "a page of the octree's nodes is not in the file");
    }
    const std::string_view bytes = source.read(page.begin, page.size, buffer);
    for (std::size_t at = 0; at + kNodeSize <= bytes.size(); at += kNodeSize) {
      const OctreeNode node = parse_node(bytes.data() + at);
      const std::string place = at_byte(page.begin + at);
      if (nodes_left-- == 0) fail(input, place, "the octree has more nodes than its chunks can be");
      if (node.level < 0 || node.level > kDeepest || node.size < 0 || node.points < -1) {
        fail(input, place, "a node that cannot be");
      }
      if (!is_wanted(octree, node, filter)) continue;
      if (node.points == -1) {
        pages.push_back({node.begin, static_cast<std::uint64_t>(node.size)});
      } else if (node.points > 0) {
        const auto found = number.find(node.begin);
        if (found == number.end() ||
            chunks[found->second].count != static_cast<std::size_t>(node.points)) {
          fail(input, place, "a node of the octree is none of the file's chunks");
        }
        wanted[found->second] = 1;
      }
    }
  }
  std::vector<laz::Chunk> kept;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    if (wanted[i] != 0) kept.push_back(chunks[i]);
  }
  return kept;
}

}  // namespace delray::delaunay
