// The C interface of IceT 2.2 as far as its public headers declare it: names, values and layouts,
// so that programs compiled with IceT's own headers run with libdelray_icet.so. What the functions
// do is told in IceT's manual (icetDrawFrame(3) and the others); what is different here, in
// docs/icet.md.
//
// C99 and C++. The two functions that have an MPI_Comm are in icet/mpi_interface.h.
#pragma once

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef uint32_t IceTEnum;
typedef uint32_t IceTBitField;
typedef double IceTDouble;
typedef float IceTFloat;
typedef int32_t IceTInt;
typedef uint32_t IceTUInt;
typedef int16_t IceTShort;
typedef uint8_t IceTUByte;
typedef uint8_t IceTBoolean;
typedef void IceTVoid;
typedef int32_t IceTSizeType;

// --- Communicators: a table of functions that a program may fill itself.

typedef struct IceTCommRequestStruct {
  IceTEnum magic_number;
  void* internals;
} * IceTCommRequest;

typedef struct IceTCommunicatorStruct {
  struct IceTCommunicatorStruct* (*Duplicate)(struct IceTCommunicatorStruct* self);
  void (*Destroy)(struct IceTCommunicatorStruct* self);
  struct IceTCommunicatorStruct* (*Subset)(struct IceTCommunicatorStruct* self, int count,
                                           const int32_t* ranks);
  void (*Barrier)(struct IceTCommunicatorStruct* self);
  void (*Send)(struct IceTCommunicatorStruct* self, const void* buffer, int count, IceTEnum type,
               int to, int tag);
  void (*Recv)(struct IceTCommunicatorStruct* self, void* buffer, int count, IceTEnum type,
               int from, int tag);
  void (*Sendrecv)(struct IceTCommunicatorStruct* self, const void* out, int out_count,
                   IceTEnum out_type, int to, int out_tag, void* in, int in_count, IceTEnum in_type,
                   int from, int in_tag);
  void (*Gather)(struct IceTCommunicatorStruct* self, const void* mine, int count, IceTEnum type,
                 void* all, int root);
  void (*Gatherv)(struct IceTCommunicatorStruct* self, const void* mine, int count, IceTEnum type,
                  void* all, const int* counts, const int* offsets, int root);
  void (*Allgather)(struct IceTCommunicatorStruct* self, const void* mine, int count, IceTEnum type,
                    void* all);
  void (*Alltoall)(struct IceTCommunicatorStruct* self, const void* mine, int count, IceTEnum type,
                   void* all);
  IceTCommRequest (*Isend)(struct IceTCommunicatorStruct* self, const void* buffer, int count,
                           IceTEnum type, int to, int tag);
  IceTCommRequest (*Irecv)(struct IceTCommunicatorStruct* self, void* buffer, int count,
                           IceTEnum type, int from, int tag);
  void (*Wait)(struct IceTCommunicatorStruct* self, IceTCommRequest* request);
  int (*Waitany)(struct IceTCommunicatorStruct* self, int count, IceTCommRequest* requests);
  int (*Comm_size)(struct IceTCommunicatorStruct* self);
  int (*Comm_rank)(struct IceTCommunicatorStruct* self);
  void* data;
} * IceTCommunicator;

// --- Values.

enum {
  ICET_NULL = 0,
  ICET_BOOLEAN = 0x8000,
  ICET_BYTE = 0x8001,
  ICET_SHORT = 0x8002,
  ICET_INT = 0x8003,
  ICET_FLOAT = 0x8004,
  ICET_DOUBLE = 0x8005,
  ICET_POINTER = 0x8008,
  ICET_VOID = 0x800F,

  ICET_FALSE = 0,
  ICET_TRUE = 1,

  ICET_IMAGE_COLOR_NONE = 0xC000,
  ICET_IMAGE_COLOR_RGBA_UBYTE = 0xC001,
  ICET_IMAGE_COLOR_RGBA_FLOAT = 0xC002,
  ICET_IMAGE_COLOR_RGB_FLOAT = 0xC003,
  ICET_IMAGE_DEPTH_NONE = 0xD000,
  ICET_IMAGE_DEPTH_FLOAT = 0xD001,

