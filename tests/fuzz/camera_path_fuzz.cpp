#include "scenes/camera_path.h"

#include <cstdlib>

#include "files/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace delray;
  try {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto keys = scenes::parse_camera_path(text, "fuzzed", {});
    constexpr int kFew = 10'000;  // a million frames take longer than a fuzzer waits
    if (keys.back().frame < kFew &&
        scenes::interpolate(keys).size() !=
            static_cast<std::size_t>(keys.back().frame - keys.front().frame) + 1) {
      std::abort();
    }
  } catch (const files::FileError&) {
  }
  return 0;
}
