/* Frames from C99: what is seen where, the commit model, arrays that are taken, counts of
 * references. */
#include <math.h>

#include "tests/c/scene.h"

#define W 64
#define H 48

static const unsigned char* pixel(const void* pixels, int x, int y) {
  return (const unsigned char*)pixels + 4 * (y * W + x);
}

static const void* map(DelrayDevice d, DelrayFrame frame, const char* channel,
                       DelrayDataType want) {
  uint32_t width = 0, height = 0;
  DelrayDataType type = DELRAY_UNKNOWN;
  const void* pixels = delrayMapFrame(d, frame, channel, &width, &height, &type);
  CHECK(pixels != NULL && width == W && height == H && type == want);
  return pixels;
}

static void test_frame(const char* renderer) {
  DelrayDevice d = delrayNewDevice(2);
  DelrayWorld world = new_world(d, 3, 1);
  DelrayFrame frame = new_frame(d, world, renderer, DELRAY_UFIXED8_RGBA_SRGB, W, H);
  const unsigned char* p;
  const float* depth;
  float box[6], seconds = -1;
  uint32_t n;
  DelrayDataType type;
  CHECK(delrayFrameReady(d, frame, DELRAY_NO_WAIT) == 0);
  CHECK(delrayMapFrame(d, frame, "channel.color", &n, &n, &type) == NULL);
  OK(delrayRenderFrame(d, frame));
  CHECK(delrayFrameReady(d, frame, DELRAY_WAIT) == 1);
  p = pixel(map(d, frame, "channel.color", DELRAY_UFIXED8_RGBA_SRGB), W / 2, H / 2);
  CHECK(p[0] > 50 && p[1] < 20 && p[2] < 20 && p[3] == 255); /* the triangle */
  p = pixel(map(d, frame, "channel.color", DELRAY_UFIXED8_RGBA_SRGB), W / 2, H / 2 + 10);
  CHECK(p[0] < 20 && p[2] > 50); /* above its tip: the lowest row is first */
  p = pixel(map(d, frame, "channel.color", DELRAY_UFIXED8_RGBA_SRGB), W / 2, H / 2 - 10);
  CHECK(p[0] < 20 && p[2] > 50);
  p = pixel(map(d, frame, "channel.color", DELRAY_UFIXED8_RGBA_SRGB), 0, 0);
  CHECK(p[3] == 0);
  depth = (const float*)map(d, frame, "channel.depth", DELRAY_FLOAT32);
  CHECK(fabsf(depth[H / 2 * W + W / 2] - 2) < 0.01F);
  CHECK(depth[0] > 1e30F);
  /* From the eye, not from the plane through it. */
  CHECK(depth[H / 2 * W + W / 2 + 12] > 3.05F && depth[H / 2 * W + W / 2 + 12] < 3.4F);
  delrayUnmapFrame(d, frame, "channel.color");
  CHECK(delrayGetProperty(d, frame, "duration", DELRAY_FLOAT32, &seconds, sizeof(seconds)) == 1);
  CHECK(seconds >= 0);
  CHECK(delrayGetProperty(d, world, "bounds", DELRAY_FLOAT32_BOX3, box, sizeof(box)) == 1);
  CHECK(box[0] == -1 && box[2] == -3 && box[3] == 1 && box[5] == -2);
  CHECK(delrayGetProperty(d, world, "colour", DELRAY_FLOAT32, box, 4) == 0);
  delrayRelease(d, frame);
  delrayRelease(d, world);
  delrayReleaseDevice(d);
}

static void test_parameters_count_when_they_are_committed(void) {
  DelrayDevice d = delrayNewDevice(1);
  DelrayWorld world = new_world(d, 2, 1);
  DelrayFrame frame = new_frame(d, world, "default", DELRAY_FLOAT32_VEC4, W, H);
  DelrayRenderer renderer = delrayNewRenderer(d, "default");
  const float green[4] = {0, 0.5F, 0, 1};
  const float* p;
  OK(delraySetParameter(d, renderer, "background", DELRAY_FLOAT32_VEC4, green));
  set_object(d, frame, "renderer", DELRAY_RENDERER, renderer);
  OK(delrayRenderFrame(d, frame));
  p = (const float*)map(d, frame, "channel.color", DELRAY_FLOAT32_VEC4);
  CHECK(p[3] == 0); /* neither is committed */
  OK(delrayCommitParameters(d, frame));
  OK(delrayRenderFrame(d, frame));
  p = (const float*)map(d, frame, "channel.color", DELRAY_FLOAT32_VEC4);
  CHECK(p[3] == 0); /* the renderer is not */
  OK(delrayCommitParameters(d, renderer));
  OK(delrayRenderFrame(d, frame));
  p = (const float*)map(d, frame, "channel.color", DELRAY_FLOAT32_VEC4);
  CHECK(p[0] == 0 && p[1] == 0.5F && p[3] == 1);
  delrayRelease(d, renderer);
  delrayRelease(d, frame);
  delrayRelease(d, world);
  delrayReleaseDevice(d);
}

