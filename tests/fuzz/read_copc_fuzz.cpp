// LAZ files whose octree is read, too.
#include "delaunay/files/parts/las_parts.h"
#include "tests/fuzz/fuzz_points.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  delray::tests::fuzz_points(data, size, [](const delray::delaunay::Input& input) {
    delray::delaunay::PointFilter filter;
    filter.resolution = 2;
    filter.bounds = {{-1e3, -1e3, -1e3}, {30, 30, 1e3}};
    return read_all(delray::delaunay::LasParts(delray::delaunay::ByteSource(input), filter), filter,
                    input.memory);
  });
  return 0;
}