  ICET_STRATEGY_DIRECT = 0x6001,
  ICET_STRATEGY_SEQUENTIAL = 0x6002,
  ICET_STRATEGY_SPLIT = 0x6003,
  ICET_STRATEGY_REDUCE = 0x6004,
  ICET_STRATEGY_VTREE = 0x6005,

  ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC = 0x7001,
  ICET_SINGLE_IMAGE_STRATEGY_BSWAP = 0x7002,
  ICET_SINGLE_IMAGE_STRATEGY_TREE = 0x7003,
  ICET_SINGLE_IMAGE_STRATEGY_RADIXK = 0x7004,
  ICET_SINGLE_IMAGE_STRATEGY_RADIXKR = 0x7005,
  ICET_SINGLE_IMAGE_STRATEGY_BSWAP_FOLDING = 0x7006,

  ICET_COMPOSITE_MODE_Z_BUFFER = 0x0301,
  ICET_COMPOSITE_MODE_BLEND = 0x0302,

  ICET_DIAG_OFF = 0x0000,
  ICET_DIAG_ERRORS = 0x0001,
  ICET_DIAG_WARNINGS = 0x0003,
  ICET_DIAG_DEBUG = 0x0007,
  ICET_DIAG_ROOT_NODE = 0x0000,
  ICET_DIAG_ALL_NODES = 0x0100,
  ICET_DIAG_FULL = 0xFFFF
};

// Errors, as icetGetError gives them.
#define ICET_NO_ERROR 0U
#define ICET_SANITY_CHECK_FAIL 0xFFFFFFFFU
#define ICET_INVALID_ENUM 0xFFFFFFFEU
#define ICET_BAD_CAST 0xFFFFFFFDU
#define ICET_OUT_OF_MEMORY 0xFFFFFFFCU
#define ICET_INVALID_OPERATION 0xFFFFFFFBU
#define ICET_INVALID_VALUE 0xFFFFFFFAU

// State that icetGet reads.
enum {
  ICET_DIAGNOSTIC_LEVEL = 0x01,
  ICET_RANK = 0x02,
  ICET_NUM_PROCESSES = 0x03,
  ICET_BACKGROUND_COLOR = 0x05,
  ICET_BACKGROUND_COLOR_WORD = 0x06,
  ICET_PHYSICAL_RENDER_WIDTH = 0x07,
  ICET_PHYSICAL_RENDER_HEIGHT = 0x08,
  ICET_COLOR_FORMAT = 0x09,
  ICET_DEPTH_FORMAT = 0x0A,
  ICET_NUM_TILES = 0x10,
  ICET_TILE_VIEWPORTS = 0x11,
  ICET_GLOBAL_VIEWPORT = 0x12,
  ICET_TILE_MAX_WIDTH = 0x13,
  ICET_TILE_MAX_HEIGHT = 0x14,
  ICET_DISPLAY_NODES = 0x1A,
  ICET_TILE_DISPLAYED = 0x1B,
  ICET_GEOMETRY_BOUNDS = 0x22,
  ICET_NUM_BOUNDING_VERTS = 0x23,
  ICET_STRATEGY = 0x24,
  ICET_SINGLE_IMAGE_STRATEGY = 0x25,
  ICET_COMPOSITE_MODE = 0x28,
  ICET_COMPOSITE_ORDER = 0x29,
  ICET_PROCESS_ORDERS = 0x2A,
  ICET_STRATEGY_SUPPORTS_ORDERING = 0x2B,
  ICET_DATA_REPLICATION_GROUP = 0x2C,
  ICET_DATA_REPLICATION_GROUP_SIZE = 0x2D,
  ICET_FRAME_COUNT = 0x2E,
  ICET_MAGIC_K = 0x40,
  ICET_MAX_IMAGE_SPLIT = 0x41,
  ICET_DRAW_FUNCTION = 0x60,
  ICET_RENDER_LAYER_DESTRUCTOR = 0x61,

