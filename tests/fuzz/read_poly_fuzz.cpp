#include <string_view>

#include "delaunay/files/point_readers.h"
#include "files/error.h"
#include "tests/fuzz/fuzz_points.h"

// Segments join points that are there, and coordinates are finite.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace delray::delaunay;
  delray::tests::fuzz_points(data, size, &read_poly_points);
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  const Input nodes{"points", "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n"};
  try {
    const Outline outline = read_outline({"fuzz", content}, &nodes);
    for (const auto& segment : outline.segments) {
      for (const std::uint32_t row : segment) {
        if (row >= outline.points.size()) std::abort();
      }
    }
    for (const glm::dvec2& hole : outline.holes) {
      if (!std::isfinite(hole.x) || !std::isfinite(hole.y)) std::abort();
    }
  } catch (const delray::files::FileError&) {
  }
  return 0;
}
