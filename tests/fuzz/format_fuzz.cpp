#include "files/format.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "files/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  try {
    delray::files::identify(content, size, "noname");
  } catch (const delray::files::FileError&) {  // UTF-16
  }
  return 0;
}
