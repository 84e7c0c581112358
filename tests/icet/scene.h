// A scene that every rank can compute at any pixel of the display, drawn through IceT's callback
// like any other, and the picture that all of it gives.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "icet/mpi_interface.h"
#include "tests/icet/check.h"

namespace scene {

struct Rect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

struct Pixel {
  bool covered = false;
  float depth = 1;
  float colour[4] = {0, 0, 0, 0};  // premultiplied
};

inline std::uint8_t byte(float value) {
  return static_cast<std::uint8_t>(std::floor(255 * value + 0.01F));
}

struct Scene {
  int ranks = 1;
  unsigned seed = 1;
  Rect display;
  bool opaque = true;
  bool replicated = false;    // all ranks have what rank 0 has
  bool over_nothing = false;  // no background

  static std::uint32_t mix(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    return x ^ x >> 16;
  }
  // Where a rank has drawn something; some ranks have drawn nothing.
  Rect part_of(int rank) const {
    if (replicated) rank = 0;
    std::uint32_t random = mix(seed * 977 + static_cast<unsigned>(rank));
    const auto below = [&](int end) {
      random = mix(random + 1);
      return static_cast<int>(random % static_cast<unsigned>(end));
    };
    if (below(8) == 0 && !replicated) return {};
    const int width = display.x1 - display.x0, height = display.y1 - display.y0;
    const int x = below(width), y = below(height);
    return {display.x0 + x, display.y0 + y, display.x0 + x + 1 + below(width - x),
            display.y0 + y + 1 + below(height - y)};
  }
  Pixel at(int rank, int x, int y) const {
    if (replicated) rank = 0;
    Pixel pixel;
    if (!part_of(rank).contains(x, y)) return pixel;
    const std::uint32_t random =
        mix(static_cast<std::uint32_t>(x * 7919 + y * 104729 + rank * 31) + seed);
    if (random % 4 == 0) return pixel;
    pixel.covered = true;
    // Ranks never tie.
    pixel.depth = static_cast<float>(random / 4 % 61 * 16 + static_cast<unsigned>(rank)) / 1000;
    const float alpha = opaque ? 1 : static_cast<float>(1 + random / 8 % 254) / 255;
    pixel.colour[0] = static_cast<float>(random / 16 % 256) / 255 * alpha;
    pixel.colour[1] = static_cast<float>(rank + 1) / 32 * alpha;
    pixel.colour[2] = static_cast<float>(x & 15) / 16 * alpha;
    pixel.colour[3] = alpha;
    return pixel;
  }
  // All ranks, the nearest of them, or those of `order` from the front to the back; of colours that
  // were made bytes before, or not.
  Pixel composited(int x, int y, const std::vector<IceTInt>& order, const float* background_colour,
                   bool as_bytes) const {
    const auto channel = [&](float value) {
      return as_bytes ? static_cast<float>(byte(value)) / 255 : value;
    };
    float background[4];
    for (int k = 0; k < 4; ++k) background[k] = over_nothing ? 0 : channel(background_colour[k]);
    Pixel result;
    for (const IceTInt rank : order) {
      Pixel pixel = at(rank, x, y);
      if (!pixel.covered) continue;
      for (float& value : pixel.colour) value = channel(value);
      if (opaque) {
        if (!result.covered || pixel.depth < result.depth) result = pixel;
      } else {
        const float through = 1 - result.colour[3];
        for (int k = 0; k < 4; ++k) result.colour[k] += pixel.colour[k] * through;
        result.covered = true;
      }
      if (replicated) break;
    }
    const float through = opaque ? (result.covered ? 0.0F : 1.0F) : 1 - result.colour[3];
    for (int k = 0; k < 4; ++k) result.colour[k] += background[k] * through;
    return result;
  }
};

// What the callback, which gets no argument of its own, draws.
struct Drawn {
  const Scene* scene = nullptr;
  int rank = 0;
  int calls = 0;
};
inline Drawn& drawn() {
  static Drawn what;
  return what;
}

// Sets pixel i of an image, in whichever format it has.
inline void set(IceTImage image, std::size_t i, const Pixel& pixel, const float* background) {
  const float* const colour = pixel.covered ? pixel.colour : background;
  switch (icetImageGetColorFormat(image)) {
    case ICET_IMAGE_COLOR_RGBA_UBYTE:
      for (std::size_t k = 0; k < 4; ++k) icetImageGetColorub(image)[4 * i + k] = byte(colour[k]);
      break;
    case ICET_IMAGE_COLOR_RGBA_FLOAT:
      for (std::size_t k = 0; k < 4; ++k) icetImageGetColorf(image)[4 * i + k] = colour[k];
      break;
    case ICET_IMAGE_COLOR_RGB_FLOAT:
      for (std::size_t k = 0; k < 3; ++k) icetImageGetColorf(image)[3 * i + k] = colour[k];
      break;
    default:
      break;
  }
  if (icetImageGetDepthFormat(image) != ICET_IMAGE_DEPTH_NONE)
    icetImageGetDepthf(image)[i] = pixel.depth;
}

// Draws what the matrix shows, and something else outside of the part that is asked for.
inline void draw(const IceTDouble* projection, const IceTDouble* /*modelview*/,
                 const IceTFloat* background, const IceTInt* readback, IceTImage result) {
  Drawn& what = drawn();
  ++what.calls;
  const Scene& scene = *what.scene;
  const int width = icetImageGetWidth(result), height = icetImageGetHeight(result);
  const Rect part{readback[0], readback[1], readback[0] + readback[2], readback[1] + readback[3]};
  const auto in_display = [&](int pixel, int size, int axis, int begin, int end) {
    const double normalised =
        ((2 * pixel + 1.0) / size - 1 - projection[12 + axis]) / projection[5 * axis];
    return begin + static_cast<int>(std::floor((normalised + 1) / 2 * (end - begin) + 1e-6));
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Pixel pixel =
          part.contains(x, y)
              ? scene.at(what.rank, in_display(x, width, 0, scene.display.x0, scene.display.x1),
                         in_display(y, height, 1, scene.display.y0, scene.display.y1))
              : Pixel{true, 0, {1, 1, 1, 1}};
      set(result,
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
              static_cast<std::size_t>(x),
          pixel, background);
    }
  }
}

// Bounds of what a rank has, for a modelview that is the identity.
inline void tell_bounds(const Scene& scene, int rank) {
  const Rect part = scene.part_of(rank);
  const auto normalised = [](int pixel, int begin, int end) {
    return 2.0 * (pixel - begin) / (end - begin) - 1;
  };
  if (part.x0 == part.x1) {  // nowhere
    icetBoundingBoxd(5, 6, 5, 6, 0, 0);
    return;
  }
  icetBoundingBoxd(normalised(part.x0, scene.display.x0, scene.display.x1),
                   normalised(part.x1, scene.display.x0, scene.display.x1),
                   normalised(part.y0, scene.display.y0, scene.display.y1),
                   normalised(part.y1, scene.display.y0, scene.display.y1), -1, 1);
}

}  // namespace scene
