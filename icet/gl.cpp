// The layer over OpenGL: frames are drawn by a program's own OpenGL, read back, and shown.
//
// Functions of OpenGL are looked up among the libraries that the program has, so that this one
// links none. Those of the fixed pipeline are all that is needed.
#include <dlfcn.h>

#include <array>
#include <memory>
#include <string>

#include "icet/compose_frame.h"
#include "icet/context.h"
#include "icet/draw.h"
#include "icet/error.h"

namespace delray::icet {
namespace {

using Enum = unsigned;
constexpr Enum kProjectionMatrix = 0x0BA7, kModelviewMatrix = 0x0BA6, kViewport = 0x0BA2;
constexpr Enum kColourClear = 0x0C22, kMatrixMode = 0x0BA0;
constexpr Enum kModelview = 0x1700, kProjection = 0x1701;
constexpr Enum kColourBit = 0x4000, kDepthBit = 0x0100;
constexpr Enum kRgba = 0x1908, kRgb = 0x1907, kDepthComponent = 0x1902;
constexpr Enum kUnsignedByte = 0x1401, kFloat = 0x1406;
constexpr Enum kPixelStoreBit = 1;
// What glPixelStorei sets for reading (pack) and drawing (unpack).
constexpr Enum kPackSwapBytes = 0x0D00, kPackRowLength = 0x0D02, kPackSkipRows = 0x0D03;
constexpr Enum kPackSkipPixels = 0x0D04, kPackAlignment = 0x0D05;
constexpr Enum kUnpackSwapBytes = 0x0CF0, kUnpackRowLength = 0x0CF2, kUnpackSkipRows = 0x0CF3;
constexpr Enum kUnpackSkipPixels = 0x0CF4, kUnpackAlignment = 0x0CF5;
constexpr Enum kDepthTest = 0x0B71, kBlend = 0x0BE2, kAllBits = 0x000FFFFF;
constexpr Enum kOne = 1, kOneMinusSourceAlpha = 0x0303;

void* find_function(const char* name) {
  if (void* const found = dlsym(RTLD_DEFAULT, name)) return found;
  // Loaded, but for somebody else's eyes only.
  for (const char* const library : {"libGL.so.1", "libOpenGL.so.0"}) {
    if (void* const handle = dlopen(library, RTLD_LAZY | RTLD_NOLOAD)) {
      void* const found = dlsym(handle, name);
      dlclose(handle);
      if (found != nullptr) return found;
    }
  }
  throw Error(ICET_INVALID_OPERATION, std::string("the program has no OpenGL: ") + name);
}

template <class... T>
void call(const char* name, T... arguments) {
  reinterpret_cast<void (*)(T...)>(find_function(name))(arguments...);
}

// At the end of a scope: functions that were there a moment ago are found again.
template <class F>
void restore(F&& f) noexcept {
  try {
    f();
  } catch (const Error&) {
  }
}

// Settings of OpenGL that are as before at the end.
class Attributes {
 public:
  Attributes() { call("glPushAttrib", kAllBits); }
  ~Attributes() {
    restore([] { call("glPopAttrib"); });
  }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;
};

// Rows of pixels in memory follow each other without gaps, whatever the program has set; as before
// at the end.
class DenseRows {
 public:
  DenseRows() {
    call("glPushClientAttrib", kPixelStoreBit);
    for (const Enum name :
         {kPackSwapBytes, kPackRowLength, kPackSkipRows, kPackSkipPixels, kUnpackSwapBytes,
          kUnpackRowLength, kUnpackSkipRows, kUnpackSkipPixels}) {
      call("glPixelStorei", name, 0);
    }
    for (const Enum name : {kPackAlignment, kUnpackAlignment}) call("glPixelStorei", name, 1);
  }
  ~DenseRows() {
    restore([] { call("glPopClientAttrib"); });
  }
  DenseRows(const DenseRows&) = delete;
  DenseRows& operator=(const DenseRows&) = delete;
};

void load_matrices(const double* projection, const double* modelview) {
  call("glMatrixMode", kProjection);
  call("glLoadMatrixd", projection);
  call("glMatrixMode", kModelview);
  call("glLoadMatrixd", modelview);
}

void clear_to(const float* colour) {
  call("glClearColor", colour[0], colour[1], colour[2], colour[3]);
}

// What a program has set before a frame, and has again at the end.
class ProgramView {
 public:
  ProgramView() {
    call("glGetIntegerv", kViewport, viewport.data());
    call("glGetIntegerv", kMatrixMode, &mode_);
    call("glGetDoublev", kProjectionMatrix, projection.data());
    call("glGetDoublev", kModelviewMatrix, modelview.data());
    call("glGetFloatv", kColourClear, background.data());
  }
  ~ProgramView() {
    restore([&] {
      clear_to(background.data());
      load_matrices(projection.data(), modelview.data());
      call("glMatrixMode", static_cast<Enum>(mode_));
    });
  }
  ProgramView(const ProgramView&) = delete;
  ProgramView& operator=(const ProgramView&) = delete;

