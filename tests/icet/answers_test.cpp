// What the interface answers, line by line: run with IceT's own libraries and with Delray's, the
// lines are the same. Values of names come in, too, so that icet/interface.h agrees with IceT's.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "icet/mpi_interface.h"
#include "tests/icet/check.h"

namespace {

std::FILE* out() {
  static std::FILE* file = nullptr;
  if (file == nullptr) {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const std::string path = std::string(std::getenv("ANSWERS")) + "." + std::to_string(rank);
    file = std::fopen(path.c_str(), "w");
    CHECK(file != nullptr);
  }
  return file;
}

// A name of the state as all types that there are.
void state(const char* name, IceTEnum value, int count = 1) {
  std::vector<double> doubles(64, -99);
  std::vector<float> floats(64, -99);
  std::vector<IceTInt> integers(64, -99);
  std::vector<IceTBoolean> booleans(64, 99);
  icetGetError();
  icetGetDoublev(value, doubles.data());
  const IceTEnum error = icetGetError();
  icetGetFloatv(value, floats.data());
  icetGetIntegerv(value, integers.data());
  icetGetBooleanv(value, booleans.data());
  icetGetError();
  std::fprintf(out(), "%s error %x:", name, error);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count) + 1; ++i) {
    std::fprintf(out(), " %.6g %.6g %d %d", doubles[i], floats[i], integers[i], booleans[i]);
  }
  std::fprintf(out(), "\n");
}
#define STATE(...) state(STATE_NAME(__VA_ARGS__, ), __VA_ARGS__)
#define STATE_NAME(name, ...) #name

void error(const char* after) {
  std::fprintf(out(), "%s: error %x\n", after, icetGetError());
  std::fflush(out());
}

bool has_holes = false;  // some pixels are empty, some translucent; of bytes without depth

void draw(const IceTDouble* projection, const IceTDouble* modelview, const IceTFloat* background,
          const IceTInt* readback, IceTImage image) {
  for (int i = 0; i < 16; ++i) std::fprintf(out(), " %.9g %.9g", projection[i], modelview[i]);
  for (int i = 0; i < 4; ++i) std::fprintf(out(), " %.6g %d", background[i], readback[i]);
  std::fprintf(out(), "\nimage %d x %d, %x %x\n", icetImageGetWidth(image),
               icetImageGetHeight(image), icetImageGetColorFormat(image),
               icetImageGetDepthFormat(image));
  STATE(ICET_CONTAINED_VIEWPORT, 4);
  STATE(ICET_RENDERED_VIEWPORT, 4);
  STATE(ICET_NUM_CONTAINED_TILES);
  STATE(ICET_BACKGROUND_COLOR, 4);
  STATE(ICET_BACKGROUND_COLOR_WORD);
  STATE(ICET_TRUE_BACKGROUND_COLOR, 4);
  STATE(ICET_TRUE_BACKGROUND_COLOR_WORD);
  STATE(ICET_NEED_BACKGROUND_CORRECTION);
  STATE(ICET_IS_DRAWING_FRAME);
  STATE(ICET_PROJECTION_MATRIX, 16);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const int pixels = icetImageGetNumPixels(image);
  for (int i = 0; i < pixels; ++i) {
    const bool covered = i % 3 != 0;
    if (has_holes) {  // where one rank alone has colours none are rounded
      const IceTUByte colours[3][4] = {{0, 0, 0, 0}, {80, 40, 20, 255}, {12, 34, 56, 128}};
      std::memcpy(icetImageGetColorub(image) + 4 * i, colours[rank == 0 ? i % 3 : 0], 4);
      continue;
    }
    if (icetImageGetColorFormat(image) == ICET_IMAGE_COLOR_RGBA_UBYTE) {
      const IceTUByte colour[4] = {static_cast<IceTUByte>(i), 7, 9, 255};
      std::memcpy(icetImageGetColorub(image) + 4 * i, colour, 4);
    }
    if (icetImageGetDepthFormat(image) != ICET_IMAGE_DEPTH_NONE)
      icetImageGetDepthf(image)[i] = covered ? static_cast<float>(i % 5) / 8 + 0.01F * rank : 1;
  }
}

