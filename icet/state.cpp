// icetGet and icetIsEnabled: a table of what can be read, one row for each name of the interface.
//
// All numbers of the interface are exact as doubles, so that one function for each row does for all
// types that a program may ask for.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <type_traits>
#include <vector>

#include "icet/context.h"
#include "icet/error.h"
#include "icet/pixels.h"
#include "icet/strategies.h"

namespace delray::icet {
namespace {

using Values = std::vector<double>;

// A row gives its values; false where they were never set.
struct Row {
  IceTEnum name;
  bool (*read)(const Context& context, Values& values);
};

template <class... T>
bool put(Values& values, T... value) {
  (values.push_back(static_cast<double>(value)), ...);
  return true;
}

template <class Range>
bool put_all(Values& values, const Range& range) {
  for (const auto& value : range) values.push_back(static_cast<double>(value));
  return true;
}

bool put_rect(Values& values, const geometry::Rect& rect) {
  return put(values, rect.x0, rect.y0, rect.x1 - rect.x0, rect.y1 - rect.y0);
}

bool put_matrix(Values& values, const glm::dmat4& matrix) {
  for (int i = 0; i < 16; ++i) values.push_back(matrix[i / 4][i % 4]);
  return true;
}

bool put_colour(Values& values, const glm::vec4& colour) {
  return put(values, colour.r, colour.g, colour.b, colour.a);
}

// As a 32-bit integer with the bytes of a pixel.
bool put_word(Values& values, const glm::vec4& colour) {
  return put(values, static_cast<std::int32_t>(word_of(as_bytes(colour))));
}

int largest(const Context& context, int (geometry::Rect::*side)() const) {
  int most = 0;
  for (const Tile& tile : context.settings.tiles) most = std::max(most, (tile.place.*side)());
  return most;
}

// Which tiles this rank draws, a bit for each.
std::vector<int> mask_of(const Context& context) {
  std::vector<int> mask(context.settings.tiles.size());
  for (const int tile : context.frame.tiles) mask[static_cast<std::size_t>(tile)] = 1;
  return mask;
}

// Of what a frame sets.
template <class F>
bool in_frame(const Context& context, F&& f) {
  return context.frame.has_begun && f(context.frame);
}

#define DELRAY_ROW(name, ...)                                     \
  Row {                                                           \
    name, [](const Context& c, Values& v) { return __VA_ARGS__; } \
  }
#define DELRAY_FRAME_ROW(name, ...)                                                         \
  Row {                                                                                     \
    name, [](const Context& c, Values& v) {                                                 \
      return in_frame(c, [&]([[maybe_unused]] const Frame& frame) { return __VA_ARGS__; }); \
    }                                                                                       \
  }

const Row kRows[] = {
    DELRAY_ROW(ICET_DIAGNOSTIC_LEVEL, put(v, c.settings.diagnostics)),
    DELRAY_ROW(ICET_RANK, put(v, c.ranks->rank())),
    DELRAY_ROW(ICET_NUM_PROCESSES, put(v, c.ranks->size())),
    DELRAY_ROW(ICET_BACKGROUND_COLOR, put_colour(v, c.frame.background)),
    DELRAY_ROW(ICET_BACKGROUND_COLOR_WORD, put_word(v, c.frame.background)),
    DELRAY_ROW(ICET_PHYSICAL_RENDER_WIDTH, put(v, c.settings.render_width)),
    DELRAY_ROW(ICET_PHYSICAL_RENDER_HEIGHT, put(v, c.settings.render_height)),
    DELRAY_ROW(ICET_COLOR_FORMAT, put(v, c.settings.colour_format)),
    DELRAY_ROW(ICET_DEPTH_FORMAT, put(v, c.settings.depth_format)),
    DELRAY_ROW(ICET_NUM_TILES, put(v, c.settings.tiles.size())),
    Row{ICET_TILE_VIEWPORTS,
        [](const Context& c, Values& v) {
          for (const Tile& tile : c.settings.tiles) put_rect(v, tile.place);
          return true;
        }},
    DELRAY_ROW(ICET_GLOBAL_VIEWPORT, put_rect(v, display_of(c.settings))),
    DELRAY_ROW(ICET_TILE_MAX_WIDTH, put(v, largest(c, &geometry::Rect::width))),
    DELRAY_ROW(ICET_TILE_MAX_HEIGHT, put(v, largest(c, &geometry::Rect::height))),
    Row{ICET_DISPLAY_NODES,
        [](const Context& c, Values& v) {
          for (const Tile& tile : c.settings.tiles) put(v, tile.display);
          return true;
        }},
    DELRAY_ROW(ICET_TILE_DISPLAYED, put(v, tile_of(c.settings, c.ranks->rank()))),
    Row{ICET_GEOMETRY_BOUNDS,
        [](const Context& c, Values& v) {
          for (const glm::dvec3& vertex : c.settings.bounds) put(v, vertex.x, vertex.y, vertex.z);
          return true;
        }},
    DELRAY_ROW(ICET_NUM_BOUNDING_VERTS, put(v, c.settings.bounds.size())),
    DELRAY_ROW(ICET_STRATEGY, put(v, static_cast<std::int32_t>(c.settings.strategy))),
    DELRAY_ROW(ICET_SINGLE_IMAGE_STRATEGY, put(v, c.settings.single_image)),
    DELRAY_ROW(ICET_COMPOSITE_MODE, put(v, c.settings.mode)),
    DELRAY_ROW(ICET_COMPOSITE_ORDER, put_all(v, c.order)),
    Row{ICET_PROCESS_ORDERS,
        [](const Context& c, Values& v) {
          v.resize(c.order.size());
          for (std::size_t i = 0; i < c.order.size(); ++i) {
            v[static_cast<std::size_t>(c.order[i])] = static_cast<double>(i);
          }
          return true;
        }},
    Row{ICET_STRATEGY_SUPPORTS_ORDERING,
        [](const Context& c, Values& v) {
          const Strategy* const row = find_strategy(strategies(), c.settings.strategy);
          return row != nullptr && put(v, row->ordered);
        }},
    DELRAY_ROW(ICET_DATA_REPLICATION_GROUP, put_all(v, c.replication)),
    DELRAY_ROW(ICET_DATA_REPLICATION_GROUP_SIZE, put(v, c.replication.size())),
    DELRAY_ROW(ICET_FRAME_COUNT, put(v, c.frame.count)),
    // What IceT has where nobody asks for something else; schemes choose for themselves here.
    Row{ICET_MAGIC_K, [](const Context&, Values& v) { return put(v, 8); }},
    Row{ICET_MAX_IMAGE_SPLIT, [](const Context&, Values& v) { return put(v, 500000); }},

    DELRAY_ROW(ICET_IS_DRAWING_FRAME, put(v, c.frame.is_drawing)),
    DELRAY_FRAME_ROW(ICET_PROJECTION_MATRIX, put_matrix(v, frame.projection)),
    DELRAY_FRAME_ROW(ICET_MODELVIEW_MATRIX, put_matrix(v, frame.modelview)),
    DELRAY_FRAME_ROW(ICET_CONTAINED_VIEWPORT, put_rect(v, frame.contained)),
    DELRAY_FRAME_ROW(ICET_NEAR_DEPTH, put(v, frame.near_depth)),
    DELRAY_FRAME_ROW(ICET_FAR_DEPTH, put(v, frame.far_depth)),
    DELRAY_FRAME_ROW(ICET_NUM_CONTAINED_TILES, put(v, frame.tiles.size())),
    DELRAY_FRAME_ROW(ICET_CONTAINED_TILES_LIST, put_all(v, frame.tiles)),
    DELRAY_FRAME_ROW(ICET_CONTAINED_TILES_MASK, put_all(v, mask_of(c))),
    DELRAY_FRAME_ROW(ICET_NEED_BACKGROUND_CORRECTION, put(v, frame.corrects_background)),
    DELRAY_FRAME_ROW(ICET_TRUE_BACKGROUND_COLOR, put_colour(v, frame.true_background)),
    DELRAY_FRAME_ROW(ICET_TRUE_BACKGROUND_COLOR_WORD, put_word(v, frame.true_background)),
    DELRAY_FRAME_ROW(ICET_RENDERED_VIEWPORT, put_rect(v, frame.rendered)),
    DELRAY_ROW(ICET_VALID_PIXELS_TILE, put(v, c.frame.valid_tile)),
    DELRAY_ROW(ICET_VALID_PIXELS_OFFSET, put(v, c.frame.valid_offset)),
    DELRAY_ROW(ICET_VALID_PIXELS_NUM, put(v, c.frame.valid_pixels)),

    DELRAY_ROW(ICET_RENDER_TIME, put(v, c.frame.timings.render)),
    DELRAY_ROW(ICET_BUFFER_READ_TIME, put(v, c.frame.timings.buffer_read)),
    DELRAY_ROW(ICET_BUFFER_WRITE_TIME, put(v, c.frame.timings.buffer_write)),
    DELRAY_ROW(ICET_COMPRESS_TIME, put(v, c.frame.timings.compress)),
    Row{ICET_INTERLACE_TIME, [](const Context&, Values& v) { return put(v, 0); }},  // with the rest
    DELRAY_ROW(ICET_COMPARE_TIME, put(v, c.frame.timings.compare)),
    DELRAY_ROW(ICET_COMPOSITE_TIME, put(v, c.frame.timings.composite())),
    DELRAY_ROW(ICET_COLLECT_TIME, put(v, c.frame.timings.collect)),
    DELRAY_ROW(ICET_TOTAL_DRAW_TIME, put(v, c.frame.timings.total)),
    DELRAY_ROW(ICET_BYTES_SENT, put(v, c.frame.timings.bytes_sent)),

    DELRAY_ROW(ICET_GL_INITIALIZED, put(v, c.settings.gl_initialised)),
    DELRAY_ROW(ICET_GL_READ_BUFFER, put(v, c.settings.gl_read_buffer)),
};
#undef DELRAY_ROW
#undef DELRAY_FRAME_ROW

// Those that are addresses.
struct PointerRow {
  IceTEnum name;
  void* (*read)(const Context& context);
};
const PointerRow kPointerRows[] = {
    {ICET_DRAW_FUNCTION, [](const Context& c) { return reinterpret_cast<void*>(c.settings.draw); }},
    {ICET_RENDER_LAYER_DESTRUCTOR, [](const Context&) -> void* { return nullptr; }},
    {ICET_GL_DRAW_FUNCTION,
     [](const Context& c) { return reinterpret_cast<void*>(c.settings.gl_draw); }},
};

template <class Rows>
auto find_row(const Rows& rows, IceTEnum name) {
  const auto* const end = std::end(rows);
  const auto* const found =
      std::find_if(std::begin(rows), end, [&](const auto& row) { return row.name == name; });
  return found == end ? nullptr : found;
}

bool is_feature(IceTEnum name) {
  return name >= ICET_STATE_ENABLE_START && name < ICET_STATE_ENABLE_END;
}

[[noreturn]] void refuse(IceTEnum name) {
  char text[64];
  std::snprintf(text, sizeof text, "there is no state parameter 0x%X, or no value of it yet", name);
  throw Error(ICET_INVALID_ENUM, text);
}

Values values_of(IceTEnum name) {
  const Context& context = current();
  Values values;
  if (is_feature(name)) {
    put(values, context.settings.is_enabled(name));
    return values;
  }
  if (find_row(kPointerRows, name) != nullptr)
    throw Error(ICET_BAD_CAST, "the state parameter is a pointer");
  const Row* const row = find_row(kRows, name);
  if (row == nullptr || !row->read(context, values)) refuse(name);
  return values;
}

// To integers towards zero, and the nearest that there is.
template <class T>
T as(double value) {
  if constexpr (std::is_integral_v<T>) {
    const double most = std::numeric_limits<std::uint32_t>::max();
    const double least = std::numeric_limits<std::int32_t>::min();
    return static_cast<T>(static_cast<std::int64_t>(
        std::isnan(value) ? 0 : std::clamp(std::trunc(value), least, most)));
  } else {
    return static_cast<T>(value);
  }
}

template <class T>
void get(IceTEnum name, T* params) {
  guarded([&] {
    const Values values = values_of(name);
    std::transform(values.begin(), values.end(), params, &as<T>);
  });
}

}  // namespace
}  // namespace delray::icet

