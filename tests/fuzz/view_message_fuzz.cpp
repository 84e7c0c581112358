#include <cmath>
#include <cstdlib>

#include "apps/view/message.h"

// Any bytes are a message with numbers that can be worked with, or none.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace delray::apps::view;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const Message message = parse_message(text);
    if (const auto* camera = std::get_if<CameraMessage>(&message)) {
      const PageCamera& c = camera->camera;
      if (!std::isfinite(c.fov) || c.fov <= 0 || c.eye == c.at || !(glm::length(c.up) >= 0))
        std::abort();
    }
    if (const auto* page = std::get_if<SizeMessage>(&message)) {
      if (page->width < 1 || page->width > kLargestPage || page->height < 1) std::abort();
    }
    if (const auto* option = std::get_if<OptionMessage>(&message)) {
      if (option->value.size() > kLongestValue) std::abort();
    }
  } catch (const BadMessage&) {
  }
  return 0;
}