  ICET_IS_DRAWING_FRAME = 0x80,
  ICET_PROJECTION_MATRIX = 0x81,
  ICET_MODELVIEW_MATRIX = 0x82,
  ICET_CONTAINED_VIEWPORT = 0x83,
  ICET_NEAR_DEPTH = 0x84,
  ICET_FAR_DEPTH = 0x85,
  ICET_NUM_CONTAINED_TILES = 0x86,
  ICET_CONTAINED_TILES_LIST = 0x87,
  ICET_CONTAINED_TILES_MASK = 0x88,
  ICET_ALL_CONTAINED_TILES_MASKS = 0x89,
  ICET_TILE_CONTRIB_COUNTS = 0x8A,
  ICET_TOTAL_IMAGE_COUNT = 0x8B,
  ICET_NEED_BACKGROUND_CORRECTION = 0x8C,
  ICET_TRUE_BACKGROUND_COLOR = 0x8D,
  ICET_TRUE_BACKGROUND_COLOR_WORD = 0x8E,
  ICET_VALID_PIXELS_TILE = 0x98,
  ICET_VALID_PIXELS_OFFSET = 0x99,
  ICET_VALID_PIXELS_NUM = 0x9A,
  ICET_RENDERED_VIEWPORT = 0xA0,

  ICET_RENDER_TIME = 0xC1,
  ICET_BUFFER_READ_TIME = 0xC2,
  ICET_BUFFER_WRITE_TIME = 0xC3,
  ICET_COMPRESS_TIME = 0xC4,
  ICET_INTERLACE_TIME = 0xC5,
  ICET_COMPARE_TIME = 0xC6,
  ICET_BLEND_TIME = 0xC6,
  ICET_COMPOSITE_TIME = 0xC7,
  ICET_COLLECT_TIME = 0xC8,
  ICET_TOTAL_DRAW_TIME = 0xC9,
  ICET_BYTES_SENT = 0xCA,

  ICET_GL_INITIALIZED = 0x101,
  ICET_GL_READ_BUFFER = 0x110,
  ICET_GL_DRAW_FUNCTION = 0x120,

  // Features for icetEnable.
  ICET_STATE_ENABLE_START = 0x140,
  ICET_FLOATING_VIEWPORT = 0x141,
  ICET_ORDERED_COMPOSITE = 0x142,
  ICET_CORRECT_COLORED_BACKGROUND = 0x143,
  ICET_COMPOSITE_ONE_BUFFER = 0x144,
  ICET_INTERLACE_IMAGES = 0x145,
  ICET_COLLECT_IMAGES = 0x146,
  ICET_RENDER_EMPTY_IMAGES = 0x147,
  ICET_GL_DISPLAY = 0x170,
  ICET_GL_DISPLAY_COLORED_BACKGROUND = 0x171,
  ICET_GL_DISPLAY_INFLATE = 0x172,
  ICET_GL_DISPLAY_INFLATE_WITH_HARDWARE = 0x173,
  ICET_STATE_ENABLE_END = 0x180
};

// --- Functions.

#pragma GCC visibility push(default)

IceTDouble icetWallTime(void);
IceTEnum icetGetError(void);
void icetDiagnostics(IceTBitField mask);

typedef struct IceTContextStruct* IceTContext;
IceTContext icetCreateContext(IceTCommunicator communicator);
void icetDestroyContext(IceTContext context);
IceTContext icetGetContext(void);
void icetSetContext(IceTContext context);
void icetCopyState(IceTContext to, const IceTContext from);

void icetBoundingVertices(IceTInt size, IceTEnum type, IceTSizeType stride, IceTSizeType count,
                          const IceTVoid* pointer);
void icetBoundingBoxd(IceTDouble x_min, IceTDouble x_max, IceTDouble y_min, IceTDouble y_max,
                      IceTDouble z_min, IceTDouble z_max);
void icetBoundingBoxf(IceTFloat x_min, IceTFloat x_max, IceTFloat y_min, IceTFloat y_max,
                      IceTFloat z_min, IceTFloat z_max);