void show(IceTImage image) {
  std::fprintf(out(), "result %d: %d x %d = %d, %x %x\n", icetImageIsNull(image),
               icetImageGetWidth(image), icetImageGetHeight(image), icetImageGetNumPixels(image),
               icetImageGetColorFormat(image), icetImageGetDepthFormat(image));
  STATE(ICET_FRAME_COUNT);
  const auto pixels = static_cast<std::size_t>(icetImageGetNumPixels(image));
  if (pixels == 0) return;
  STATE(ICET_VALID_PIXELS_TILE);
  STATE(ICET_VALID_PIXELS_OFFSET);
  STATE(ICET_VALID_PIXELS_NUM);
  if (icetImageGetColorFormat(image) != ICET_IMAGE_COLOR_NONE) {
    std::vector<IceTUByte> bytes(4 * pixels);
    std::vector<float> rgba(4 * pixels), rgb(3 * pixels);
    icetImageCopyColorub(image, bytes.data(), ICET_IMAGE_COLOR_RGBA_UBYTE);
    icetImageCopyColorf(image, rgba.data(), ICET_IMAGE_COLOR_RGBA_FLOAT);
    icetImageCopyColorf(image, rgb.data(), ICET_IMAGE_COLOR_RGB_FLOAT);
    for (const IceTUByte value : bytes) std::fprintf(out(), " %d", value);
    for (const float value : rgba) std::fprintf(out(), " %.6g", value);
    for (const float value : rgb) std::fprintf(out(), " %.6g", value);
  }
  if (icetImageGetDepthFormat(image) != ICET_IMAGE_DEPTH_NONE) {
    std::vector<float> depth(pixels);
    icetImageCopyDepthf(image, depth.data(), ICET_IMAGE_DEPTH_FLOAT);
    for (const float value : depth) std::fprintf(out(), " %.6g", value);
  }
  std::fprintf(out(), "\n");
  error("image");
}

const float kBackground[4] = {0.2F, 0.4F, 0.6F, 0.5F};
// Over others than red translucent colours are rounded, and cut off by IceT.
const float kRed[4] = {1, 0, 0, 1}, kNothing[4] = {}, kNearlyNothing[4] = {0.001F, 0.002F, 0, 0};
const double kIdentity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
const double kPerspective[16] = {1, 0, 0, 0, 0, 1.3, 0, 0, 0, 0, -1.1, -1, 0, 0, -0.5, 0};

void frame(const double* projection = kIdentity) {
  show(icetDrawFrame(projection, kIdentity, kBackground));
}

