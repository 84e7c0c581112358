// IceT's layer over OpenGL, with functions of OpenGL that this program has itself: a framebuffer in
// memory that is cleared, drawn into by a callback, read back and drawn over.
#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "icet/mpi_interface.h"
#include "tests/icet/check.h"

namespace {

constexpr int kWidth = 40, kHeight = 30, kX = 5, kY = 2;  // of the viewport, and where it begins

// What OpenGL would know.
struct Gl {
  std::array<double, 16> matrices[2] = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
  unsigned matrix_mode = 0x1700, read_buffer = 0;
  std::array<float, 4> clear_colour = {0.5F, 0.25F, 0, 1};
  std::vector<unsigned char> colour =
      std::vector<unsigned char>(4 * (kX + kWidth) * (kY + kHeight));
  std::vector<float> depth = std::vector<float>((kX + kWidth) * (kY + kHeight), 1.0F);
  int drawn_width = 0, drawn_height = 0, pushed = 0;
  // As a program has set it, which has read into something wider: swapped bytes, LSB first, row
  // length, skipped rows and pixels, alignment; of reading (0x0D00) and of drawing (0x0CF0).
  std::array<int, 6> pack = {1, 0, 77, 3, 5, 8}, unpack = {1, 0, 99, 2, 7, 2};
  std::vector<std::array<std::array<int, 6>, 2>> pushed_pixel_store;
  std::vector<unsigned char> drawn;
  std::array<float, 2> zoom{};
  unsigned char* pixel(int x, int y) { return &colour[4 * ((kY + y) * (kX + kWidth) + kX + x)]; }
  float& depth_at(int x, int y) { return depth[(kY + y) * (kX + kWidth) + kX + x]; }
};
Gl& gl() {
  static Gl state;
  return state;
}
std::array<double, 16>& matrix() { return gl().matrices[gl().matrix_mode == 0x1701 ? 1 : 0]; }

int rank() {
  int result = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &result);
  return result;
}

// In the midst of a frame something else is set.
void fail() {
  gl().matrix_mode = 0x1701;
  throw 1;
}

// Covers columns of its rank.
void draw() {
  CHECK(gl().matrix_mode == 0x1700);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = rank(); x < kWidth; x += 3) {
      const unsigned char colour[4] = {static_cast<unsigned char>(10 + rank()), 1, 2, 255};
      std::memcpy(gl().pixel(x, y), colour, 4);
      gl().depth_at(x, y) = 0.25F + 0.125F * static_cast<float>(rank());
    }
  }
}

}  // namespace

extern "C" {
#pragma GCC visibility push(default)
void glGetIntegerv(unsigned name, int* values) {
  const int viewport[4] = {kX, kY, kWidth, kHeight};
  if (name == 0x0BA2) std::memcpy(values, viewport, sizeof viewport);
  if (name == 0x0BA0) *values = static_cast<int>(gl().matrix_mode);
}
void glGetDoublev(unsigned name, double* values) {
  std::copy_n(gl().matrices[name == 0x0BA7 ? 1 : 0].data(), 16, values);
}
void glGetFloatv(unsigned name, float* values) {
  CHECK(name == 0x0C22);
  std::copy_n(gl().clear_colour.data(), 4, values);
}
void glMatrixMode(unsigned mode) { gl().matrix_mode = mode; }
void glLoadMatrixd(const double* values) { std::copy_n(values, 16, matrix().data()); }
void glClearColor(float r, float g, float b, float a) { gl().clear_colour = {r, g, b, a}; }
void glClear(unsigned bits) {
  for (std::size_t i = 0; (bits & 0x4000) != 0 && i < gl().colour.size(); ++i) {
    gl().colour[i] = static_cast<unsigned char>(255 * gl().clear_colour[i % 4]);
  }
  if ((bits & 0x100) != 0) std::fill(gl().depth.begin(), gl().depth.end(), 1.0F);
}
void glReadBuffer(unsigned mode) { gl().read_buffer = mode; }
void glDrawBuffer(unsigned mode) { CHECK(mode == gl().read_buffer || gl().read_buffer == 0); }
void glPixelStorei(unsigned name, int value) {
  CHECK((name & ~0xFU) == 0x0D00 || (name & ~0xFU) == 0x0CF0);
  ((name & ~0xFU) == 0x0D00 ? gl().pack : gl().unpack)[name & 0xFU] = value;
}
void glPushClientAttrib(unsigned bits) {
  CHECK((bits & 1) != 0);
  gl().pushed_pixel_store.push_back({gl().pack, gl().unpack});
}
void glPopClientAttrib() {
  CHECK(!gl().pushed_pixel_store.empty());
  gl().pack = gl().pushed_pixel_store.back()[0];
  gl().unpack = gl().pushed_pixel_store.back()[1];
  gl().pushed_pixel_store.pop_back();
}
void glReadPixels(int x, int y, int width, int height, unsigned format, unsigned, void* to) {
  CHECK(x == kX && y == kY && width == kWidth && height == kHeight);
  const std::array<int, 6> dense = {0, 0, 0, 0, 0, 1};
  CHECK(gl().pack == dense);
  for (int row = 0; row < height; ++row) {
    if (format == 0x1902) {
      std::memcpy(static_cast<float*>(to) + row * width, &gl().depth_at(0, row),
                  sizeof(float) * static_cast<std::size_t>(width));
    } else {
      std::memcpy(static_cast<unsigned char*>(to) + 4 * row * width, gl().pixel(0, row),
                  4 * static_cast<std::size_t>(width));
    }
  }
}
void glPushAttrib(unsigned) { ++gl().pushed; }
void glPopAttrib() { --gl().pushed; }
void glDisable(unsigned) {}
void glEnable(unsigned) {}
void glBlendFunc(unsigned, unsigned) {}
void glRasterPos2d(double x, double y) { CHECK(x == -1 && y == -1); }
void glPixelZoom(float x, float y) { gl().zoom = {x, y}; }
void glDrawPixels(int width, int height, unsigned, unsigned, const void* pixels) {
  const std::array<int, 6> dense = {0, 0, 0, 0, 0, 1};
  CHECK(gl().unpack == dense);
  gl().drawn_width = width;
  gl().drawn_height = height;
  const auto* const bytes = static_cast<const unsigned char*>(pixels);
  gl().drawn.assign(bytes, bytes + 4 * width * height);
}
#pragma GCC visibility pop
}

