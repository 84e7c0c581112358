// Parses the option and blends pictures over their background, in linear light, in parallel over
// rows.
#include "apps/render/background.h"

#include <charconv>

#include "apps/options/list.h"
#include "image/srgb.h"
#include "parallel/parallel_for.h"
#include "shading/environment.h"

namespace delray::apps {
namespace {

using image::Rgba8;
using image::RgbaF;

constexpr std::size_t kRows = 8;  // rows a block: some microseconds of work
struct NamedKind {
  const char* name;
  Background::Kind kind;
};
constexpr NamedKind kNamedBackgrounds[] = {{"auto", Background::Kind::automatic},
                                           {"environment", Background::Kind::environment},
                                           {"studio", Background::Kind::studio},
                                           {"transparent", Background::Kind::transparent}};

constexpr glm::vec3 kStudioTop{0.93F, 0.94F, 0.96F}, kStudioBottom{0.56F, 0.61F, 0.68F};

RgbaF opaque(const glm::vec3& colour) { return {colour.x, colour.y, colour.z, 1.0F}; }

void blend(RgbaF& pixel, const RgbaF& behind) {
  const float through = 1.0F - pixel.a;
  pixel = {pixel.r + behind.r * through, pixel.g + behind.g * through, pixel.b + behind.b * through,
           pixel.a + behind.a * through};
}

// Partly covered pixels are blended in linear light.
void blend(Rgba8& pixel, const RgbaF& behind) {
  if (pixel.a == 255) return;
  RgbaF linear = image::to_float(pixel);
  blend(linear, behind);
  pixel = image::to_8bit(linear);
}

template <class Colour>
void put_behind_picture(image::BasicImage<Colour>& picture, const Background& background,
                        const shading::Shader& shader, const scenes::View& view,
                        const glm::ivec2& corner) {
  if (background.kind == Background::Kind::transparent) return;
  using Kind = Background::Kind;
  const auto width = static_cast<std::size_t>(picture.width);
  const auto height = static_cast<std::size_t>(picture.height);
  parallel::parallel_for(0, height, kRows, [&](std::size_t y) {
    RgbaF behind = background.colour;
    if (background.kind == Kind::studio) {
      const float t = (static_cast<float>(y) + static_cast<float>(corner.y) + 0.5F) /
                      static_cast<float>(view.height);
      behind = opaque(kStudioTop * (1.0F - t) + kStudioBottom * t);
    }
    for (std::size_t x = 0; x < width; ++x) {
      if (background.kind == Kind::environment) {
        const glm::vec3 direction =
            glm::normalize(view.ray(static_cast<float>(x) + static_cast<float>(corner.x) + 0.5F,
                                    static_cast<float>(y) + static_cast<float>(corner.y) + 0.5F));
        behind = opaque(radiance(shader.environment, shader.textures, direction));
      }
      blend(picture.colour[y * width + x], behind);
    }
  });
}

}  // namespace

std::vector<std::string> background_names() { return names_in(kNamedBackgrounds); }

Background parse_background(const std::string& text) {
  for (const NamedKind& named : kNamedBackgrounds) {
    if (text == named.name) return {named.kind, {}};
  }
  unsigned code = 0;
  const char* const begin = text.data() + 1;
  const char* const end = text.data() + text.size();
  if (text.size() == 7 && text[0] == '#' && std::from_chars(begin, end, code, 16).ptr == end) {
    const auto channel = [code](int shift) {
      return image::decode_srgb(static_cast<std::uint8_t>(code >> shift));
    };
    return {Background::Kind::colour, {channel(16), channel(8), channel(0), 1.0F}};
  }
  std::vector<std::string> legal = background_names();
  legal.emplace_back("#rrggbb");
  throw UsageError("--background: " + is_not_one_of(text, legal));
}

void put_behind(image::ImageF& picture, const Background& background, const shading::Shader& shader,
                const scenes::View& view, const glm::ivec2& corner) {
  put_behind_picture(picture, background, shader, view, corner);
}

void put_behind(image::Image8& picture, const Background& background, const shading::Shader& shader,
                const scenes::View& view, const glm::ivec2& corner) {
  put_behind_picture(picture, background, shader, view, corner);
}

}  // namespace delray::apps