void icetResetTiles(void);
int icetAddTile(IceTInt x, IceTInt y, IceTSizeType width, IceTSizeType height, int display_rank);
void icetPhysicalRenderSize(IceTInt width, IceTInt height);

typedef struct {
  IceTVoid* opaque_internals;
} IceTImage;
void icetSetColorFormat(IceTEnum color_format);
void icetSetDepthFormat(IceTEnum depth_format);
IceTImage icetImageNull(void);
IceTBoolean icetImageIsNull(const IceTImage image);
IceTEnum icetImageGetColorFormat(const IceTImage image);
IceTEnum icetImageGetDepthFormat(const IceTImage image);
IceTSizeType icetImageGetWidth(const IceTImage image);
IceTSizeType icetImageGetHeight(const IceTImage image);
IceTSizeType icetImageGetNumPixels(const IceTImage image);
IceTUByte* icetImageGetColorub(IceTImage image);
IceTUInt* icetImageGetColorui(IceTImage image);
IceTFloat* icetImageGetColorf(IceTImage image);
IceTFloat* icetImageGetDepthf(IceTImage image);
const IceTUByte* icetImageGetColorcub(const IceTImage image);
const IceTUInt* icetImageGetColorcui(const IceTImage image);
const IceTFloat* icetImageGetColorcf(const IceTImage image);
const IceTFloat* icetImageGetDepthcf(const IceTImage image);
void icetImageCopyColorub(const IceTImage image, IceTUByte* buffer, IceTEnum color_format);
void icetImageCopyColorf(const IceTImage image, IceTFloat* buffer, IceTEnum color_format);
void icetImageCopyDepthf(const IceTImage image, IceTFloat* buffer, IceTEnum depth_format);

void icetStrategy(IceTEnum strategy);
const char* icetGetStrategyName(void);
void icetSingleImageStrategy(IceTEnum strategy);
const char* icetGetSingleImageStrategyName(void);
void icetCompositeMode(IceTEnum mode);
void icetCompositeOrder(const IceTInt* process_ranks);
void icetDataReplicationGroup(IceTInt size, const IceTInt* processes);
void icetDataReplicationGroupColor(IceTInt color);

typedef void (*IceTDrawCallbackType)(const IceTDouble* projection_matrix,
                                     const IceTDouble* modelview_matrix,
                                     const IceTFloat* background_color,
                                     const IceTInt* readback_viewport, IceTImage result);
void icetDrawCallback(IceTDrawCallbackType callback);
IceTImage icetDrawFrame(const IceTDouble* projection_matrix, const IceTDouble* modelview_matrix,
                        const IceTFloat* background_color);
IceTImage icetCompositeImage(const IceTVoid* color_buffer, const IceTVoid* depth_buffer,
                             const IceTInt* valid_pixels_viewport,
                             const IceTDouble* projection_matrix,
                             const IceTDouble* modelview_matrix, const IceTFloat* background_color);

void icetGetDoublev(IceTEnum pname, IceTDouble* params);
void icetGetFloatv(IceTEnum pname, IceTFloat* params);
void icetGetIntegerv(IceTEnum pname, IceTInt* params);
void icetGetBooleanv(IceTEnum pname, IceTBoolean* params);
void icetGetEnumv(IceTEnum pname, IceTEnum* params);
void icetGetBitFieldv(IceTEnum pname, IceTBitField* params);
void icetGetPointerv(IceTEnum pname, IceTVoid** params);
void icetEnable(IceTEnum pname);
void icetDisable(IceTEnum pname);
IceTBoolean icetIsEnabled(IceTEnum pname);

void icetGLInitialize(void);
IceTBoolean icetGLIsInitialized(void);
void icetGLSetReadBuffer(unsigned int mode);  // a GLenum
typedef void (*IceTGLDrawCallbackType)(void);
void icetGLDrawCallback(IceTGLDrawCallbackType callback);
IceTImage icetGLDrawFrame(void);

#pragma GCC visibility pop

#ifdef __cplusplus
}
#endif
