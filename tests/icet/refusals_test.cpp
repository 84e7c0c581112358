// What the interface of IceT refuses: on one rank or on all, every rank hears of it and none waits.
#include <limits>
#include <vector>

#include "tests/icet/frame.h"

namespace {

using namespace frame;

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
  icetStrategy(ICET_STRATEGY_SEQUENTIAL);
  test_errors();
  test_limits();
  test_settings_of_one_rank();
  icetDestroyContext(context);
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const IceTCommunicator over_mpi = icetCreateMPICommunicator(MPI_COMM_WORLD);
  test_all(over_mpi);
  const IceTCommunicator wrapped = own::wrap(over_mpi);
  test_all(wrapped);
  delete wrapped;
  icetDestroyMPICommunicator(over_mpi);
  MPI_Finalize();
  return 0;
}
