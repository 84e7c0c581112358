// Tiles, formats and checks that programs which draw frames have in common.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "tests/icet/own_communicator.h"
#include "tests/icet/ranks.h"
#include "tests/icet/scene.h"

namespace frame {

using scene::drawn;
using scene::Pixel;
using scene::Rect;
using scene::Scene;

inline constexpr float kBackground[4] = {0.1F, 0.2F, 0.3F, 0.4F};
inline constexpr double kIdentity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

// Tiles side by side and of different sizes, as many as there are ranks to show them.
inline std::vector<Rect> set_tiles(bool several, Rect& display) {
  const Ranks all = ranks();
  std::vector<Rect> tiles = {{10, 20, 77, 61}};
  if (several) {
    tiles = {{-5, 3, 40, 30}, {40, 3, 81, 30}, {-5, 30, 40, 52}, {40, 30, 81, 52}};
    tiles.resize(static_cast<std::size_t>(std::min(4, all.size)));
  }
  icetResetTiles();
  display = tiles[0];
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const Rect& tile = tiles[i];
    const int display_rank = all.size - 1 - static_cast<int>(i);
    CHECK(icetAddTile(tile.x0, tile.y0, tile.x1 - tile.x0, tile.y1 - tile.y0, display_rank) ==
          static_cast<int>(i));
    display = {std::min(display.x0, tile.x0), std::min(display.y0, tile.y0),
               std::max(display.x1, tile.x1), std::max(display.y1, tile.y1)};
  }
  return tiles;
}

inline std::vector<IceTInt> order_of(unsigned seed) {
  std::vector<IceTInt> order(static_cast<std::size_t>(ranks().size));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1], order[Scene::mix(seed + static_cast<unsigned>(i)) % i]);
  }
  return order;
}

// Pixel i of an image is what it should be. Blended bytes are rounded once for each rank.
inline void check_pixel(IceTImage image, std::size_t i, const Pixel& expected, bool opaque) {
  const float most = opaque ? 0.01F : 0.5F * static_cast<float>(ranks().size + 1);
  switch (icetImageGetColorFormat(image)) {
    case ICET_IMAGE_COLOR_RGBA_UBYTE:
      for (std::size_t k = 0; k < 4; ++k) {
        const float got = icetImageGetColorcub(image)[4 * i + k];
        CHECK(std::abs(got - 255 * expected.colour[k]) <= most);
      }
      break;
    case ICET_IMAGE_COLOR_RGBA_FLOAT:
      for (std::size_t k = 0; k < 4; ++k)
        CHECK(std::abs(icetImageGetColorcf(image)[4 * i + k] - expected.colour[k]) < 1e-4F);
      break;
    case ICET_IMAGE_COLOR_RGB_FLOAT:
      for (std::size_t k = 0; k < 3; ++k)
        CHECK(std::abs(icetImageGetColorcf(image)[3 * i + k] - expected.colour[k]) < 1e-4F);
      break;
    default:
      break;
  }
  if (opaque && icetImageGetDepthFormat(image) != ICET_IMAGE_DEPTH_NONE)
    CHECK(icetImageGetDepthcf(image)[i] == expected.depth);
}

inline IceTInt integer(IceTEnum name) {
  IceTInt value = -77;
  icetGetIntegerv(name, &value);
  return value;
}

// The valid pixels of an image; returns how many there are.
inline int check_image(IceTImage image, const Scene& scene, const std::vector<Rect>& tiles,
                       const std::vector<IceTInt>& order) {
  CHECK(icetGetError() == ICET_NO_ERROR && own::unfinished() == 0);
  const int tile = integer(ICET_VALID_PIXELS_TILE), pixels = integer(ICET_VALID_PIXELS_NUM);
  CHECK((icetImageIsNull(image) != 0) == (pixels == 0));
  if (pixels == 0) return 0;
  const Rect& place = tiles[static_cast<std::size_t>(tile)];
  CHECK(icetImageGetWidth(image) == place.x1 - place.x0);
  CHECK(icetImageGetHeight(image) == place.y1 - place.y0);
  for (int i = integer(ICET_VALID_PIXELS_OFFSET), k = 0; k < pixels; ++i, ++k) {
    const int x = place.x0 + i % icetImageGetWidth(image);
    const int y = place.y0 + i / icetImageGetWidth(image);
    const bool as_bytes = icetImageGetColorFormat(image) == ICET_IMAGE_COLOR_RGBA_UBYTE;
    check_pixel(image, static_cast<std::size_t>(i),
                scene.composited(x, y, order, kBackground, as_bytes), scene.opaque);
  }
  return pixels;
}

// Each rank that shows a tile has all of it, others nothing.
inline void check_collected(IceTImage image, const Scene& scene, const std::vector<Rect>& tiles,
                            const std::vector<IceTInt>& order) {
  const int pixels = check_image(image, scene, tiles, order);
  const int shown = ranks().size - 1 - ranks().rank;
  if (shown >= static_cast<int>(tiles.size())) {
    CHECK(pixels == 0 && integer(ICET_VALID_PIXELS_TILE) == -1);
    return;
  }
  const Rect& tile = tiles[static_cast<std::size_t>(shown)];
  CHECK(integer(ICET_VALID_PIXELS_TILE) == shown && integer(ICET_TILE_DISPLAYED) == shown);
  CHECK(pixels == (tile.x1 - tile.x0) * (tile.y1 - tile.y0));
}

struct Format {
  IceTEnum colour, depth;
  bool opaque;
};
inline constexpr Format kFormats[] = {
    {ICET_IMAGE_COLOR_RGBA_UBYTE, ICET_IMAGE_DEPTH_FLOAT, true},
    {ICET_IMAGE_COLOR_RGBA_FLOAT, ICET_IMAGE_DEPTH_FLOAT, true},
    {ICET_IMAGE_COLOR_RGB_FLOAT, ICET_IMAGE_DEPTH_FLOAT, true},
    {ICET_IMAGE_COLOR_NONE, ICET_IMAGE_DEPTH_FLOAT, true},
    {ICET_IMAGE_COLOR_RGBA_UBYTE, ICET_IMAGE_DEPTH_NONE, false},
    {ICET_IMAGE_COLOR_RGBA_FLOAT, ICET_IMAGE_DEPTH_NONE, false},
};

inline void set_format(const Format& format, const std::vector<IceTInt>& order) {
  icetSetColorFormat(format.colour);
  icetSetDepthFormat(format.depth);
  icetCompositeMode(format.opaque ? ICET_COMPOSITE_MODE_Z_BUFFER : ICET_COMPOSITE_MODE_BLEND);
  icetCompositeOrder(order.data());
  format.opaque ? icetDisable(ICET_ORDERED_COMPOSITE) : icetEnable(ICET_ORDERED_COMPOSITE);
  icetEnable(ICET_CORRECT_COLORED_BACKGROUND);
}

}  // namespace frame
