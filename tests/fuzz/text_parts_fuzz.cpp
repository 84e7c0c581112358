// Text in ranges of some bytes is read as it is read whole.
#include "delaunay/files/parts/text_parts.h"

#include "tests/fuzz/text_in_parts.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (!delray::tests::compare_with_parts(text, 1U + data[0]).same) std::abort();
  return 0;
}
