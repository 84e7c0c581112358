// Colours become bytes or floats, depths distances along rays.
#include "c/frame_picture.h"

#include <algorithm>

#include "image/srgb.h"

namespace delray::c {
namespace {

using image::Image8;
using image::ImageF;

// Puts what is behind the scene behind a picture.
void put_behind(const DelrayObject_& renderer, ImageF& picture) {
  const glm::vec4 behind = renderer.value("background", glm::vec4(0.0F));
  for (image::RgbaF& c : picture.colour.span()) {
    const float through = 1.0F - c.a;
    c = {c.r + through * behind.r * behind.a, c.g + through * behind.g * behind.a,
         c.b + through * behind.b * behind.a, c.a + through * behind.a};
  }
}

template <class T>
image::Plane<T> upside_down(const image::Plane<T>& plane, int width, int height) {
  image::Plane<T> turned(plane.size());
  const auto row = static_cast<std::size_t>(width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
    std::copy_n(plane.data() + y * row, row,
                turned.data() + (static_cast<std::size_t>(height) - 1 - y) * row);
  return turned;
}

// Distances along the view axis become those from the position.
void measure_from_eye(const Task& task, image::Plane<float>& depth) {
  const scenes::View view = make_view(task.view, task.width, task.height);
  if (view.orthographic) return;
  for (int y = 0; y < task.height; ++y) {
    for (int x = 0; x < task.width; ++x) {
      const glm::vec3 ray = view.ray(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(task.width) +
            static_cast<std::size_t>(x)] *= glm::length(ray);
    }
  }
}

}  // namespace

void keep(raster::Picture&& picture, const Task& task, FrameState& state) {
  const bool is_whole = std::visit([](const auto& image) { return image.pixels() > 0; }, picture);
  state.width = is_whole ? task.width : 0;
  state.height = is_whole ? task.height : 0;
  state.codes = {};
  state.light = {};
  state.depth = {};
  if (!is_whole) return;
  if (task.depth != DELRAY_UNKNOWN) {
    image::Plane<float> depth =
        std::visit([](auto& image) { return std::move(image.depth); }, picture);
    measure_from_eye(task, depth);
    state.depth = upside_down(depth, task.width, task.height);
    std::visit([&](auto& image) { image.depth = image::Plane<float>(image.pixels()); }, picture);
    std::visit([&](auto& image) { std::fill_n(image.depth.data(), image.pixels(), 0.0F); },
               picture);
  }
  if (task.colour == DELRAY_UNKNOWN) return;
  const bool has_background = task.renderer->find("background") != nullptr;
  if (auto* codes = std::get_if<Image8>(&picture)) {
    if (!has_background && task.colour == DELRAY_UFIXED8_RGBA_SRGB) {
      state.codes = upside_down(codes->colour, task.width, task.height);
      return;
    }
    ImageF light = image::to_float(*codes);
    picture = std::move(light);
  }
  ImageF& light = std::get<ImageF>(picture);
  if (has_background) put_behind(*task.renderer, light);
  if (task.colour == DELRAY_FLOAT32_VEC4) {
    state.light = upside_down(light.colour, task.width, task.height);
  } else if (task.colour == DELRAY_UFIXED8_RGBA_SRGB) {
    state.codes = upside_down(image::to_8bit(light).colour, task.width, task.height);
  } else {
    image::Plane<image::Rgba8> codes(light.pixels());
    const auto code = [](float x) { return image::encode_alpha(std::clamp(x, 0.0F, 1.0F)); };
    for (std::size_t i = 0; i < codes.size(); ++i) {
      const image::RgbaF& c = light.colour[i];
      codes[i] = {code(c.r), code(c.g), code(c.b), code(c.a)};
    }
    state.codes = upside_down(codes, task.width, task.height);
  }
}

}  // namespace delray::c
