#include "delaunay/files/point_readers.h"
#include "tests/fuzz/fuzz_points.h"

// The bytes are the .ele file beside four good points.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  delray::tests::fuzz_mesh(data, size, [](const delray::delaunay::Input& elements) {
    const delray::delaunay::Input nodes{"points", "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n"};
    return delray::delaunay::read_node_mesh(nodes, elements);
  });
  return 0;
}
