// The background behind the scene in a finished picture.
#pragma once

#include "image/image.h"
#include "scenes/camera.h"
#include "shading/shader.h"

namespace delray::shading {

// What is shown where pixels are not, or partly, covered.
struct Background {
  enum class Kind {
    automatic,    // environment where the scene brings one, otherwise studio
    environment,  // what a ray sees that hits nothing
    studio,       // a light gradient from top to bottom that any model stands out from
    transparent,
    colour,
  } kind = Kind::automatic;
  image::RgbaF colour;  // linear; for Kind::colour
};

// Blends the picture over the background, in place; depth stays as it is. `corner` is where in the
// view's frame the picture's left upper pixel lies. Parallel. REQUIRES: the kind is not automatic.
void put_behind(image::ImageF& picture, const Background& background, const Shader& shader,
                const scenes::View& view, const glm::ivec2& corner = {0, 0});
void put_behind(image::Image8& picture, const Background& background, const Shader& shader,
                const scenes::View& view, const glm::ivec2& corner = {0, 0});

}  // namespace delray::shading
