// Delray for C and for whatever calls C: exact Delaunay triangulations, compositing over MPI, and
// rendering with the objects, parameters and the commit model of Khronos ANARI 1.0.
//
// Errors. Functions that return DelrayStatus give DELRAY_SUCCESS or why not; those that return a
// handle or an address give NULL. delrayErrorText() says why in a sentence, until the same thread's
// next call that fails. No exception leaves the library, and what fails leaves its outputs as they
// were.
//
// Memory. Arrays of arguments are borrowed for the call, unless it is said that they are kept.
// Results that a function points to belong to the handle, and live as long.
//
// Threads. Handles of triangulations are read by any number of threads at a time. Calls for one
// device may come from any thread; they take turns, and a frame that is rendered is one turn.
// Different handles and devices have nothing in common. Calls over an MPI communicator are
// collective, and made by one thread of each process.
//
// The library starts no thread that outlives a call, but for oneTBB's workers, and installs no
// signal handler.
#ifndef DELRAY_H
#define DELRAY_H

#include <stddef.h>
#include <stdint.h>

/* Rises when a function or an enumerator is added. Options have a size, so that older programs go
 * on working. */
#define DELRAY_API_VERSION 1

#define DELRAY_API __attribute__((visibility("default")))

#ifdef __cplusplus
extern "C" {
#endif

typedef enum DelrayStatus {
  DELRAY_SUCCESS = 0,
  DELRAY_INVALID_ARGUMENT = 1, /* what cannot be, or not with the rest */
  DELRAY_INVALID_INPUT = 2,    /* a broken file, or a message that is none of ours */
  DELRAY_DEVICE_FAILED = 3,    /* a file that cannot be read or written */
  DELRAY_OUT_OF_MEMORY = 4,
  DELRAY_RANK_LOST = 5,
  DELRAY_INTERRUPTED = 6,
  DELRAY_INTERNAL = 7 /* a mistake in here: please report the text */
} DelrayStatus;

DELRAY_API int delrayApiVersion(void);      /* of the library, to compare with DELRAY_API_VERSION */
DELRAY_API const char* delrayVersion(void); /* "0.2.0" */
DELRAY_API const char* delrayErrorText(
    void); /* of this thread's last failure; "" before the first */

/* The numbers that arrays and parameters hold. */
typedef enum DelrayDataType {
  DELRAY_UNKNOWN = 0,
  DELRAY_STRING, /* char, ended by zero */
  DELRAY_BOOL,   /* int32_t */
  DELRAY_VOID_POINTER,
  DELRAY_DATA_TYPE, /* DelrayDataType */
  DELRAY_INT32,
  DELRAY_UINT32,
  DELRAY_UINT32_VEC2,
  DELRAY_UINT32_VEC3,
  DELRAY_UINT64,
  DELRAY_FLOAT32,
  DELRAY_FLOAT32_VEC2,
  DELRAY_FLOAT32_VEC3,
  DELRAY_FLOAT32_VEC4,
  DELRAY_FLOAT32_MAT4, /* column by column */
  DELRAY_FLOAT32_BOX3,
  DELRAY_FLOAT64,
  DELRAY_UFIXED8_VEC3, /* linear, 255 is 1 */
  DELRAY_UFIXED8_VEC4,
  DELRAY_UFIXED8_RGB_SRGB,
  DELRAY_UFIXED8_RGBA_SRGB, /* alpha is linear */
  DELRAY_ARRAY1D,           /* from here on: handles */
  DELRAY_ARRAY2D,
  DELRAY_CAMERA,
  DELRAY_FRAME,
  DELRAY_GEOMETRY,
  DELRAY_GROUP,
  DELRAY_INSTANCE,
  DELRAY_LIGHT,
  DELRAY_MATERIAL,
  DELRAY_RENDERER,
  DELRAY_SAMPLER,
  DELRAY_SURFACE,
  DELRAY_WORLD
} DelrayDataType;

/* ---- Triangulation ---- */

typedef struct DelrayTriangulation_* DelrayTriangulation;

/* Coordinate k of point i is the number of `type` (DELRAY_FLOAT64 or DELRAY_FLOAT32) at data + i *
 * stride bytes + k numbers. stride 0: points lie side by side. */
typedef struct DelrayPoints {
  const void* data;
  DelrayDataType type;
  uint64_t count; /* at most 2^29 */
  uint64_t stride;
} DelrayPoints;

/* Begin with DELRAY_TRIANGULATE_OPTIONS. Names are those of `delray triangulate --list`; NULL: the
 * best. */
typedef struct DelrayTriangulateOptions {
  uint64_t size; /* of this struct */
  int dim;       /* 2 or 3 */
  int threads;   /* at most; from 1 */
  const char* method;
  const char* location;
  const char* split;
  const char* order;
  uint64_t seed;
} DelrayTriangulateOptions;
#define DELRAY_TRIANGULATE_OPTIONS \
  { sizeof(DelrayTriangulateOptions), 2, 1, NULL, NULL, NULL, NULL, 1 }

/* The Delaunay triangulation, exact and the same for all options. The points are kept: they must
 * neither change nor go before the triangulation is released. Points that are all equal, on a line
 * or (3D) on a plane have no simplices, which is no error. O(n log n) expected. */
DELRAY_API DelrayStatus delrayTriangulate(const DelrayPoints* points,
                                          const DelrayTriangulateOptions* options,
                                          DelrayTriangulation* triangulation);
DELRAY_API void delrayReleaseTriangulation(
    DelrayTriangulation triangulation); /* NULL: nothing happens */

#define DELRAY_NONE 0xFFFFFFFFu /* in place of a row or simplex */

/* dim + 1 rows of points for each simplex, positively oriented (2D: counterclockwise); of equal
 * points the lowest row. */
DELRAY_API uint64_t delraySimplexCount(DelrayTriangulation triangulation);
DELRAY_API const uint32_t* delraySimplices(DelrayTriangulation triangulation);
/* dim + 1 for each simplex: the one opposite to corner k, DELRAY_NONE beyond the hull. Made by the
 * first call. */
DELRAY_API const uint32_t* delrayNeighbours(DelrayTriangulation triangulation);
/* dim rows for each edge or triangle of the convex hull. Made by the first call. */
DELRAY_API const uint32_t* delrayHullFacets(DelrayTriangulation triangulation, uint64_t* count);
/* The identity of the set of simplices: 32 hexadecimal digits and a zero. */
DELRAY_API DelrayStatus delrayHash(DelrayTriangulation triangulation, char hash[33]);
/* For each of `count` places (dim numbers each) a simplex that contains it, boundaries included, or
 * DELRAY_NONE. Exact. */
DELRAY_API DelrayStatus delrayLocate(DelrayTriangulation triangulation, const double* places,
                                     uint64_t count, uint32_t* simplices);
/* The vertex nearest to each place. */
DELRAY_API DelrayStatus delrayNearest(DelrayTriangulation triangulation, const double* places,
                                      uint64_t count, uint32_t* rows);
typedef enum DelrayInterpolation {
  DELRAY_LINEAR = 0,           /* on each simplex */
  DELRAY_NATURAL_NEIGHBOUR = 1 /* Sibson 1981 */
} DelrayInterpolation;
/* Values at places between points, of which each has one in `values`; NaN outside of the hull. */
DELRAY_API DelrayStatus delrayInterpolate(DelrayTriangulation triangulation,
                                          DelrayInterpolation how, const double* values,
                                          const double* places, uint64_t count, double* results);

typedef struct DelrayVerdict {
  int valid;        /* the simplices cover the convex hull once, and use every distinct point */
  int delaunay;     /* and no circumscribed sphere has a point inside */
  int canonical;    /* and they are those that delrayTriangulate gives */
  uint64_t simplex; /* the first that breaks the first of these that fails; UINT64_MAX: none */
  uint64_t distinct;
  char reason[256]; /* a sentence about that */
} DelrayVerdict;
/* Checks simplices that anybody made: `count` times dim + 1 rows. */
DELRAY_API DelrayStatus delrayVerify(const DelrayPoints* points, int dim, const uint32_t* simplices,
                                     uint64_t count, DelrayVerdict* verdict);

/* ---- Compositing ---- */

/* The ranks of a communicator. `mpi_communicator` is the address of an MPI_Comm, which is
 * duplicated; MPI is initialised with MPI_THREAD_FUNNELED or more, and outlives the handle.
 * Collective, and so is its release. */
typedef struct DelrayCommunicator_* DelrayCommunicator;
DELRAY_API DelrayCommunicator delrayNewCommunicator(const void* mpi_communicator);
DELRAY_API void delrayReleaseCommunicator(DelrayCommunicator communicator);
DELRAY_API int delrayRank(DelrayCommunicator communicator);
DELRAY_API int delrayRanks(DelrayCommunicator communicator);

/* Begin with DELRAY_COMPOSE_OPTIONS. Names are those of `delray compose --list`. */
typedef struct DelrayComposeOptions {
  uint64_t size;
  const char* scheme; /* NULL: radix-k */
  const char* codec;  /* NULL: active */
  int interlace;      /* not 0: pixels that lie beside each other go to different ranks */
  int root;           /* who gets the picture */
  float empty_depth;  /* of a pixel that nothing covers */
  int threads;        /* of each rank */
} DelrayComposeOptions;
#define DELRAY_COMPOSE_OPTIONS \
  { sizeof(DelrayComposeOptions), NULL, NULL, 0, 0, 1.0F, 1 }

/* Row-major planes without gaps. `colour` is premultiplied by alpha: DELRAY_UFIXED8_RGBA_SRGB or
 * DELRAY_FLOAT32_VEC4. `depth` is smaller where nearer; NULL: images lie over each other, that of
 * rank 0 in front. */
typedef struct DelrayImage {
  uint32_t width, height;
  DelrayDataType type;
  void* colour;
  float* depth;
} DelrayImage;
/* The images of all ranks merged, into `whole` of the root, whose planes the caller has; `whole` of
 * others may be NULL. Of equally near pixels that of the lower rank wins. Collective. */
DELRAY_API DelrayStatus delrayCompose(DelrayCommunicator communicator, const DelrayImage* mine,
                                      const DelrayComposeOptions* options, DelrayImage* whole);

/* ---- Rendering, as in ANARI 1.0 ----
 *
 * Objects have parameters, which delraySetParameter sets and delrayCommitParameters makes known;
 * docs/c.md has them all. Handles are counted: a new one counts once, objects that others refer to
 * live as long as these. */

typedef struct DelrayDevice_* DelrayDevice;
typedef struct DelrayObject_* DelrayObject;
typedef DelrayObject DelrayArray1D;
typedef DelrayObject DelrayArray2D;
typedef DelrayObject DelrayCamera;
typedef DelrayObject DelrayFrame;
typedef DelrayObject DelrayGeometry;
typedef DelrayObject DelrayGroup;
typedef DelrayObject DelrayInstance;
typedef DelrayObject DelrayLight;
typedef DelrayObject DelrayMaterial;
typedef DelrayObject DelrayRenderer;
typedef DelrayObject DelraySampler;
typedef DelrayObject DelraySurface;
typedef DelrayObject DelrayWorld;

/* `threads` of each frame; 0: all cores. Objects of a device that is released live until they are.
 */
DELRAY_API DelrayDevice delrayNewDevice(int threads);
DELRAY_API void delrayReleaseDevice(DelrayDevice device);

typedef void (*DelrayMemoryDeleter)(const void* user_data, const void* app_memory);
/* Items in the caller's memory, which must not change between delrayUnmapArray and the next
 * delrayMapArray. With a deleter it is the array's, which calls it once, from any thread; without,
 * it must outlive the array. app_memory NULL: the array has memory of its own, to be written to
 * between map and unmap. Items that are handles are kept. */
DELRAY_API DelrayArray1D delrayNewArray1D(DelrayDevice device, const void* app_memory,
                                          DelrayMemoryDeleter deleter, const void* user_data,
                                          DelrayDataType type, uint64_t items);
DELRAY_API DelrayArray2D delrayNewArray2D(DelrayDevice device, const void* app_memory,
                                          DelrayMemoryDeleter deleter, const void* user_data,
                                          DelrayDataType type, uint64_t items1, uint64_t items2);
DELRAY_API void* delrayMapArray(DelrayDevice device, DelrayObject array);
DELRAY_API DelrayStatus delrayUnmapArray(DelrayDevice device, DelrayObject array);

DELRAY_API DelrayCamera delrayNewCamera(DelrayDevice device,
                                        const char* subtype); /* perspective, orthographic */
DELRAY_API DelrayGeometry delrayNewGeometry(DelrayDevice device,
                                            const char* subtype); /* triangle, sphere */
DELRAY_API DelrayLight delrayNewLight(DelrayDevice device,
                                      const char* subtype); /* directional, point, quad */
DELRAY_API DelrayMaterial delrayNewMaterial(DelrayDevice device,
                                            const char* subtype); /* matte, physicallyBased */
DELRAY_API DelrayRenderer delrayNewRenderer(DelrayDevice device,
                                            const char* subtype); /* default, raytrace */
DELRAY_API DelraySampler delrayNewSampler(DelrayDevice device, const char* subtype); /* image2D */
DELRAY_API DelraySurface delrayNewSurface(DelrayDevice device);
DELRAY_API DelrayGroup delrayNewGroup(DelrayDevice device);
DELRAY_API DelrayInstance delrayNewInstance(DelrayDevice device,
                                            const char* subtype); /* transform */
DELRAY_API DelrayWorld delrayNewWorld(DelrayDevice device);
DELRAY_API DelrayFrame delrayNewFrame(DelrayDevice device);

/* `memory` is the address of a value of `type`; of a string it is the string itself. Unknown names
 * and types that do not go with a name are refused. */
DELRAY_API DelrayStatus delraySetParameter(DelrayDevice device, DelrayObject object,
                                           const char* name, DelrayDataType type,
                                           const void* memory);
DELRAY_API DelrayStatus delrayUnsetParameter(DelrayDevice device, DelrayObject object,
                                             const char* name);
DELRAY_API DelrayStatus delrayUnsetAllParameters(DelrayDevice device, DelrayObject object);
DELRAY_API DelrayStatus delrayCommitParameters(DelrayDevice device, DelrayObject object);
DELRAY_API void delrayRetain(DelrayDevice device, DelrayObject object);
DELRAY_API void delrayRelease(DelrayDevice device, DelrayObject object); /* NULL: nothing happens */

/* Of a world: bounds (DELRAY_FLOAT32_BOX3). Of a frame: duration (DELRAY_FLOAT32), the seconds of
 * the last rendering, and numSamples (DELRAY_INT32). Returns 1 where there is such a property, else
 * 0. */
DELRAY_API int delrayGetProperty(DelrayDevice device, DelrayObject object, const char* name,
                                 DelrayDataType type, void* memory, uint64_t size);

/* Renders what was committed, and returns when it is done. With the frame's mpiCommunicator
 * collective, on every rank with a world of its own of the same whole, the same camera, renderer
 * and size; the picture is on rank 0. */
DELRAY_API DelrayStatus delrayRenderFrame(DelrayDevice device, DelrayFrame frame);
typedef enum DelrayWaitMask { DELRAY_NO_WAIT = 0, DELRAY_WAIT = 1 } DelrayWaitMask;
DELRAY_API int delrayFrameReady(DelrayDevice device, DelrayFrame frame, DelrayWaitMask mask);
/* The pixels of "channel.color" or "channel.depth", the lowest row first; valid until
 * delrayUnmapFrame. Colour is premultiplied by alpha, depth the distance from the camera's
 * position, infinite where there is nothing. NULL where the frame has no such channel, or was not
 * rendered, and on ranks other than 0. */
DELRAY_API const void* delrayMapFrame(DelrayDevice device, DelrayFrame frame, const char* channel,
                                      uint32_t* width, uint32_t* height, DelrayDataType* type);
DELRAY_API void delrayUnmapFrame(DelrayDevice device, DelrayFrame frame, const char* channel);

#ifdef __cplusplus
}
#endif

#endif
