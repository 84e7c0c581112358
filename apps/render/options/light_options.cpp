// --light, --light-rotation and --light-strength: pictures of environments, the default light.
#include "apps/render/options/light_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "files/error.h"
#include "image/io.h"

namespace delray::apps {
namespace {

// More than any camera takes in, and far from where sums of samples would overflow.
constexpr float kMostRadiance = 1e9F;

// Bytes of a texel with its smaller levels, and of what it was made from.
constexpr std::uint64_t kBytesPerTexel = 2 * sizeof(glm::vec3) + 2 * sizeof(glm::vec4);

void require(bool fine, const LightOptions& options, const std::string& what) {
  if (!fine) throw files::FileError(files::Cause::input, options.light, "", what);
}

// False for NaN.
float limited(float x, float strength) {
  return x > 0.0F ? std::min(x * strength, kMostRadiance) : 0.0F;
}

scenes::Texture texture_of(const image::ImageF& picture, const LightOptions& options) {
  scenes::Texture texture;
  texture.name = options.light;
  texture.width = picture.width;
  texture.height = picture.height;
  texture.wrap_v = scenes::Texture::Wrap::clamp;
  texture.radiance.reserve(picture.pixels());
  const auto strength = static_cast<float>(options.strength);
  for (const image::RgbaF& c : picture.colour.span()) {
    texture.radiance.emplace_back(limited(c.r, strength), limited(c.g, strength),
                                  limited(c.b, strength));
  }
  return texture;
}

}  // namespace

void add_light_options(CLI::App& command, LightOptions& options) {
  command
      .add_option("--light", options.light,
                  "What lights the scene besides its own lights: none, default (a key light and a "
                  "sky), or FILE, a picture of the surroundings in latitude and longitude (.exr, "
                  ".hdr) in place of the scene's sky (default: default where nothing else lights "
                  "the scene)")
      ->group(group::kPicture);
  choose_from(command, "--light", {"none", "default"},
              {OtherValues::kFile, [](const std::string& text) { return !text.empty(); }});
  command
      .add_option("--light-rotation", options.rotation,
                  "Degrees by which the picture of --light is turned, counter-clockwise seen from "
                  "above (default: 0)")
      ->group(group::kPicture)
      ->check(number_between(-360000.0, 360000.0));
  command
      .add_option("--light-strength", options.strength,
                  "Factor of the light that --light adds (default: 1)")
      ->group(group::kPicture)
      ->check(positive_float());
}

void check_light(const CLI::App& command, const LightOptions& options) {
  if (command.count("--light-rotation") > 0 && !options.is_picture()) {
    throw UsageError("--light-rotation has no effect without a picture as --light");
  }
  if (command.count("--light-strength") > 0 && (options.light.empty() || options.light == "none")) {
    throw UsageError(fmt::format("--light-strength has no effect with {}",
                                 options.light.empty() ? "no --light" : "--light none"));
  }
}

void load_light(const LightOptions& options, const files::MemoryBudget& memory,
                scenes::Scene& scene) {
  if (!options.is_picture()) return;
  const image::ImageF picture = image::read_image_float(options.light, memory);
  const bool twice = std::abs(picture.width - 2 * picture.height) <= picture.height / 50 + 1;
  require(twice, options,
          fmt::format("a picture of {} x {} pixels is not twice as wide as high: it does not show "
                      "latitude and longitude",
                      picture.width, picture.height));
  memory.require(picture.pixels() * kBytesPerTexel, options.light);
  scene.environment = {};
  scene.environment.up = scene.z_up ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  scene.environment.texture = static_cast<std::uint32_t>(scene.textures.size());
  scene.environment.rotation = static_cast<float>(std::fmod(options.rotation, 360.0));
  scene.textures.push_back(texture_of(picture, options));
}

bool complete_light(const LightOptions& options, const scenes::Camera& camera,
                    scenes::Scene& scene) {
  const bool wanted =
      options.light == "default" || (options.light.empty() && !scenes::has_light(scene));
  if (wanted) scenes::add_default_light(scene, camera, static_cast<float>(options.strength));
  return wanted;
}

}  // namespace delray::apps
