#include "delaunay/files/point_readers.h"
#include "tests/fuzz/fuzz_points.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  delray::tests::fuzz_points(data, size, &delray::delaunay::read_pcd_points);
  return 0;
}
