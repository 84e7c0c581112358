// What stands behind the scene in a finished picture.
#pragma once

#include <string>

#include "image/image.h"
#include "scenes/camera.h"
#include "shading/shader.h"

namespace delray::apps {

struct Background {
  enum class Kind { environment, transparent, colour } kind = Kind::environment;
  image::RgbaF colour;  // linear; for Kind::colour
};

// "environment", "transparent", or a colour "#rrggbb" in sRGB. Throws UsageError.
Background parse_background(const std::string& text);

// Blends the picture over the background, in place; depth stays as it is. Parallel.
void put_behind(image::ImageF& picture, const Background& background, const shading::Shader& shader,
                const scenes::View& view);
void put_behind(image::Image8& picture, const Background& background, const shading::Shader& shader,
                const scenes::View& view);

}  // namespace delray::apps