extern "C" {

void icetGetDoublev(IceTEnum pname, IceTDouble* params) { delray::icet::get(pname, params); }
void icetGetFloatv(IceTEnum pname, IceTFloat* params) { delray::icet::get(pname, params); }
void icetGetIntegerv(IceTEnum pname, IceTInt* params) { delray::icet::get(pname, params); }
void icetGetBooleanv(IceTEnum pname, IceTBoolean* params) { delray::icet::get(pname, params); }
void icetGetEnumv(IceTEnum pname, IceTEnum* params) { delray::icet::get(pname, params); }
void icetGetBitFieldv(IceTEnum pname, IceTBitField* params) { delray::icet::get(pname, params); }

void icetGetPointerv(IceTEnum pname, IceTVoid** params) {
  using namespace delray::icet;
  guarded([&] {
    const Context& context = current();
    const PointerRow* const row = find_row(kPointerRows, pname);
    if (row == nullptr) {
      if (is_feature(pname) || find_row(kRows, pname) != nullptr)
        throw Error(ICET_BAD_CAST, "the state parameter is no pointer");
      refuse(pname);
    }
    *params = row->read(context);
  });
}

IceTBoolean icetIsEnabled(IceTEnum pname) {
  using namespace delray::icet;
  return guarded([&]() -> IceTBoolean {
    if (!is_feature(pname)) throw Error(ICET_INVALID_VALUE, "there is no such feature");
    return current().settings.is_enabled(pname) ? ICET_TRUE : ICET_FALSE;
  });
}

}  // extern "C"
