/* Preloaded before whatever has IceT's interface: writes down the images that a program's frames
 * give, as FRAMES.rank.frame, and a line for each to FRAMES.rank, with the times that the interface
 * tells and when, by a clock that processes share, all was drawn and the frame was done. The
 * program notices nothing. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "icet/interface.h"

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static IceTDrawCallbackType draw;
static double drawn_at;

static void draw_and_note(const IceTDouble* projection, const IceTDouble* modelview,
                          const IceTFloat* background, const IceTInt* readback, IceTImage result) {
  draw(projection, modelview, background, readback, result);
  drawn_at = now();
}

void icetDrawCallback(IceTDrawCallbackType callback) {
  draw = callback;
  NEXT(icetDrawCallback)(callback == NULL ? NULL : draw_and_note);
}

IceTImage icetDrawFrame(const IceTDouble* projection, const IceTDouble* modelview,
                        const IceTFloat* background) {
  static int frame = 0;
  const double begin = drawn_at = now();
  const IceTImage image = NEXT(icetDrawFrame)(projection, modelview, background);
  const double end = now();
  const char* const frames = getenv("FRAMES");
  char path[4096];
  FILE* file;
  IceTInt rank = 0, tile = -1, mode = 0;
  double composite = 0, render = 0;
  int width, height;
  if (frames == NULL) return image;
  NEXT(icetGetIntegerv)(ICET_RANK, &rank);
  NEXT(icetGetIntegerv)(ICET_VALID_PIXELS_TILE, &tile);
  NEXT(icetGetIntegerv)(ICET_COMPOSITE_MODE, &mode);
  NEXT(icetGetDoublev)(ICET_COMPOSITE_TIME, &composite);
  NEXT(icetGetDoublev)(ICET_RENDER_TIME, &render);
  width = NEXT(icetImageGetWidth)(image);
  height = NEXT(icetImageGetHeight)(image);
  snprintf(path, sizeof path, "%s.%d", frames, rank);
  file = fopen(path, "a");
  if (file == NULL) abort();
  fprintf(file, "%d %d %d %d %x %.9f %.9f %.9f %.9f %.9f\n", frame, tile, width, height,
          (unsigned)mode, end - begin, composite, render, drawn_at, end);
  fclose(file);
  if (width > 0 && NEXT(icetImageGetColorFormat)(image) == ICET_IMAGE_COLOR_RGBA_UBYTE) {
    snprintf(path, sizeof path, "%s.%d.%d", frames, rank, frame);
    file = fopen(path, "wb");
    if (file == NULL) abort();
    fwrite(NEXT(icetImageGetColorcub)(image), 4, (size_t)width * (size_t)height, file);
    fclose(file);
  }
  ++frame;
  return image;
}