static int deleted = 0;
static void free_it(const void* user_data, const void* memory) {
  CHECK(user_data == &deleted);
  ++deleted;
  free((void*)memory);
}

static void test_arrays(void) {
  DelrayDevice d = delrayNewDevice(1);
  float* memory = (float*)malloc(9 * sizeof(float));
  DelrayArray1D taken, own;
  DelrayGeometry geometry = delrayNewGeometry(d, "triangle");
  uint32_t* indices;
  memcpy(memory, near_positions, sizeof(near_positions));
  taken = delrayNewArray1D(d, memory, free_it, &deleted, DELRAY_FLOAT32_VEC3, 3);
  set_object(d, geometry, "vertex.position", DELRAY_ARRAY1D, taken);
  delrayRelease(d, taken);
  CHECK(deleted == 0); /* the geometry has it */
  own = delrayNewArray1D(d, NULL, NULL, NULL, DELRAY_UINT32_VEC3, 1);
  indices = (uint32_t*)delrayMapArray(d, own);
  CHECK(indices != NULL);
  memcpy(indices, near_triangles, sizeof(near_triangles));
  OK(delrayUnmapArray(d, own));
  FAILS(DELRAY_INVALID_ARGUMENT, delrayUnmapArray(d, own), "mapped");
  set_object(d, geometry, "primitive.index", DELRAY_ARRAY1D, own);
  OK(delrayCommitParameters(d, geometry));
  delrayRetain(d, geometry);
  delrayRelease(d, geometry);
  CHECK(deleted == 0);
  delrayRelease(d, own);
  delrayReleaseDevice(d); /* objects go on living */
  delrayRelease(d, geometry);
  CHECK(deleted == 1);
}

static void test_instances_and_textures(void) {
  DelrayDevice d = delrayNewDevice(1);
  const float white[3] = {1, 1, 1};
  const float uvs[8] = {0, 0, 1, 0, 1, 1, 0, 1};
  const unsigned char texels[16] = {255, 0, 0,   255, 0,   255, 0,   255,
                                    0,   0, 255, 255, 255, 255, 255, 255};
  /* Column by column: half the size, moved to the right. */
  const float transform[16] = {0.5F, 0, 0, 0, 0, 0.5F, 0, 0, 0, 0, 1, 0, 0.75F, 0, 0, 1};
  DelraySurface surface = new_surface(d, far_positions, 4, far_triangles, 2, white, 1);
  DelrayGeometry geometry = delrayNewGeometry(d, "triangle");
  DelraySampler sampler = delrayNewSampler(d, "image2D");
  DelrayArray2D image = delrayNewArray2D(d, texels, NULL, NULL, DELRAY_UFIXED8_RGBA_SRGB, 2, 2);
  DelrayMaterial material = delrayNewMaterial(d, "physicallyBased");
  DelrayGroup group = delrayNewGroup(d);
  DelrayInstance instance = delrayNewInstance(d, "transform");
  DelrayWorld world = delrayNewWorld(d);
  DelrayFrame frame;
  const unsigned char *left, *right;
  const float zero = 0;
  set_array(d, geometry, "vertex.position", far_positions, DELRAY_FLOAT32_VEC3, 4);
  set_array(d, geometry, "vertex.attribute0", uvs, DELRAY_FLOAT32_VEC2, 4);
  set_array(d, geometry, "primitive.index", far_triangles, DELRAY_UINT32_VEC3, 2);
  OK(delrayCommitParameters(d, geometry));
  set_object(d, sampler, "image", DELRAY_ARRAY2D, image);
  OK(delrayCommitParameters(d, sampler));
  set_object(d, material, "baseColor", DELRAY_SAMPLER, sampler);
  OK(delraySetParameter(d, material, "metallic", DELRAY_FLOAT32, &zero));
  OK(delrayCommitParameters(d, material));
  set_object(d, surface, "geometry", DELRAY_GEOMETRY, geometry);
  set_object(d, surface, "material", DELRAY_MATERIAL, material);
  OK(delrayCommitParameters(d, surface));
  set_array(d, group, "surface", &surface, DELRAY_SURFACE, 1);
  OK(delrayCommitParameters(d, group));
  set_object(d, instance, "group", DELRAY_GROUP, group);
  OK(delraySetParameter(d, instance, "transform", DELRAY_FLOAT32_MAT4, transform));
  OK(delrayCommitParameters(d, instance));
  set_array(d, world, "instance", &instance, DELRAY_INSTANCE, 1);
  OK(delrayCommitParameters(d, world));
  frame = new_frame(d, world, "default", DELRAY_UFIXED8_RGBA_SRGB, W, H);
  OK(delrayRenderFrame(d, frame));
  left = pixel(map(d, frame, "channel.color", DELRAY_UFIXED8_RGBA_SRGB), W / 2 - 5, H / 2);
  right = pixel(map(d, frame, "channel.color", DELRAY_UFIXED8_RGBA_SRGB), W / 2 + 5, H / 2 - 3);
  CHECK(left[3] == 0 && right[3] == 255);
  CHECK(right[0] > right[1] && right[0] > right[2]); /* the first texel is at (0, 0) */
  delrayRelease(d, frame);
  delrayRelease(d, world);
  delrayRelease(d, instance);
  delrayRelease(d, group);
  delrayRelease(d, material);
  delrayRelease(d, image);
  delrayRelease(d, sampler);
  delrayRelease(d, geometry);
  delrayRelease(d, surface);
  delrayReleaseDevice(d);
}

