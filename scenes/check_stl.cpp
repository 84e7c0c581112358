#include <cmath>
#include <cstring>

#include "scenes/internal/check_file.h"
#include "scenes/internal/text_lines.h"

namespace delray::scenes::internal {
namespace {

constexpr std::size_t kHeader = 84, kFacet = 50;  // bytes

void check_text_stl(const Source& source) {
  Lines lines(source.content);
  std::string_view line;
  int vertices = 0;
  bool ended = false, has_facets = false;
  while (lines.next(line)) {
    Words words(line);
    const std::string_view key = words.next();
    if (key == "vertex") {
      for (int i = 0; i < 3; ++i) {
        double value = 0;
        if (!parse(words.next(), value)) source.fail(lines.place(), "a vertex needs three numbers");
        if (!std::isfinite(value) || std::abs(value) > kLargestCoordinate) {
          source.fail(lines.place(), "a coordinate is not finite or larger than 1e18");
        }
      }
      ++vertices;
    } else if (key == "facet") {
      vertices = 0;
      has_facets = true;
    } else if (key == "endfacet" && vertices != 3) {
      source.fail(lines.place(), "the facet has " + std::to_string(vertices) + " vertices, not 3");
    } else if (key == "solid" || key == "endsolid") {
      ended = key == "endsolid";
    }
  }
  if (!ended) source.fail(lines.place(), "the file ends before its endsolid");
  if (!has_facets) source.fail("", kNoTriangles);
}

}  // namespace

void check_stl(const Source& source) {
  const std::string_view content = source.content;
  if (content.size() >= kHeader) {
    std::uint32_t count = 0;
    std::memcpy(&count, content.data() + kHeader - sizeof count, sizeof count);
    const std::uint64_t size = kHeader + std::uint64_t{count} * kFacet;
    if (size == content.size() && count == 0) source.fail("", kNoTriangles);
    if (size == content.size()) return;
    if (!content.starts_with("solid")) {
      source.fail("byte 80", "the header claims " + std::to_string(count) +
                                 " triangles, which are " + std::to_string(size) +
                                 " bytes; the file has " + std::to_string(content.size()));
    }
  }
  if (!content.starts_with("solid")) source.fail("", "this is not an STL file");
  check_text_stl(source);
}

}  // namespace delray::scenes::internal