  std::array<int, 4> viewport{};
  std::array<double, 16> projection{}, modelview{};
  std::array<float, 4> background{};

 private:
  int mode_ = 0;
};

// Reads what lies at the viewport's corner into an image.
void read_back(Context& context, const std::array<int, 4>& viewport, IceTImage result) {
  const double begin = icetWallTime();
  const int width = icetImageGetWidth(result), height = icetImageGetHeight(result);
  const Settings& settings = context.settings;
  call("glReadBuffer", settings.gl_read_buffer);
  const DenseRows dense_rows;
  const auto read = [&](Enum format, Enum type, void* to) {
    call("glReadPixels", viewport[0], viewport[1], width, height, format, type, to);
  };
  if (settings.colour_format == ICET_IMAGE_COLOR_RGBA_UBYTE) {
    read(kRgba, kUnsignedByte, icetImageGetColorub(result));
  } else if (settings.has_colour()) {
    read(settings.colour_format == ICET_IMAGE_COLOR_RGB_FLOAT ? kRgb : kRgba, kFloat,
         icetImageGetColorf(result));
  }
  if (settings.has_depth()) read(kDepthComponent, kFloat, icetImageGetDepthf(result));
  const double seconds = icetWallTime() - begin;
  context.frame.timings.buffer_read += seconds;
  context.frame.timings.render -= seconds;  // it is measured around this
}

// Draws an image at the corner of the viewport, or over all of it. Leaves other matrices.
void show(Context& context, const std::array<int, 4>& viewport, IceTImage image) {
  const Settings& settings = context.settings;
  if (icetImageIsNull(image) != ICET_FALSE || !settings.is_enabled(ICET_GL_DISPLAY)) return;
  if (!settings.has_colour())
    return raise_warning(ICET_INVALID_OPERATION, "an image without colours cannot be shown");
  const double begin = icetWallTime();
  const Attributes attributes;
  const DenseRows dense_rows;
  const int width = icetImageGetWidth(image), height = icetImageGetHeight(image);
  const std::array<double, 16> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  call("glDrawBuffer", settings.gl_read_buffer);
  call("glDisable", kDepthTest);
  // What is blended over the background already is not once more.
  if (settings.blends() && settings.is_enabled(ICET_GL_DISPLAY_COLORED_BACKGROUND) &&
      !settings.is_enabled(ICET_CORRECT_COLORED_BACKGROUND)) {
    call("glEnable", kBlend);
    call("glBlendFunc", kOne, kOneMinusSourceAlpha);
    call("glClear", kColourBit);
  } else {
    call("glDisable", kBlend);
  }
  load_matrices(identity.data(), identity.data());
  call("glRasterPos2d", -1.0, -1.0);
  if (settings.is_enabled(ICET_GL_DISPLAY_INFLATE)) {
    call("glPixelZoom", static_cast<float>(viewport[2]) / static_cast<float>(width),
         static_cast<float>(viewport[3]) / static_cast<float>(height));
  } else {
    call("glPixelZoom", 1.0F, 1.0F);
  }
  if (settings.colour_format == ICET_IMAGE_COLOR_RGBA_UBYTE) {
    call("glDrawPixels", width, height, kRgba, kUnsignedByte,
         static_cast<const void*>(icetImageGetColorcub(image)));
  } else {
    call("glDrawPixels", width, height,
         settings.colour_format == ICET_IMAGE_COLOR_RGB_FLOAT ? kRgb : kRgba, kFloat,
         static_cast<const void*>(icetImageGetColorcf(image)));
  }
  context.frame.timings.buffer_write += icetWallTime() - begin;
}

// What a frame begins with; throws Error where this rank cannot draw.
std::unique_ptr<ProgramView> begin_gl_frame(const Settings& settings) {
  if (!settings.gl_initialised)
    throw Error(ICET_INVALID_OPERATION, "icetGLInitialize was not called for this context");
  if (settings.gl_draw == nullptr)
    throw Error(ICET_INVALID_OPERATION, "there is no function that draws; see icetGLDrawCallback");
  return std::make_unique<ProgramView>();
}

IceTImage draw_gl_frame(Context& context) {
  const double begin = icetWallTime();
  const Settings& settings = context.settings;
  std::unique_ptr<ProgramView> view;
  try {
    view = begin_gl_frame(settings);
  } catch (...) {
    fail_frame(context);
    throw;
  }
  icetPhysicalRenderSize(view->viewport[2], view->viewport[3]);
  const DrawFunction draw = [&](const IceTDouble* projection, const IceTDouble* modelview,
                                const IceTFloat* background, const IceTInt* /*readback*/,
                                IceTImage result) {
    load_matrices(projection, modelview);
    clear_to(background);
    call("glClear", kColourBit | kDepthBit);
    settings.gl_draw();
    read_back(context, view->viewport, result);
  };
  const IceTImage image = draw_frame(
      context, {view->projection.data(), view->modelview.data(), view->background.data()}, draw);
  clear_to(view->background.data());
  show(context, view->viewport, image);
  view.reset();
  context.frame.timings.total = icetWallTime() - begin;
  return image;
}

// Buffers that glReadBuffer knows: GL_FRONT_LEFT to GL_RIGHT, GL_AUX0 to GL_AUX3.
bool is_buffer(Enum mode) { return mode >= 0x0400 && mode <= 0x040C && mode != 0x0408; }

Settings& initialised() {
  Settings& settings = current().settings;
  if (!settings.gl_initialised)
    throw Error(ICET_INVALID_OPERATION, "icetGLInitialize was not called for this context");
  return settings;
}

}  // namespace
}  // namespace delray::icet

using namespace delray::icet;

extern "C" {

void icetGLInitialize(void) {
  guarded([] {
    Settings& settings = current().settings;
    if (settings.gl_initialised)
      raise_warning(ICET_INVALID_OPERATION, "icetGLInitialize was called before");
    settings.gl_initialised = true;
  });
}

IceTBoolean icetGLIsInitialized(void) {
  return guarded(
      []() -> IceTBoolean { return current().settings.gl_initialised ? ICET_TRUE : ICET_FALSE; });
}

void icetGLSetReadBuffer(unsigned int mode) {
  guarded([&] {
    if (!is_buffer(mode)) throw Error(ICET_INVALID_ENUM, "there is no such buffer of OpenGL");
    initialised().gl_read_buffer = mode;
  });
}

void icetGLDrawCallback(IceTGLDrawCallbackType callback) {
  guarded([&] { initialised().gl_draw = callback; });
}

IceTImage icetGLDrawFrame(void) {
  return guarded([] { return draw_gl_frame(current_not_drawing()); });
}

}  // extern "C"
