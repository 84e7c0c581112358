/* A frame of a triangle in front of a quadrilateral, as an ANARI program makes it. */
#ifndef SCENE_H
#define SCENE_H

#include "tests/c/check.h"

static void set_object(DelrayDevice d, DelrayObject o, const char* name, DelrayDataType type,
                       DelrayObject value) {
  OK(delraySetParameter(d, o, name, type, &value));
}

static void set_array(DelrayDevice d, DelrayObject o, const char* name, const void* data,
                      DelrayDataType type, uint64_t n) {
  DelrayArray1D array = delrayNewArray1D(d, data, NULL, NULL, type, n);
  CHECK(array != NULL);
  set_object(d, o, name, DELRAY_ARRAY1D, array);
  delrayRelease(d, array);
}

/* A surface of triangles in one colour. */
static DelraySurface new_surface(DelrayDevice d, const float* positions, uint64_t vertices,
                                 const uint32_t* triangles, uint64_t count, const float rgb[3],
                                 float opacity) {
  DelrayGeometry geometry = delrayNewGeometry(d, "triangle");
  DelrayMaterial material = delrayNewMaterial(d, "matte");
  DelraySurface surface = delrayNewSurface(d);
  CHECK(geometry != NULL && material != NULL && surface != NULL);
  set_array(d, geometry, "vertex.position", positions, DELRAY_FLOAT32_VEC3, vertices);
  set_array(d, geometry, "primitive.index", triangles, DELRAY_UINT32_VEC3, count);
  OK(delrayCommitParameters(d, geometry));
  OK(delraySetParameter(d, material, "color", DELRAY_FLOAT32_VEC3, rgb));
  if (opacity < 1.0F) {
    OK(delraySetParameter(d, material, "opacity", DELRAY_FLOAT32, &opacity));
    OK(delraySetParameter(d, material, "alphaMode", DELRAY_STRING, "blend"));
  }
  OK(delrayCommitParameters(d, material));
  set_object(d, surface, "geometry", DELRAY_GEOMETRY, geometry);
  set_object(d, surface, "material", DELRAY_MATERIAL, material);
  OK(delrayCommitParameters(d, surface));
  delrayRelease(d, geometry);
  delrayRelease(d, material);
  return surface;
}

static const float near_positions[9] = {-0.4F, -0.4F, -2, 0.4F, -0.4F, -2, 0, 0.4F, -2};
static const uint32_t near_triangles[3] = {0, 1, 2};
static const float far_positions[12] = {-1, -1, -3, 1, -1, -3, 1, 1, -3, -1, 1, -3};
static const uint32_t far_triangles[6] = {0, 1, 2, 0, 2, 3};

/* parts: 1 the triangle, 2 the quadrilateral, 3 both. Lit from everywhere, evenly. */
static DelrayWorld new_world(DelrayDevice d, int parts, float opacity) {
  const float red[3] = {1, 0, 0}, blue[3] = {0, 0, 1};
  DelrayWorld world = delrayNewWorld(d);
  DelraySurface surfaces[2];
  uint64_t n = 0, i;
  if (parts & 1) surfaces[n++] = new_surface(d, near_positions, 3, near_triangles, 1, red, opacity);
  if (parts & 2) surfaces[n++] = new_surface(d, far_positions, 4, far_triangles, 2, blue, 1);
  set_array(d, world, "surface", surfaces, DELRAY_SURFACE, n);
  OK(delrayCommitParameters(d, world));
  for (i = 0; i < n; ++i) delrayRelease(d, surfaces[i]);
  return world;
}

static DelrayFrame new_frame(DelrayDevice d, DelrayWorld world, const char* renderer_subtype,
                             DelrayDataType colour, uint32_t width, uint32_t height) {
  DelrayCamera camera = delrayNewCamera(d, "perspective");
  DelrayRenderer renderer = delrayNewRenderer(d, renderer_subtype);
  DelrayFrame frame = delrayNewFrame(d);
  const DelrayDataType depth = DELRAY_FLOAT32;
  const float ambient = 0.7F;
  uint32_t size[2];
  size[0] = width;
  size[1] = height;
  CHECK(camera != NULL && renderer != NULL && frame != NULL);
  OK(delrayCommitParameters(d, camera)); /* at the origin, along -z */
  OK(delraySetParameter(d, renderer, "ambientRadiance", DELRAY_FLOAT32, &ambient));
  OK(delrayCommitParameters(d, renderer));
  set_object(d, frame, "world", DELRAY_WORLD, world);
  set_object(d, frame, "camera", DELRAY_CAMERA, camera);
  set_object(d, frame, "renderer", DELRAY_RENDERER, renderer);
  OK(delraySetParameter(d, frame, "size", DELRAY_UINT32_VEC2, size));
  OK(delraySetParameter(d, frame, "channel.color", DELRAY_DATA_TYPE, &colour));
  OK(delraySetParameter(d, frame, "channel.depth", DELRAY_DATA_TYPE, &depth));
  OK(delrayCommitParameters(d, frame));
  delrayRelease(d, camera);
  delrayRelease(d, renderer);
  return frame;
}

#endif
