// Parses messages by a table of types; every member is taken by a function that knows its range,
// and a member that nobody has taken is an error.
#include "apps/view/message.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace delray::apps::view {
namespace {

using Value = nlohmann::json;

// An object whose members are taken one by one.
class Members {
 public:
  explicit Members(const Value& object) : object_(object) {
    if (!object_.is_object()) throw BadMessage("not an object");
  }

  std::string text(const char* name) {
    const Value& value = take(name);
    if (!value.is_string()) throw BadMessage(std::string(name) + " is no text");
    const std::string& result = value.get_ref<const std::string&>();
    if (result.size() > kLongestValue || result.find('\0') != std::string::npos)
      throw BadMessage(std::string(name) + " is too long, or no text");
    return result;
  }
  float number(const char* name, float least, float most) {
    return number_of(take(name), name, least, most);
  }
  std::uint64_t count(const char* name) {
    const Value& value = take(name);
    constexpr std::uint64_t kMost = std::uint64_t{1} << 53;  // that a page can count to
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMost)
      throw BadMessage(std::string(name) + " is no count");
    return value.get<std::uint64_t>();
  }
  bool flag(const char* name) {
    const Value& value = take(name);
    if (!value.is_boolean()) throw BadMessage(std::string(name) + " is neither true nor false");
    return value.get<bool>();
  }
  glm::vec3 vector(const char* name) {
    const Value& value = take(name);
    if (!value.is_array() || value.size() != 3)
      throw BadMessage(std::string(name) + " is not three numbers");
    glm::vec3 result;
    for (int i = 0; i < 3; ++i)
      result[i] = number_of(value[static_cast<std::size_t>(i)], name, -kFarthest, kFarthest);
    return result;
  }
  const Value& take(const char* name) {
    const auto found = object_.find(name);
    if (found == object_.end()) throw BadMessage(std::string(name) + " is missing");
    ++taken_;
    return *found;
  }
  void end() const {
    if (taken_ != object_.size()) throw BadMessage("a member that is not known");
  }

 private:
  static float number_of(const Value& value, const char* name, float least, float most) {
    if (!value.is_number()) throw BadMessage(std::string(name) + " is no number");
    const auto number = value.get<double>();
    if (!(number >= least && number <= most))
      throw BadMessage(std::string(name) + " is out of range");
    return static_cast<float>(number);
  }

  const Value& object_;
  std::size_t taken_ = 0;
};

SizeMessage size_of(Members& members) {
  const auto side = [&](const char* name) {
    const std::uint64_t pixels = members.count(name);
    if (pixels < 1 || pixels > static_cast<std::uint64_t>(kLargestPage))
      throw BadMessage(std::string(name) + " is out of range");
    return static_cast<int>(pixels);
  };
  const int width = side("width");
  return {width, side("height")};
}

Message parse_hello(Members& members) {
  HelloMessage hello;
  hello.size = size_of(members);
  const Value& options = members.take("options");
  if (!options.is_object() || options.size() > kMostOptions)
    throw BadMessage("options are no object, or too many");
  for (const auto& [name, value] : options.items()) {
    if (name.size() > kLongestValue) throw BadMessage("a name is too long");
    Members one(options);
    hello.options.emplace_back(name, one.text(name.c_str()));
  }
  return hello;
}

Message parse_size(Members& members) { return size_of(members); }

Message parse_camera(Members& members) {
  constexpr float kLeastAngle = 0.01F, kMostAngle = 179.0F;
  CameraMessage message;
  message.number = members.count("number");
  message.moving = members.flag("moving");
  PageCamera& camera = message.camera;
  camera.eye = members.vector("eye");
  camera.at = members.vector("at");
  camera.up = members.vector("up");
  camera.fov = members.number("fov", kLeastAngle, kMostAngle);
  camera.height = members.number("height", 0, kFarthest);
  camera.clip = members.number("clip", 0, kFarthest);
  if (camera.clip < kNearestClip) camera.clip = 0;
  if (camera.eye == camera.at) throw BadMessage("eye and at are one place");
  if (camera.up == glm::vec3(0.0F)) throw BadMessage("up has no length");
  return message;
}

Message parse_option(Members& members) {
  OptionMessage message;
  message.name = members.text("name");
  message.value = members.text("value");
  return message;
}

Message parse_view(Members& members) { return ViewMessage{members.text("name")}; }

Message parse_pick(Members& members) {
  const float x = members.number("x", 0, 1);
  return PickMessage{x, members.number("y", 0, 1)};
}

Message parse_seen(Members& members) { return SeenMessage{members.count("frame")}; }

Message parse_watch(Members& members) {
  const bool visible = members.flag("visible");
  return WatchMessage{visible, members.flag("figures")};
}

Message parse_command(Members&) { return CommandMessage{}; }

struct Type {
  const char* name;
  Message (*parse)(Members& members);
};
constexpr Type kTypes[] = {
    {"hello", parse_hello},   {"size", parse_size},   {"camera", parse_camera},
    {"option", parse_option}, {"view", parse_view},   {"pick", parse_pick},
    {"seen", parse_seen},     {"watch", parse_watch}, {"command", parse_command},
};

}  // namespace

Message parse_message(std::string_view text) {
  if (text.size() > kLongestMessage) throw BadMessage("too long");
  const Value object = Value::parse(text, nullptr, /*allow_exceptions=*/false);
  if (object.is_discarded()) throw BadMessage("not JSON");
  Members members(object);
  const std::string type = members.text("type");
  for (const Type& known : kTypes) {
    if (type != known.name) continue;
    Message message = known.parse(members);
    members.end();
    return message;
  }
  throw BadMessage("a type that is not known");
}

}  // namespace delray::apps::view
