// Frames over the interface of IceT, beside the plain loop over ranks: every strategy, format,
// composite mode and layout of tiles, by callbacks and from images that are there.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <limits>
#include <numeric>
#include <vector>

#include "tests/icet/own_communicator.h"
#include "tests/icet/ranks.h"
#include "tests/icet/scene.h"

namespace {

using scene::drawn;
using scene::Pixel;
using scene::Rect;
using scene::Scene;

const float kBackground[4] = {0.1F, 0.2F, 0.3F, 0.4F};
const double kIdentity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

// Tiles side by side and of different sizes, as many as there are ranks to show them.
std::vector<Rect> set_tiles(bool several, Rect& display) {
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

std::vector<IceTInt> order_of(unsigned seed) {
  std::vector<IceTInt> order(static_cast<std::size_t>(ranks().size));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1], order[Scene::mix(seed + static_cast<unsigned>(i)) % i]);
  }
  return order;
}

// Pixel i of an image is what it should be. Blended bytes are rounded once for each rank.
void check_pixel(IceTImage image, std::size_t i, const Pixel& expected, bool opaque) {
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

IceTInt integer(IceTEnum name) {
  IceTInt value = -77;
  icetGetIntegerv(name, &value);
  return value;
}

// The valid pixels of an image; returns how many there are.
int check_image(IceTImage image, const Scene& scene, const std::vector<Rect>& tiles,
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
void check_collected(IceTImage image, const Scene& scene, const std::vector<Rect>& tiles,
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
constexpr Format kFormats[] = {
    {ICET_IMAGE_COLOR_RGBA_UBYTE, ICET_IMAGE_DEPTH_FLOAT, true},
    {ICET_IMAGE_COLOR_RGBA_FLOAT, ICET_IMAGE_DEPTH_FLOAT, true},
    {ICET_IMAGE_COLOR_RGB_FLOAT, ICET_IMAGE_DEPTH_FLOAT, true},
    {ICET_IMAGE_COLOR_NONE, ICET_IMAGE_DEPTH_FLOAT, true},
    {ICET_IMAGE_COLOR_RGBA_UBYTE, ICET_IMAGE_DEPTH_NONE, false},
    {ICET_IMAGE_COLOR_RGBA_FLOAT, ICET_IMAGE_DEPTH_NONE, false},
};

void set_format(const Format& format, const std::vector<IceTInt>& order) {
  icetSetColorFormat(format.colour);
  icetSetDepthFormat(format.depth);
  icetCompositeMode(format.opaque ? ICET_COMPOSITE_MODE_Z_BUFFER : ICET_COMPOSITE_MODE_BLEND);
  icetCompositeOrder(order.data());
  format.opaque ? icetDisable(ICET_ORDERED_COMPOSITE) : icetEnable(ICET_ORDERED_COMPOSITE);
  icetEnable(ICET_CORRECT_COLORED_BACKGROUND);
}

// Somebody's image of all of the display, of which only a part is valid: the part that the scene
// has of this rank.
struct Given {
  std::vector<std::uint8_t> bytes;
  std::vector<float> floats, depth;
  IceTInt valid[4] = {};
  const void* colour(const Format& format) const {
    if (format.colour == ICET_IMAGE_COLOR_NONE) return nullptr;
    if (format.colour == ICET_IMAGE_COLOR_RGBA_UBYTE) return bytes.data();
    return floats.data();
  }
};

Given give(const Scene& scene, const Format& format) {
  Given given;
  const int rank = ranks().rank;
  const Rect all = scene.display, part = scene.part_of(rank);
  const IceTInt valid[4] = {part.x0 - all.x0, part.y0 - all.y0, part.x1 - part.x0,
                            part.y1 - part.y0};
  std::memcpy(given.valid, valid, sizeof valid);
  for (int y = all.y0; y < all.y1; ++y) {
    for (int x = all.x0; x < all.x1; ++x) {
      const Pixel pixel = part.contains(x, y) ? scene.at(rank, x, y) : Pixel{true, 0, {1, 1, 1, 1}};
      const int channels = format.colour == ICET_IMAGE_COLOR_RGB_FLOAT ? 3 : 4;
      for (int k = 0; k < channels; ++k) {
        given.bytes.push_back(scene::byte(pixel.colour[k]));
        given.floats.push_back(pixel.colour[k]);
      }
      given.depth.push_back(pixel.depth);
    }
  }
  return given;
}

void test_formats(bool several_tiles) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    for (const Format& format : kFormats) {
      Scene scene{ranks().size, seed, {}, format.opaque};
      const std::vector<Rect> tiles = set_tiles(several_tiles, scene.display);
      const std::vector<IceTInt> order = order_of(seed);
      set_format(format, order);
      drawn() = {&scene, ranks().rank, 0};
      scene::tell_bounds(scene, ranks().rank);
      for (const bool one_buffer : {true, false}) {
        one_buffer ? icetEnable(ICET_COMPOSITE_ONE_BUFFER) : icetDisable(ICET_COMPOSITE_ONE_BUFFER);
        check_collected(icetDrawFrame(kIdentity, kIdentity, kBackground), scene, tiles, order);
        const Given given = give(scene, format);
        const bool has_depth = format.depth != ICET_IMAGE_DEPTH_NONE;
        const IceTImage image =
            icetCompositeImage(given.colour(format), has_depth ? given.depth.data() : nullptr,
                               given.valid, nullptr, nullptr, kBackground);
        check_collected(image, scene, tiles, order);
        if (icetImageIsNull(image) != 0) continue;
        const bool both = format.colour != ICET_IMAGE_COLOR_NONE && has_depth;
        CHECK((icetImageGetDepthFormat(image) != ICET_IMAGE_DEPTH_NONE) ==
              (has_depth && !(both && one_buffer)));
      }
    }
  }
}

void test_strategies() {
  constexpr Format kFormat = kFormats[0], kBlended = kFormats[4];
  unsigned seed = 10;
  for (const Format& format : {kFormat, kBlended}) {
    for (IceTEnum strategy = ICET_STRATEGY_DIRECT; strategy <= ICET_STRATEGY_VTREE; ++strategy) {
      for (IceTEnum single = ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC;
           single <= ICET_SINGLE_IMAGE_STRATEGY_BSWAP_FOLDING; ++single) {
        for (const bool interlaces : {true, false}) {
          Scene scene{ranks().size, ++seed, {}, format.opaque};
          const std::vector<Rect> tiles = set_tiles(seed % 2 == 0, scene.display);
          const std::vector<IceTInt> order = order_of(seed);
          set_format(format, order);
          icetStrategy(strategy);
          icetSingleImageStrategy(single);
          interlaces ? icetEnable(ICET_INTERLACE_IMAGES) : icetDisable(ICET_INTERLACE_IMAGES);
          drawn() = {&scene, ranks().rank, 0};
          scene::tell_bounds(scene, ranks().rank);
          check_collected(icetDrawFrame(kIdentity, kIdentity, kBackground), scene, tiles, order);
        }
      }
    }
  }
  icetStrategy(ICET_STRATEGY_REDUCE);
  icetSingleImageStrategy(ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC);
}

// Blended colours are over the background where that is asked for, or the strategy always has it
// so.
void test_background() {
  const float nothing[4] = {0, 0, 0, 0};
  for (const Format& format : kFormats) {
    for (const bool corrects : {true, false}) {
      for (IceTEnum strategy = ICET_STRATEGY_DIRECT; strategy <= ICET_STRATEGY_VTREE; ++strategy) {
        const bool is_over = format.opaque || corrects || strategy == ICET_STRATEGY_SEQUENTIAL ||
                             strategy == ICET_STRATEGY_REDUCE;
        Scene scene{ranks().size, 50, {}, format.opaque, false, !is_over};
        const std::vector<Rect> tiles = set_tiles(strategy % 2 == 0, scene.display);
        const std::vector<IceTInt> order = order_of(50);
        set_format(format, order);
        icetStrategy(strategy);
        corrects ? icetEnable(ICET_CORRECT_COLORED_BACKGROUND)
                 : icetDisable(ICET_CORRECT_COLORED_BACKGROUND);
        drawn() = {&scene, ranks().rank, 0};
        scene::tell_bounds(scene, ranks().rank);
        check_collected(icetDrawFrame(kIdentity, kIdentity, kBackground), scene, tiles, order);
        CHECK(integer(ICET_NEED_BACKGROUND_CORRECTION) == (!format.opaque && corrects ? 1 : 0));
        icetDrawFrame(kIdentity, kIdentity, nothing);
        CHECK(integer(ICET_NEED_BACKGROUND_CORRECTION) == 0);
      }
    }
  }
  icetStrategy(ICET_STRATEGY_REDUCE);
}

// Larger images than tiles, several tiles drawn at once, empty ones too.
void test_render_sizes() {
  for (unsigned seed = 100; seed < 112; ++seed) {  // 108 is a multiple of 12
    for (const Format& format : {kFormats[0], kFormats[4]}) {
      Scene scene{ranks().size, seed, {}, format.opaque};
      const std::vector<Rect> tiles = set_tiles(true, scene.display);
      const std::vector<IceTInt> order = order_of(seed);
      set_format(format, order);
      icetPhysicalRenderSize(45 + static_cast<int>(seed % 50), 27 + static_cast<int>(seed % 30));
      seed % 3 == 0 ? icetDisable(ICET_FLOATING_VIEWPORT) : icetEnable(ICET_FLOATING_VIEWPORT);
      seed % 4 == 0 ? icetEnable(ICET_RENDER_EMPTY_IMAGES) : icetDisable(ICET_RENDER_EMPTY_IMAGES);
      drawn() = {&scene, ranks().rank, 0};
      scene::tell_bounds(scene, ranks().rank);
      check_collected(icetDrawFrame(kIdentity, kIdentity, kBackground), scene, tiles, order);
      if (seed % 12 == 0) CHECK(drawn().calls == static_cast<int>(tiles.size()));
    }
  }
  icetEnable(ICET_FLOATING_VIEWPORT);
  icetDisable(ICET_RENDER_EMPTY_IMAGES);
}

// Each pixel is valid on exactly one rank.
void test_not_collected() {
  icetDisable(ICET_COLLECT_IMAGES);
  for (unsigned seed = 200; seed < 204; ++seed) {
    for (const Format& format : {kFormats[0], kFormats[4]}) {
      Scene scene{ranks().size, seed, {}, format.opaque};
      const std::vector<Rect> tiles = set_tiles(false, scene.display);
      const std::vector<IceTInt> order = order_of(seed);
      set_format(format, order);
      drawn() = {&scene, ranks().rank, 0};
      scene::tell_bounds(scene, ranks().rank);
      const IceTImage image = icetDrawFrame(kIdentity, kIdentity, kBackground);
      int mine = check_image(image, scene, tiles, order), all = 0;
      MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
      CHECK(all == (tiles[0].x1 - tiles[0].x0) * (tiles[0].y1 - tiles[0].y0));
    }
  }
  icetEnable(ICET_COLLECT_IMAGES);
}

// Ranks that have the same draw it once.
void test_replicated() {
  icetDataReplicationGroupColor(7);
  CHECK(integer(ICET_DATA_REPLICATION_GROUP_SIZE) == ranks().size);
  for (const bool several : {false, true}) {
    for (const Format& format : {kFormats[0], kFormats[4]}) {
      Scene scene{ranks().size, 300, {}, format.opaque, true};
      const std::vector<Rect> tiles = set_tiles(several, scene.display);
      const std::vector<IceTInt> order = order_of(300);
      set_format(format, order);
      drawn() = {&scene, ranks().rank, 0};
      scene::tell_bounds(scene, ranks().rank);
      check_collected(icetDrawFrame(kIdentity, kIdentity, kBackground), scene, tiles, order);
    }
  }
  const IceTInt self = ranks().rank;
  icetDataReplicationGroup(1, &self);
}

// Times and bytes of a frame.
void test_timings() {
  double total = -1, render = -1, composite = -1, collect = -1;
  icetGetDoublev(ICET_TOTAL_DRAW_TIME, &total);
  icetGetDoublev(ICET_RENDER_TIME, &render);
  icetGetDoublev(ICET_COMPOSITE_TIME, &composite);
  icetGetDoublev(ICET_COLLECT_TIME, &collect);
  CHECK(total > 0 && render >= 0 && composite > 0 && collect >= 0);
  CHECK(std::abs(total - render - composite) < 1e-9 && collect <= composite);
  CHECK((integer(ICET_BYTES_SENT) > 0) == (ranks().size > 1));
}

// What a callback may not do, and an error on one rank is one on all.
void draw_twice(const IceTDouble*, const IceTDouble*, const IceTFloat*, const IceTInt*, IceTImage) {
  CHECK(icetIsEnabled(ICET_COLLECT_IMAGES) == ICET_TRUE && integer(ICET_IS_DRAWING_FRAME) == 1);
  const auto check_refused = [] { CHECK(icetGetError() == ICET_INVALID_OPERATION); };
  icetSetColorFormat(ICET_IMAGE_COLOR_NONE);
  check_refused();
  icetResetTiles();
  check_refused();
  CHECK(icetAddTile(200, 200, 5, 5, ranks().size - 2) == -1);
  check_refused();
  icetPhysicalRenderSize(500, 500);
  check_refused();
  icetCompositeMode(ICET_COMPOSITE_MODE_BLEND);
  check_refused();
  icetCopyState(icetGetContext(), icetGetContext());
  check_refused();
  CHECK(icetImageIsNull(icetDrawFrame(kIdentity, kIdentity, kBackground)) == ICET_TRUE);
  CHECK(icetGetError() == ICET_INVALID_OPERATION);
}
void draw_nothing(const IceTDouble*, const IceTDouble*, const IceTFloat*, const IceTInt*,
                  IceTImage) {
  throw 1;
}

// Images smaller than the tile leave the rest to the background.
void draw_white(const IceTDouble*, const IceTDouble*, const IceTFloat*, const IceTInt*,
                IceTImage image) {
  for (int i = 0; i < 4 * icetImageGetNumPixels(image); ++i) icetImageGetColorub(image)[i] = 255;
  for (int i = 0; i < icetImageGetNumPixels(image); ++i) icetImageGetDepthf(image)[i] = 0;
}
void test_small_images(const Rect& tile) {
  set_format(kFormats[0], order_of(1));
  icetBoundingVertices(0, ICET_NULL, 0, 0, nullptr);
  icetDrawCallback(&draw_white);
  icetPhysicalRenderSize(10, 7);
  CHECK(icetGetError() == ICET_INVALID_VALUE);  // a warning
  const IceTImage image = icetDrawFrame(kIdentity, kIdentity, kBackground);
  const int width = tile.x1 - tile.x0, height = tile.y1 - tile.y0;
  for (int i = 0; icetImageIsNull(image) == ICET_FALSE && i < width * height; ++i) {
    const bool is_drawn = i % width < 10 && i / width < 7;
    CHECK(icetImageGetColorcub(image)[4 * i] == (is_drawn ? 255 : scene::byte(kBackground[0])));
  }
  icetPhysicalRenderSize(width, height);
}

// Places and sizes that no int holds.
void test_limits() {
  constexpr IceTInt kMost = std::numeric_limits<IceTInt>::max();
  icetResetTiles();
  const IceTInt too_large[][4] = {
      {kMost - 50, 0, 100, 100}, {0, kMost - 50, 100, 100}, {-kMost - 1, 0, kMost, 100},
      {0, 0, 65536, 65536},      {0, 0, kMost, 1},          {0, 0, kMost, kMost}};
  for (const IceTInt* tile : too_large) {
    CHECK(icetAddTile(tile[0], tile[1], tile[2], tile[3], 0) == -1);
    CHECK(icetGetError() == ICET_INVALID_VALUE && integer(ICET_NUM_TILES) == 0);
  }
  CHECK(icetAddTile(-20, 7, 40000, 1, 0) == 0);
  if (ranks().size > 1) CHECK(icetAddTile(-20, 8, 1, 60000, 1) == -1);  // both at once
  icetGetError();
  const IceTInt sizes[][2] = {{65536, 65536}, {-1, 5}, {kMost, 2}};
  for (const IceTInt* size : sizes) {
    icetPhysicalRenderSize(size[0], size[1]);
    CHECK(icetGetError() == ICET_INVALID_VALUE);
    CHECK(integer(ICET_PHYSICAL_RENDER_WIDTH) == 40000 &&
          integer(ICET_PHYSICAL_RENDER_HEIGHT) == 1);
  }
  // Of a part of an image that reaches far beyond it there is what the image has.
  Rect display;
  const Rect tile = set_tiles(false, display)[0];
  const int width = tile.x1 - tile.x0, height = tile.y1 - tile.y0;
  set_format(kFormats[0], order_of(1));
  const std::vector<float> depth(static_cast<std::size_t>(width * height));
  const std::vector<IceTUInt> colour(depth.size(), 0xFFFFFFFF);
  const IceTInt far[4] = {5, 3, kMost, kMost};
  const IceTImage image =
      icetCompositeImage(colour.data(), depth.data(), far, nullptr, nullptr, kBackground);
  for (int i = 0; icetImageIsNull(image) == ICET_FALSE && i < width * height; ++i) {
    const bool is_valid = i % width >= 5 && i / width >= 3;
    CHECK(icetImageGetColorcub(image)[4 * i] == (is_valid ? 255 : scene::byte(kBackground[0])));
  }
  CHECK(icetGetError() == ICET_NO_ERROR);
}

// Where a rank alone has settings that draw nothing, all hear of it instead of waiting.
void test_settings_of_one_rank() {
  const bool is_first = ranks().rank == 0;
  Scene scene{ranks().size, 60, {}, true};
  drawn() = {&scene, ranks().rank, 0};
  const auto check_failed = [&](IceTEnum first_error) {
    CHECK(icetImageIsNull(icetDrawFrame(kIdentity, kIdentity, kBackground)) == ICET_TRUE);
    CHECK(icetGetError() == (is_first ? first_error : ICET_INVALID_OPERATION));
  };
  set_tiles(true, scene.display);
  set_format(kFormats[0], order_of(1));
  icetBoundingVertices(0, ICET_NULL, 0, 0, nullptr);
  if (is_first) icetDrawCallback(nullptr);
  check_failed(ICET_INVALID_OPERATION);
  icetDrawCallback(&scene::draw);
  if (is_first) icetSetDepthFormat(ICET_IMAGE_DEPTH_NONE);
  check_failed(ICET_INVALID_OPERATION);
  set_format(kFormats[5], order_of(1));
  if (is_first) icetSetColorFormat(ICET_IMAGE_COLOR_RGB_FLOAT);
  check_failed(ICET_INVALID_VALUE);
  set_format(kFormats[0], order_of(1));
  if (is_first) icetResetTiles();
  check_failed(ICET_INVALID_OPERATION);
  const std::vector<Rect> tiles = set_tiles(true, scene.display);
  scene::tell_bounds(scene, ranks().rank);
  check_collected(icetDrawFrame(kIdentity, kIdentity, kBackground), scene, tiles, order_of(1));
}

void test_errors() {
  icetDiagnostics(ICET_DIAG_OFF);
  Rect display;
  set_tiles(false, display);
  test_small_images(display);
  set_format(kFormats[0], order_of(1));
  icetBoundingVertices(0, ICET_NULL, 0, 0, nullptr);
  icetDrawCallback(&draw_twice);
  icetDrawFrame(kIdentity, kIdentity, kBackground);
  CHECK(icetGetError() == ICET_NO_ERROR);
  icetDrawCallback(ranks().rank == 0 ? &draw_nothing : &draw_twice);
  CHECK(icetImageIsNull(icetDrawFrame(kIdentity, kIdentity, kBackground)) == ICET_TRUE);
  CHECK(icetGetError() == (ranks().rank == 0 ? ICET_SANITY_CHECK_FAIL : ICET_INVALID_OPERATION));
  std::vector<float> depth(10000, 1.0F);
  std::vector<IceTUInt> colour(10000);
  CHECK(icetImageIsNull(icetCompositeImage(ranks().rank == 0 ? nullptr : colour.data(),
                                           depth.data(), nullptr, nullptr, nullptr, kBackground)) ==
        ICET_TRUE);
  CHECK(icetGetError() == (ranks().rank == 0 ? ICET_INVALID_VALUE : ICET_INVALID_OPERATION));
  const IceTInt order[64] = {};
  icetCompositeOrder(order);
  CHECK(icetGetError() == (ranks().size > 1 ? ICET_INVALID_VALUE : ICET_NO_ERROR));
  icetDrawCallback(nullptr);
  CHECK(icetImageIsNull(icetDrawFrame(kIdentity, kIdentity, kBackground)) == ICET_TRUE);
  CHECK(icetGetError() == ICET_INVALID_OPERATION);
  icetDrawCallback(&scene::draw);
}

// Everything, over a communicator of the interface.
void test_all(IceTCommunicator communicator) {
  const IceTContext context = icetCreateContext(communicator);
  CHECK(context != nullptr && icetGetContext() == context);
  CHECK(integer(ICET_NUM_PROCESSES) == ranks().size && integer(ICET_RANK) == ranks().rank);
  icetStrategy(ICET_STRATEGY_SEQUENTIAL);
  icetDrawCallback(&scene::draw);
  test_formats(false);
  test_formats(true);
  test_timings();
  test_strategies();
  test_background();
  test_render_sizes();
  test_not_collected();
  test_replicated();
  test_errors();
  test_limits();
  test_settings_of_one_rank();
  icetDestroyContext(context);
  CHECK(icetGetContext() == nullptr);
  icetStrategy(ICET_STRATEGY_DIRECT);
  CHECK(icetGetError() == ICET_INVALID_OPERATION);
}

// Two contexts: one is a copy of the other's settings, and both draw.
void test_contexts(IceTCommunicator communicator) {
  const IceTContext first = icetCreateContext(communicator);
  icetStrategy(ICET_STRATEGY_REDUCE);
  icetEnable(ICET_RENDER_EMPTY_IMAGES);
  Scene scene{ranks().size, 400, {}, true};
  const std::vector<Rect> tiles = set_tiles(false, scene.display);
  icetDrawCallback(&scene::draw);
  const IceTContext second = icetCreateContext(communicator);
  CHECK(integer(ICET_NUM_TILES) == 0 && icetIsEnabled(ICET_RENDER_EMPTY_IMAGES) == ICET_FALSE);
  icetCopyState(second, first);
  CHECK(integer(ICET_NUM_TILES) == 1 && icetIsEnabled(ICET_RENDER_EMPTY_IMAGES) == ICET_TRUE);
  const std::vector<IceTInt> order = order_of(1);
  drawn() = {&scene, ranks().rank, 0};
  const IceTImage image = icetDrawFrame(kIdentity, kIdentity, kBackground);
  icetSetContext(first);
  check_collected(icetDrawFrame(kIdentity, kIdentity, kBackground), scene, tiles, order);
  icetSetContext(second);
  check_collected(image, scene, tiles, order);  // as long as this context draws no other
  icetDestroyContext(first);
  CHECK(icetGetContext() == second);
  icetDestroyContext(second);
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const IceTCommunicator over_mpi = icetCreateMPICommunicator(MPI_COMM_WORLD);
  test_contexts(over_mpi);
  test_all(over_mpi);
  const IceTCommunicator wrapped = own::wrap(over_mpi);
  test_all(wrapped);
  delete wrapped;
  icetDestroyMPICommunicator(over_mpi);
  CHECK(icetCreateContext(nullptr) == nullptr && icetGetError() == ICET_INVALID_VALUE);
  MPI_Finalize();
  return 0;
}