void ask_defaults() {
  STATE(ICET_DIAGNOSTIC_LEVEL);
  STATE(ICET_RANK);
  STATE(ICET_NUM_PROCESSES);
  STATE(ICET_BACKGROUND_COLOR, 4);
  STATE(ICET_BACKGROUND_COLOR_WORD);
  STATE(ICET_PHYSICAL_RENDER_WIDTH);
  STATE(ICET_PHYSICAL_RENDER_HEIGHT);
  STATE(ICET_COLOR_FORMAT);
  STATE(ICET_DEPTH_FORMAT);
  STATE(ICET_NUM_TILES);
  STATE(ICET_TILE_VIEWPORTS);
  STATE(ICET_GLOBAL_VIEWPORT, 4);
  STATE(ICET_TILE_MAX_WIDTH);
  STATE(ICET_TILE_MAX_HEIGHT);
  STATE(ICET_DISPLAY_NODES);
  STATE(ICET_TILE_DISPLAYED);
  STATE(ICET_GEOMETRY_BOUNDS);
  STATE(ICET_NUM_BOUNDING_VERTS);
  STATE(ICET_STRATEGY);
  STATE(ICET_SINGLE_IMAGE_STRATEGY);
  STATE(ICET_COMPOSITE_MODE);
  STATE(ICET_COMPOSITE_ORDER, 2);
  STATE(ICET_PROCESS_ORDERS, 2);
  STATE(ICET_STRATEGY_SUPPORTS_ORDERING);
  STATE(ICET_DATA_REPLICATION_GROUP);
  STATE(ICET_DATA_REPLICATION_GROUP_SIZE);
  STATE(ICET_FRAME_COUNT);
  STATE(ICET_MAGIC_K);
  STATE(ICET_MAX_IMAGE_SPLIT);
  STATE(ICET_DRAW_FUNCTION);
  STATE(ICET_RENDER_LAYER_DESTRUCTOR);
  STATE(ICET_IS_DRAWING_FRAME);
  STATE(ICET_PROJECTION_MATRIX);
  STATE(ICET_CONTAINED_VIEWPORT);
  STATE(ICET_VALID_PIXELS_TILE);
  STATE(ICET_VALID_PIXELS_NUM);
  STATE(ICET_RENDER_TIME);
  STATE(ICET_BUFFER_READ_TIME);
  STATE(ICET_BUFFER_WRITE_TIME);
  STATE(ICET_COMPRESS_TIME);
  STATE(ICET_INTERLACE_TIME);
  STATE(ICET_COMPARE_TIME);
  STATE(ICET_COMPOSITE_TIME);
  STATE(ICET_COLLECT_TIME);
  STATE(ICET_TOTAL_DRAW_TIME);
  STATE(ICET_BYTES_SENT);
  STATE(ICET_FLOATING_VIEWPORT);
  STATE(ICET_ORDERED_COMPOSITE);
  STATE(ICET_CORRECT_COLORED_BACKGROUND);
  STATE(ICET_COMPOSITE_ONE_BUFFER);
  STATE(ICET_INTERLACE_IMAGES);
  STATE(ICET_COLLECT_IMAGES);
  STATE(ICET_RENDER_EMPTY_IMAGES);
  STATE(static_cast<IceTEnum>(0x1FF));
}

void ask_errors() {
  std::fprintf(out(), "tile %d\n", icetAddTile(0, 0, 0, 4, 0));
  error("empty tile");
  std::fprintf(out(), "tile %d\n", icetAddTile(0, 0, 8, 4, 70));
  error("tile of nobody");
  frame();
  error("no tiles");
  std::fprintf(out(), "tile %d\n", icetAddTile(10, 20, 8, 4, 0));
  error("tile");
  std::fprintf(out(), "tile %d\n", icetAddTile(18, 20, 8, 4, 0));
  error("second tile");
  frame();
  error("no strategy");
  icetStrategy(0x6009);
  error("strategy");
  icetStrategy(ICET_STRATEGY_SEQUENTIAL);
  frame();
  error("no callback");
  icetPhysicalRenderSize(4, 4);
  error("small render size");
  icetPhysicalRenderSize(8, 4);
  icetCompositeMode(0x77);
  error("mode");
  icetSetColorFormat(0x77);
  error("colour format");
  icetSetDepthFormat(0x77);
  error("depth format");
  icetEnable(0x77);
  error("enable");
  icetDisable(ICET_STATE_ENABLE_START | 0x20);
  error("disable");
  std::fprintf(out(), "%d\n", icetIsEnabled(0x77));
  error("is enabled");
  icetBoundingVertices(3, 0x77, 0, 1, kIdentity);
  error("vertices");
  const IceTInt other[1] = {30};
  icetDataReplicationGroup(1, other);
  error("group");
  icetSingleImageStrategy(0x7777);
  error("single-image strategy");
  void* pointer = nullptr;
  icetGetPointerv(ICET_RANK, &pointer);
  error("pointer");
  const IceTImage null = icetImageNull();
  icetImageGetColorub(null);
  error("colour of null");
  icetImageGetDepthf(null);
  error("depth of null");
}

