#include "apps/view/message.h"

#include <gtest/gtest.h>

#include <string>

namespace delray::apps::view {
namespace {

std::string camera(const std::string& eye = "[1,2,3]", const std::string& rest = "",
                   const std::string& clip = "0") {
  return R"({"type":"camera","number":7,"moving":true,"eye":)" + eye +
         R"(,"at":[0,0,0.5],"up":[0,0,1],"fov":40,"height":0,"clip":)" + clip + rest + "}";
}

std::string clipped(const std::string& clip) { return camera("[1,2,3]", "", clip); }

float clip_of(const std::string& clip) {
  return std::get<CameraMessage>(parse_message(clipped(clip))).camera.clip;
}

TEST(ViewMessage, ReadsEveryType) {
  const auto moved = std::get<CameraMessage>(parse_message(camera()));
  EXPECT_EQ(moved.number, 7U);
  EXPECT_TRUE(moved.moving);
  EXPECT_EQ(moved.camera.eye, glm::vec3(1, 2, 3));
  EXPECT_EQ(moved.camera.at.z, 0.5F);
  const auto hello = std::get<HelloMessage>(
      parse_message(R"({"type":"hello","width":640,"height":480,"options":{"--spp":"16"}})"));
  EXPECT_EQ(hello.size.width, 640);
  ASSERT_EQ(hello.options.size(), 1U);
  EXPECT_EQ(hello.options[0].second, "16");
  EXPECT_EQ(
      std::get<SizeMessage>(parse_message(R"({"type":"size","width":1,"height":8192})")).height,
      8192);
  EXPECT_EQ(
      std::get<OptionMessage>(parse_message(R"({"type":"option","name":"--engine","value":""})"))
          .name,
      "--engine");
  EXPECT_EQ(std::get<ViewMessage>(parse_message(R"({"type":"view","name":"top"})")).name, "top");
  EXPECT_EQ(std::get<PickMessage>(parse_message(R"({"type":"pick","x":0.25,"y":1})")).x, 0.25F);
  EXPECT_EQ(std::get<SeenMessage>(parse_message(R"({"type":"seen","frame":3})")).frame, 3U);
  EXPECT_FALSE(
      std::get<WatchMessage>(parse_message(R"({"type":"watch","visible":false,"figures":true})"))
          .visible);
  EXPECT_TRUE(std::holds_alternative<CommandMessage>(parse_message(R"({"type":"command"})")));
}

TEST(ViewMessage, RefusesWhatNoPageSends) {
  const std::string long_value(kLongestValue + 1, 'x');
  const std::string bad[] = {
      "",
      "null",
      "[]",
      "{",
      R"({"type":7})",
      R"({"type":"nonsense"})",
      R"({"type":"command","more":1})",
      R"({"type":"size","width":0,"height":10})",
      R"({"type":"size","width":8193,"height":10})",
      R"({"type":"size","width":-5,"height":10})",
      R"({"type":"size","width":5.5,"height":10})",
      R"({"type":"size","width":5})",
      R"({"type":"pick","x":1.01,"y":0})",
      R"({"type":"pick","x":"0","y":0})",
      R"({"type":"pick","x":null,"y":0})",
      R"({"type":"seen","frame":-1})",
      R"({"type":"seen","frame":9007199254740993})",
      R"({"type":"watch","visible":1,"figures":true})",
      R"({"type":"option","name":"--engine","value":7})",
      R"({"type":"option","name":"--engine","value":"a\u0000b"})",
      R"({"type":"option","name":"--engine","value":")" + long_value + "\"}",
      R"({"type":"hello","width":1,"height":1,"options":[]})",
      R"({"type":"hello","width":1,"height":1,"options":{"--spp":16}})",
      camera("[0,0,0.5]"),  // where it looks at
      camera("[1e19,0,0]"),
      camera("[1e999,0,0]"),
      camera("[1,2]"),
      camera("[1,2,\"3\"]"),
      camera("[1,2,3]", R"(,"roll":1)"),
      clipped("-1"),
      clipped("-1e-30"),
      clipped("NaN"),
      clipped("null"),
      clipped("\"2\""),
      clipped("[2]"),
      clipped("true"),
      clipped("1.1e18"),
      clipped("1e999"),
      clipped("-1e999"),
      clipped(""),
      std::string(100000, '['),
      "\xff\xfe{}",
  };
  for (const std::string& text : bad)
    EXPECT_THROW(parse_message(text), BadMessage) << text.substr(0, 200);
}

TEST(ViewMessage, AClipTooNearForClipIsNone) {
  EXPECT_EQ(clip_of("2.5"), 2.5F);
  EXPECT_EQ(clip_of("9e17"), 9e17F);
  EXPECT_EQ(clip_of("2e-18"), 2e-18F);
  for (const char* const near : {"0", "-0.0", "9e-19", "1e-30", "1e-300"})
    EXPECT_EQ(clip_of(near), 0.0F) << near;
}

TEST(ViewMessage, RefusesMessagesThatAreTooLong) {
  std::string text = R"({"type":"command"})";
  text.insert(text.size() - 1, kLongestMessage, ' ');
  EXPECT_THROW(parse_message(text), BadMessage);
  std::string options = "\"--a\":\"\"";
  for (std::size_t i = 0; i <= kMostOptions; ++i)
    options += ",\"--" + std::to_string(i) + "\":\"\"";
  EXPECT_THROW(
      parse_message(R"({"type":"hello","width":1,"height":1,"options":{)" + options + "}}"),
      BadMessage);
}

}  // namespace
}  // namespace delray::apps::view
