// Messages from a page: what they may say, parsed in one place.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace delray::apps::view {

// A message that no page of ours sends; whoever sent it is not talked to any more.
struct BadMessage : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

// A camera as a page has it, in the scene's coordinates (those of the file less Scene::origin).
struct PageCamera {
  glm::vec3 eye{0, 0, 1}, at{0, 0, 0}, up{0, 1, 0};
  float fov = 40;    // vertical, degrees
  float height = 0;  // of an orthographic camera's frame; 0: perspective
  // Distance of a clipping plane along the view; 0: none. One nearer than kNearestClip hides
  // nothing, and is none.
  float clip = 0;
};

// The size of the picture, in pixels of the screen.
struct SizeMessage {
  int width = 0, height = 0;
};
// A new place to look from. `number` grows from camera to camera, and is the picture's in the end.
struct CameraMessage {
  std::uint64_t number = 0;
  PageCamera camera;
  bool moving = false;  // others will follow at once
};
// What a page that reconnects had; applies to it alone. Options as command lines have them.
struct HelloMessage {
  SizeMessage size;
  std::vector<std::pair<std::string, std::string>> options;
};
// Sets an option, "--strategy"; to its default where the value is empty.
struct OptionMessage {
  std::string name, value;
};
// A view that shows everything: of scenes::view_names().
struct ViewMessage {
  std::string name;
};
// Asks what lies at a place of the frame, 0 to 1 from left to right and from top to bottom.
struct PickMessage {
  float x = 0, y = 0;
};
// The page has shown the frame of this number, or a later one.
struct SeenMessage {
  std::uint64_t frame = 0;
};
// Whether anybody looks at the page, and at its figures about ranks.
struct WatchMessage {
  bool visible = true, figures = false;
};
// Asks for the command line that makes the picture.
struct CommandMessage {};

using Message = std::variant<HelloMessage, SizeMessage, CameraMessage, OptionMessage, ViewMessage,
                             PickMessage, SeenMessage, WatchMessage, CommandMessage>;

// Sizes of messages and what is in them; a page of ours stays far below.
inline constexpr std::size_t kLongestMessage = 16384;  // bytes
inline constexpr std::size_t kLongestValue = 256;      // bytes of an option's name or value
inline constexpr std::size_t kMostOptions = 64;
inline constexpr int kLargestPage = 8192;      // pixels a side
inline constexpr float kFarthest = 1e18F;      // of any coordinate
inline constexpr float kNearestClip = 1e-18F;  // that --clip takes

// JSON: an object with "type" and what that type has; no more, no less. Numbers are finite and in
// range, eye and at differ, up has a length. Throws BadMessage. Any bytes may be given.
Message parse_message(std::string_view text);

}  // namespace delray::apps::view
