// The layer over OpenGL: frames are drawn by a program's own OpenGL, read back, and shown.
//
// Functions of OpenGL are looked up among the libraries that the program has, so that this one
// links none. Those of the fixed pipeline are all that is needed.
#include <dlfcn.h>

#include <array>
#include <string>

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
constexpr Enum kPackAlignment = 0x0D05, kUnpackAlignment = 0x0CF5;
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

// Settings of OpenGL that are as before at the end.
class Attributes {
 public:
  Attributes() { call("glPushAttrib", kAllBits); }
  ~Attributes() {
    try {
      call("glPopAttrib");
    } catch (const Error&) {  // it was there a moment ago
    }
  }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;
};

void load_matrices(const double* projection, const double* modelview) {
  call("glMatrixMode", kProjection);
  call("glLoadMatrixd", projection);
  call("glMatrixMode", kModelview);
  call("glLoadMatrixd", modelview);
}

// Reads what lies at the viewport's corner into an image.
void read_back(Context& context, const std::array<int, 4>& viewport, IceTImage result) {
  const double begin = icetWallTime();
  const int width = icetImageGetWidth(result), height = icetImageGetHeight(result);
  const Settings& settings = context.settings;
  call("glReadBuffer", settings.gl_read_buffer);
  call("glPixelStorei", kPackAlignment, 1);
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

// Draws an image at the corner of the viewport, or over all of it.
void show(Context& context, const std::array<int, 4>& viewport, IceTImage image) {
  const Settings& settings = context.settings;
  if (icetImageIsNull(image) != ICET_FALSE || !settings.is_enabled(ICET_GL_DISPLAY)) return;
  if (!settings.has_colour())
    return raise_warning(ICET_INVALID_OPERATION, "an image without colours cannot be shown");
  const double begin = icetWallTime();
  const Attributes attributes;
  const int width = icetImageGetWidth(image), height = icetImageGetHeight(image);
  const std::array<double, 16> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::array<double, 16> projection{}, modelview{};
  call("glGetDoublev", kProjectionMatrix, projection.data());
  call("glGetDoublev", kModelviewMatrix, modelview.data());
  call("glDrawBuffer", settings.gl_read_buffer);
  call("glDisable", kDepthTest);
  if (settings.is_enabled(ICET_GL_DISPLAY_COLORED_BACKGROUND)) {
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
  call("glPixelStorei", kUnpackAlignment, 1);
  if (settings.colour_format == ICET_IMAGE_COLOR_RGBA_UBYTE) {
    call("glDrawPixels", width, height, kRgba, kUnsignedByte,
         static_cast<const void*>(icetImageGetColorcub(image)));
  } else {
    call("glDrawPixels", width, height,
         settings.colour_format == ICET_IMAGE_COLOR_RGB_FLOAT ? kRgb : kRgba, kFloat,
         static_cast<const void*>(icetImageGetColorcf(image)));
  }
  load_matrices(projection.data(), modelview.data());
  context.frame.timings.buffer_write += icetWallTime() - begin;
}

IceTImage draw_gl_frame(Context& context) {
  Settings& settings = context.settings;
  if (!settings.gl_initialised)
    throw Error(ICET_INVALID_OPERATION, "icetGLInitialize was not called for this context");
  if (settings.gl_draw == nullptr)
    throw Error(ICET_INVALID_OPERATION, "there is no function that draws; see icetGLDrawCallback");
  std::array<int, 4> viewport{};
  std::array<double, 16> projection{}, modelview{};
  std::array<float, 4> background{};
  int mode = 0;
  call("glGetIntegerv", kViewport, viewport.data());
  call("glGetIntegerv", kMatrixMode, &mode);
  call("glGetDoublev", kProjectionMatrix, projection.data());
  call("glGetDoublev", kModelviewMatrix, modelview.data());
  call("glGetFloatv", kColourClear, background.data());
  icetPhysicalRenderSize(viewport[2], viewport[3]);
  const auto clear_to = [](const float* colour) {
    call("glClearColor", colour[0], colour[1], colour[2], colour[3]);
  };
  const DrawFunction draw = [&](const IceTDouble* tile_projection, const IceTDouble* tile_modelview,
                                const IceTFloat* colour, const IceTInt* /*readback*/,
                                IceTImage result) {
    load_matrices(tile_projection, tile_modelview);
    clear_to(colour);
    call("glClear", kColourBit | kDepthBit);
    settings.gl_draw();
    read_back(context, viewport, result);
  };
  const double begin = icetWallTime();
  const IceTImage image =
      draw_frame(context, {projection.data(), modelview.data(), background.data()}, draw);
  clear_to(background.data());
  load_matrices(projection.data(), modelview.data());
  show(context, viewport, image);
  call("glMatrixMode", static_cast<Enum>(mode));
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
  return guarded([] { return draw_gl_frame(current()); });
}

}  // extern "C"
