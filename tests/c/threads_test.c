/* Two threads at a time: in one triangulation, each with errors of its own, with a device each and
 * with one. */
#include <pthread.h>

#include "tests/c/scene.h"

static DelrayTriangulation mesh;
static double points[400][2];
static DelrayDevice shared;

static void ask(const char* wrong) {
  const double place[2] = {3.5, 4.25};
  uint32_t simplex = 0, again;
  int i;
  DelrayTriangulateOptions options = DELRAY_TRIANGULATE_OPTIONS;
  DelrayTriangulation none = NULL;
  DelrayPoints few;
  few.data = points;
  few.type = DELRAY_FLOAT64;
  few.count = 50;
  few.stride = 0;
  options.method = wrong;
  for (i = 0; i < 50; ++i) {
    CHECK(delrayNeighbours(mesh) != NULL);
    OK(delrayLocate(mesh, place, 1, &again));
    CHECK(i == 0 || again == simplex);
    simplex = again;
    FAILS(DELRAY_INVALID_ARGUMENT, delrayTriangulate(&few, &options, &none), wrong);
  }
}

static void draw(DelrayDevice d) {
  DelrayWorld world = new_world(d, 3, 1);
  DelrayFrame frame = new_frame(d, world, "default", DELRAY_UFIXED8_RGBA_SRGB, 40, 30);
  uint32_t width, height;
  DelrayDataType type;
  int i;
  for (i = 0; i < 3; ++i) {
    const unsigned char* p;
    OK(delrayCommitParameters(d, world));
    OK(delrayRenderFrame(d, frame));
    p = (const unsigned char*)delrayMapFrame(d, frame, "channel.color", &width, &height, &type);
    CHECK(p != NULL && p[4 * (15 * 40 + 20)] > 50);
    delrayUnmapFrame(d, frame, "channel.color");
  }
  delrayRelease(d, frame);
  delrayRelease(d, world);
}

static void* work(void* name) {
  DelrayDevice own = delrayNewDevice(1);
  ask((const char*)name);
  draw(own);
  draw(shared);
  delrayReleaseDevice(own);
  return NULL;
}

int main(void) {
  pthread_t threads[2];
  DelrayPoints all;
  int i;
  for (i = 0; i < 400; ++i) {
    points[i][0] = i % 20;
    points[i][1] = i / 20;
  }
  all.data = points;
  all.type = DELRAY_FLOAT64;
  all.count = 400;
  all.stride = 0;
  OK(delrayTriangulate(&all, NULL, &mesh));
  shared = delrayNewDevice(2);
  CHECK(pthread_create(&threads[0], NULL, work, "first-method") == 0);
  CHECK(pthread_create(&threads[1], NULL, work, "second-method") == 0);
  for (i = 0; i < 2; ++i) CHECK(pthread_join(threads[i], NULL) == 0);
  delrayReleaseDevice(shared);
  delrayReleaseTriangulation(mesh);
  return 0;
}