void ask_names() {
  for (IceTEnum strategy = ICET_STRATEGY_DIRECT; strategy <= ICET_STRATEGY_VTREE; ++strategy) {
    icetStrategy(strategy);
    std::fprintf(out(), "%s\n", icetGetStrategyName());
    STATE(ICET_STRATEGY_SUPPORTS_ORDERING);
  }
  for (IceTEnum single = ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC;
       single <= ICET_SINGLE_IMAGE_STRATEGY_BSWAP_FOLDING; ++single) {
    icetSingleImageStrategy(single);
    std::fprintf(out(), "%s\n", icetGetSingleImageStrategyName());
  }
  icetStrategy(ICET_STRATEGY_SEQUENTIAL);
  icetSingleImageStrategy(ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC);
}

void ask_frames() {
  icetDrawCallback(&draw);
  frame();
  icetDisable(ICET_COMPOSITE_ONE_BUFFER);
  frame();
  icetSetColorFormat(ICET_IMAGE_COLOR_NONE);
  frame();
  icetSetColorFormat(ICET_IMAGE_COLOR_RGBA_UBYTE);
  icetSetDepthFormat(ICET_IMAGE_DEPTH_NONE);
  icetCompositeMode(ICET_COMPOSITE_MODE_BLEND);
  icetEnable(ICET_CORRECT_COLORED_BACKGROUND);
  frame();  // all pixels hide the others
  has_holes = true;
  for (const bool corrects : {true, false}) {
    corrects ? icetEnable(ICET_CORRECT_COLORED_BACKGROUND)
             : icetDisable(ICET_CORRECT_COLORED_BACKGROUND);
    for (const IceTEnum strategy : {ICET_STRATEGY_DIRECT, ICET_STRATEGY_SPLIT, ICET_STRATEGY_REDUCE,
                                    ICET_STRATEGY_SEQUENTIAL}) {
      icetStrategy(strategy);
      for (const float* background : {kRed, kNothing, kNearlyNothing}) {
        const IceTImage image = icetDrawFrame(kIdentity, kIdentity, background);
        IceTInt tile = -1;
        icetGetIntegerv(ICET_TILE_DISPLAYED, &tile);
        if (tile >= 0)
          show(image);  // with some strategies IceT returns one that has no valid pixels
      }
    }
  }
  has_holes = false;
  icetCompositeMode(ICET_COMPOSITE_MODE_Z_BUFFER);
  icetSetDepthFormat(ICET_IMAGE_DEPTH_FLOAT);
}

