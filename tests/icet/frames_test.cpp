// Frames over the interface of IceT, beside the plain loop over ranks: every strategy, format,
// composite mode and layout of tiles, by callbacks and from images that are there.
#include <cstdint>
#include <cstring>
#include <vector>

#include "tests/icet/frame.h"

namespace {

using namespace frame;

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