static void test_refusals(void) {
  DelrayDevice d = delrayNewDevice(1), other = delrayNewDevice(1);
  DelrayGeometry geometry = delrayNewGeometry(d, "triangle");
  DelrayWorld world = new_world(d, 3, 1);
  DelrayFrame frame = delrayNewFrame(d);
  const float x = 1;
  CHECK(delrayNewGeometry(d, "teapot") == NULL);
  CHECK(strstr(delrayErrorText(), "triangle, sphere") != NULL);
  CHECK(delrayNewDevice(-1) == NULL);
  CHECK(delrayNewArray1D(d, &x, NULL, NULL, DELRAY_STRING, 1) == NULL);
  FAILS(DELRAY_INVALID_ARGUMENT, delraySetParameter(d, geometry, "colour", DELRAY_FLOAT32, &x),
        "no parameter 'colour'");
  FAILS(DELRAY_INVALID_ARGUMENT,
        delraySetParameter(d, geometry, "vertex.position", DELRAY_FLOAT32, &x), "DELRAY_ARRAY1D");
  FAILS(DELRAY_INVALID_ARGUMENT, delraySetParameter(d, frame, "world", DELRAY_WORLD, &geometry),
        "no DELRAY_WORLD");
  FAILS(DELRAY_INVALID_ARGUMENT, delrayCommitParameters(other, geometry), "another device");
  FAILS(DELRAY_INVALID_ARGUMENT, delrayRenderFrame(d, frame), "world is missing");
  FAILS(DELRAY_INVALID_ARGUMENT, delrayRenderFrame(d, geometry), "no DELRAY_FRAME");
  FAILS(DELRAY_INVALID_ARGUMENT, delrayRenderFrame(NULL, frame), "device is NULL");
  delrayRelease(d, frame);

  /* What is wrong with the scene is found when it is rendered. */
  {
    const uint32_t wrong[3] = {0, 1, 9};
    const float red[3] = {1, 0, 0};
    DelraySurface surface = new_surface(d, near_positions, 3, wrong, 1, red, 1);
    set_array(d, world, "surface", &surface, DELRAY_SURFACE, 1);
    OK(delrayCommitParameters(d, world));
    frame = new_frame(d, world, "default", DELRAY_UFIXED8_RGBA_SRGB, W, H);
    FAILS(DELRAY_INVALID_ARGUMENT, delrayRenderFrame(d, frame), "a vertex that is not there");
    CHECK(delrayFrameReady(d, frame, DELRAY_WAIT) == 0);
    delrayRelease(d, frame);
    delrayRelease(d, surface);
  }
  delrayRelease(d, world);
  delrayRelease(d, geometry);
  delrayReleaseDevice(other);
  delrayReleaseDevice(d);
}

int main(void) {
  test_frame("default");
  test_frame("raytrace");
  test_parameters_count_when_they_are_committed();
  test_arrays();
  test_instances_and_textures();
  test_refusals();
  return 0;
}