// Where bounds are seen.
void ask_bounds() {
  icetResetTiles();
  icetAddTile(0, 0, 20, 12, 0);
  const double boxes[][6] = {{-0.33, 0.21, -0.5, 0.77, 0, 0.1},
                             {-2, 0, -2, 0, 0, 0.5},
                             {-0.2, 0.2, -0.2, 0.2, -3, 0.5},
                             {0.5, 2, 2, 3, 0, 0},
                             {-0.1, 0, -1.0 / 6, 0, 0, 0}};
  for (const auto& box : boxes) {
    icetBoundingBoxd(box[0], box[1], box[2], box[3], box[4], box[5]);
    frame();
    STATE(ICET_CONTAINED_VIEWPORT, 4);
    STATE(ICET_GEOMETRY_BOUNDS, 24);
  }
  const double before_eye[][6] = {{-1, 1, -1, 1, -5, -3},
                                  {-1, 1, -1, 1, -5, 3},
                                  {-1, 1, -1, 1, 3, 5},
                                  {-1, 0.03, -1, 0.04, -2, -0.1}};
  for (const auto& box : before_eye) {
    icetBoundingBoxf(static_cast<float>(box[0]), static_cast<float>(box[1]),
                     static_cast<float>(box[2]), static_cast<float>(box[3]),
                     static_cast<float>(box[4]), static_cast<float>(box[5]));
    frame(kPerspective);
    STATE(ICET_CONTAINED_VIEWPORT, 4);
  }
  const float far_away = 3e38F;
  icetBoundingVertices(1, ICET_FLOAT, 0, 1, &far_away);
  frame(kPerspective);
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float odd : {std::nanf(""), infinity, -infinity}) {
    for (int k = 0; k < 3; ++k) {
      float corners[] = {-0.5F, -0.25F, -2, 0.25F, 0.5F, -3, 0.75F, 0.75F, -4};
      corners[3 * k + k] = odd;
      for (const double* projection : {kIdentity, kPerspective}) {
        icetBoundingVertices(3, ICET_FLOAT, 0, 3, corners);
        frame(projection);
        STATE(ICET_CONTAINED_VIEWPORT, 4);
        STATE(ICET_NEAR_DEPTH);
        STATE(ICET_FAR_DEPTH);
      }
    }
  }
  const float vertices[] = {0, 0, 77, 0, 0.9F, 77, -0.9F, -0.8F, 77};
  icetBoundingVertices(2, ICET_FLOAT, 12, 3, vertices);
  STATE(ICET_GEOMETRY_BOUNDS, 9);
  STATE(ICET_NUM_BOUNDING_VERTS);
  frame();
  icetPhysicalRenderSize(28, 17);
  frame();
  icetBoundingVertices(0, ICET_NULL, 0, 0, nullptr);
  STATE(ICET_NUM_BOUNDING_VERTS);
}

void ask_given() {
  std::vector<IceTUInt> colour(240);
  std::vector<float> depth(240);
  for (std::size_t i = 0; i < 240; ++i) {
    colour[i] = static_cast<IceTUInt>(0xFF000000U + i * 7919);
    depth[i] = static_cast<float>(i % 9) / 8;
  }
  const IceTInt part[4] = {3, 2, 5, 6}, beyond[4] = {-10, -20, 500, 600};
  for (const IceTInt* valid : {part, beyond, static_cast<const IceTInt*>(nullptr)}) {
    show(icetCompositeImage(colour.data(), depth.data(), valid, nullptr, nullptr, kBackground));
    STATE(ICET_CONTAINED_VIEWPORT, 4);
  }
}

// With two processes or more.
void ask_tiles() {
  icetResetTiles();
  icetAddTile(0, 0, 10, 6, 0);
  icetAddTile(10, 0, 8, 6, 1);
  STATE(ICET_TILE_VIEWPORTS, 8);
  STATE(ICET_DISPLAY_NODES, 2);
  STATE(ICET_GLOBAL_VIEWPORT, 4);
  STATE(ICET_TILE_DISPLAYED);
  frame();
  icetBoundingBoxd(-0.3, 0.3, -0.2, 0.3, 0, 0);
  frame();
  icetDisable(ICET_FLOATING_VIEWPORT);
  frame();
  icetDataReplicationGroupColor(3);
  STATE(ICET_DATA_REPLICATION_GROUP_SIZE);
  STATE(ICET_DATA_REPLICATION_GROUP, 2);
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  const IceTCommunicator communicator = icetCreateMPICommunicator(MPI_COMM_WORLD);
  const IceTContext context = icetCreateContext(communicator);
  ask_defaults();
  icetDiagnostics(ICET_DIAG_OFF);
  STATE(ICET_DIAGNOSTIC_LEVEL);
  ask_errors();
  ask_names();
  ask_frames();
  ask_bounds();
  ask_given();
  if (size > 1) ask_tiles();
  icetDestroyContext(context);
  std::fprintf(out(), "%d\n", icetGetContext() == nullptr);
  icetDestroyMPICommunicator(communicator);
  std::fclose(out());
  MPI_Finalize();
  return 0;
}