// What a frame leaves as the program has set it.
void check_restored() {
  CHECK(gl().pushed == 0 && gl().matrix_mode == 0x1700 && gl().clear_colour[0] == 0.5F);
  for (const auto& values : gl().matrices) {
    CHECK(values[0] == 1 && values[5] == 1 && values[13] == 0);
  }
  const Gl before;
  CHECK(gl().pushed_pixel_store.empty() && gl().pack == before.pack);
  CHECK(gl().unpack == before.unpack);
}

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  const IceTCommunicator communicator = icetCreateMPICommunicator(MPI_COMM_WORLD);
  const IceTContext context = icetCreateContext(communicator);
  icetDiagnostics(ICET_DIAG_OFF);
  CHECK(icetGLIsInitialized() == ICET_FALSE);
  icetGLDrawCallback(&draw);
  CHECK(icetGetError() == ICET_INVALID_OPERATION);
  CHECK(icetImageIsNull(icetGLDrawFrame()) == ICET_TRUE);
  CHECK(icetGetError() == ICET_INVALID_OPERATION);
  // Where one rank cannot draw, the others do not wait for it.
  if (rank() != 0) {
    icetGLInitialize();
    icetGLDrawCallback(&draw);
  }
  icetAddTile(0, 0, kWidth, kHeight - 10, 0);  // lower than the viewport
  icetStrategy(ICET_STRATEGY_REDUCE);
  CHECK(icetGetError() == ICET_NO_ERROR);
  CHECK(icetImageIsNull(icetGLDrawFrame()) == ICET_TRUE);
  CHECK(icetGetError() == ICET_INVALID_OPERATION);
  check_restored();
  if (rank() == 0) icetGLInitialize();
  CHECK(icetGLIsInitialized() == ICET_TRUE && icetGetError() == ICET_NO_ERROR);
  icetGLInitialize();
  CHECK(icetGetError() == ICET_INVALID_OPERATION);
  icetGLSetReadBuffer(0x1234);
  CHECK(icetGetError() == ICET_INVALID_ENUM);
  icetGLSetReadBuffer(0x0404);  // GL_FRONT
  icetGLDrawCallback(rank() == 0 ? &fail : &draw);
  CHECK(icetImageIsNull(icetGLDrawFrame()) == ICET_TRUE);
  CHECK(icetGetError() == (rank() == 0 ? ICET_SANITY_CHECK_FAIL : ICET_INVALID_OPERATION));
  check_restored();
  icetGLDrawCallback(&draw);
  void* callback = nullptr;
  icetGetPointerv(ICET_GL_DRAW_FUNCTION, &callback);
  CHECK(callback == reinterpret_cast<void*>(&draw));
  icetEnable(ICET_GL_DISPLAY_INFLATE);
  const IceTImage image = icetGLDrawFrame();
  CHECK(icetGetError() == ICET_NO_ERROR);
  CHECK(gl().read_buffer == 0x0404);
  check_restored();
  double read = 0, write = -1;
  icetGetDoublev(ICET_BUFFER_READ_TIME, &read);
  icetGetDoublev(ICET_BUFFER_WRITE_TIME, &write);
  CHECK(read > 0 && (write > 0) == (rank() == 0));
  CHECK((icetImageIsNull(image) == ICET_FALSE) == (rank() == 0));
  if (rank() == 0) {
    CHECK(gl().drawn_width == kWidth && gl().drawn_height == kHeight - 10);
    CHECK(gl().zoom[0] == 1 && gl().zoom[1] == 30.0F / 20);
    for (int i = 0; i < kWidth * (kHeight - 10); ++i) {
      const int column = i % kWidth % 3;
      const IceTUByte* const pixel = icetImageGetColorcub(image) + 4 * i;
      CHECK(pixel[0] == (column < size ? 10 + column : 127));
      CHECK(std::memcmp(pixel, &gl().drawn[4 * static_cast<std::size_t>(i)], 4) == 0);
    }
  }
  icetDestroyContext(context);
  icetDestroyMPICommunicator(communicator);
  MPI_Finalize();
  return 0;
}
