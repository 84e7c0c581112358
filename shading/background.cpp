// Blends pictures over their background, in linear light, in parallel over rows.
#include "shading/background.h"

#include "image/srgb.h"
#include "parallel/parallel_for.h"
#include "shading/environment.h"

namespace delray::shading {
namespace {

using image::Rgba8;
using image::RgbaF;

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
                        const Shader& shader, const scenes::View& view, const glm::ivec2& corner) {
  if (background.kind == Background::Kind::transparent) return;
  using Kind = Background::Kind;
  constexpr std::size_t kGrain = 8;  // rows: some microseconds
  const auto width = static_cast<std::size_t>(picture.width);
  const auto height = static_cast<std::size_t>(picture.height);
  parallel::parallel_for(0, height, kGrain, [&](std::size_t y) {
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

void put_behind(image::ImageF& picture, const Background& background, const Shader& shader,
                const scenes::View& view, const glm::ivec2& corner) {
  put_behind_picture(picture, background, shader, view, corner);
}

void put_behind(image::Image8& picture, const Background& background, const Shader& shader,
                const scenes::View& view, const glm::ivec2& corner) {
  put_behind_picture(picture, background, shader, view, corner);
}

}  // namespace delray::shading
