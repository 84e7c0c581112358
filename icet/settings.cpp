// Functions that set what a frame is drawn with: tiles, bounds, formats, order, features.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "comm/collectives.h"
#include "icet/context.h"
#include "icet/error.h"

namespace delray::icet {
namespace {

// Coordinate i of a vertex of the program's.
template <class T>
double coordinate(const std::byte* vertex, int i) {
  T value{};
  std::memcpy(&value, vertex + static_cast<std::size_t>(i) * sizeof(T), sizeof value);
  return static_cast<double>(value);
}

struct Type {
  IceTEnum value;
  std::size_t bytes;
  double (*read)(const std::byte* vertex, int i);
};
constexpr Type kTypes[] = {{ICET_SHORT, sizeof(IceTShort), &coordinate<IceTShort>},
                           {ICET_INT, sizeof(IceTInt), &coordinate<IceTInt>},
                           {ICET_FLOAT, sizeof(IceTFloat), &coordinate<IceTFloat>},
                           {ICET_DOUBLE, sizeof(IceTDouble), &coordinate<IceTDouble>}};

void set_bounds(Context& context, int size, IceTEnum type, std::size_t stride, int count,
                const void* pointer) {
  std::vector<glm::dvec3> bounds;
  if (count > 0) {
    const Type* const found = std::find_if(std::begin(kTypes), std::end(kTypes),
                                           [&](const Type& row) { return row.value == type; });
    if (found == std::end(kTypes)) throw Error(ICET_INVALID_VALUE, "vertices are of no such type");
    if (size < 1 || size > 4 || pointer == nullptr)
      throw Error(ICET_INVALID_VALUE, "vertices have one to four coordinates");
    if (stride == 0) stride = static_cast<std::size_t>(size) * found->bytes;
    const auto* vertex = static_cast<const std::byte*>(pointer);
    for (int i = 0; i < count; ++i, vertex += stride) {
      glm::dvec4 v(0, 0, 0, 1);
      for (int k = 0; k < size; ++k) v[k] = found->read(vertex, k);
      bounds.emplace_back(glm::dvec3(v) / (v.w == 0 ? 1 : v.w));
    }
  }
  context.settings.bounds = std::move(bounds);
}

void set_box(double x0, double x1, double y0, double y1, double z0, double z1) {
  guarded([&] {
    std::vector<glm::dvec3> corners;
    for (const double x : {x0, x1}) {
      for (const double y : {y0, y1}) {
        for (const double z : {z0, z1}) corners.emplace_back(x, y, z);
      }
    }
    current().settings.bounds = std::move(corners);
  });
}

// Coordinates of the display stay within this, so that sums and differences of two are an int.
constexpr std::int64_t kFarthest = (std::int64_t{1} << 30) - 1;

// The interface counts pixels of an image by an int.
void check_size(std::int64_t width, std::int64_t height) {
  if (width < 0 || height < 0 || width > kFarthest || height > kFarthest ||
      width * height > std::numeric_limits<IceTSizeType>::max())
    throw Error(ICET_INVALID_VALUE, "an image has from 0 to 2^31 - 1 pixels");
}

int add_tile(std::int64_t x, std::int64_t y, std::int64_t width, std::int64_t height, int display) {
  Context& context = current_not_drawing();
  Settings& settings = context.settings;
  if (width < 1 || height < 1) throw Error(ICET_INVALID_VALUE, "a tile has at least one pixel");
  if (std::min(x, y) < -kFarthest || std::max(x + width, y + height) > kFarthest)
    throw Error(ICET_INVALID_VALUE, "a tile lies too far away");
  const std::int64_t render_width = std::max<std::int64_t>(settings.render_width, width);
  const std::int64_t render_height = std::max<std::int64_t>(settings.render_height, height);
  check_size(render_width, render_height);
  if (display < 0 || display >= context.ranks->size())
    throw Error(ICET_INVALID_VALUE, "no process has the rank that is to show a tile");
  if (tile_of(settings, display) >= 0)
    throw Error(ICET_INVALID_VALUE, "a process shows one tile at most");
  const auto as_int = [](std::int64_t value) { return static_cast<int>(value); };
  settings.tiles.push_back(
      {{as_int(x), as_int(y), as_int(x + width), as_int(y + height)}, display});
  settings.render_width = as_int(render_width);
  settings.render_height = as_int(render_height);
  return static_cast<int>(settings.tiles.size()) - 1;
}

void set_feature(IceTEnum feature, bool on) {
  if (feature < ICET_STATE_ENABLE_START || feature >= ICET_STATE_ENABLE_END)
    throw Error(ICET_INVALID_VALUE, "there is no such feature");
  current().settings.enable(feature, on);
}

void set_group(Context& context, std::vector<int> group) {
  if (std::find(group.begin(), group.end(), context.ranks->rank()) == group.end())
    throw Error(ICET_INVALID_VALUE, "a replication group has the process itself");
  context.replication = std::move(group);
}

}  // namespace
}  // namespace delray::icet

using delray::icet::current;
using delray::icet::current_not_drawing;
using delray::icet::Error;
using delray::icet::guarded;

extern "C" {

void icetBoundingVertices(IceTInt size, IceTEnum type, IceTSizeType stride, IceTSizeType count,
                          const IceTVoid* pointer) {
  guarded([&] {
    delray::icet::set_bounds(current(), size, type, static_cast<std::size_t>(std::max(0, stride)),
                             count, pointer);
  });
}

void icetBoundingBoxd(IceTDouble x_min, IceTDouble x_max, IceTDouble y_min, IceTDouble y_max,
                      IceTDouble z_min, IceTDouble z_max) {
  delray::icet::set_box(x_min, x_max, y_min, y_max, z_min, z_max);
}

void icetBoundingBoxf(IceTFloat x_min, IceTFloat x_max, IceTFloat y_min, IceTFloat y_max,
                      IceTFloat z_min, IceTFloat z_max) {
  delray::icet::set_box(x_min, x_max, y_min, y_max, z_min, z_max);
}

void icetResetTiles(void) {
  guarded([] {
    auto& settings = current_not_drawing().settings;
    settings.tiles.clear();
    settings.render_width = settings.render_height = 0;
  });
}

int icetAddTile(IceTInt x, IceTInt y, IceTSizeType width, IceTSizeType height, int display_rank) {
  int tile = -1;
  guarded([&] { tile = delray::icet::add_tile(x, y, width, height, display_rank); });
  return tile;
}

void icetPhysicalRenderSize(IceTInt width, IceTInt height) {
  guarded([&] {
    auto& settings = current_not_drawing().settings;
    delray::icet::check_size(width, height);
    for (const auto& tile : settings.tiles) {
      if (width >= tile.place.width() && height >= tile.place.height()) continue;
      delray::icet::raise_warning(ICET_INVALID_VALUE, "the render size is smaller than a tile");
      break;
    }
    settings.render_width = width;
    settings.render_height = height;
  });
}

void icetSetColorFormat(IceTEnum color_format) {
  guarded([&] {
    if (color_format < ICET_IMAGE_COLOR_NONE || color_format > ICET_IMAGE_COLOR_RGB_FLOAT)
      throw Error(ICET_INVALID_ENUM, "there is no such format of colours");
    current_not_drawing().settings.colour_format = color_format;
  });
}

void icetSetDepthFormat(IceTEnum depth_format) {
  guarded([&] {
    if (depth_format != ICET_IMAGE_DEPTH_NONE && depth_format != ICET_IMAGE_DEPTH_FLOAT)
      throw Error(ICET_INVALID_ENUM, "there is no such format of depths");
    current_not_drawing().settings.depth_format = depth_format;
  });
}

void icetCompositeMode(IceTEnum mode) {
  guarded([&] {
    if (mode != ICET_COMPOSITE_MODE_Z_BUFFER && mode != ICET_COMPOSITE_MODE_BLEND)
      throw Error(ICET_INVALID_ENUM, "there is no such composite mode");
    current_not_drawing().settings.mode = mode;
  });
}

void icetCompositeOrder(const IceTInt* process_ranks) {
  guarded([&] {
    auto& context = current();
    if (process_ranks == nullptr) throw Error(ICET_INVALID_VALUE, "there is no order");
    std::vector<int> order(process_ranks, process_ranks + context.order.size());
    std::vector<int> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      if (sorted[i] != static_cast<int>(i))
        throw Error(ICET_INVALID_VALUE, "the order does not have each process once");
    }
    context.order = std::move(order);
  });
}

void icetDataReplicationGroup(IceTInt size, const IceTInt* processes) {
  guarded([&] {
    if (processes == nullptr) size = 0;
    delray::icet::set_group(current(), std::vector<int>(processes, processes + std::max(0, size)));
  });
}

void icetDataReplicationGroupColor(IceTInt color) {
  guarded([&] {
    auto& context = current();
    const auto colours = delray::comm::all_gather(
        *context.ranks, delray::comm::Buffer::of_value(std::int32_t{color}));
    context.ranks->finish_sends();
    std::vector<int> group;
    for (std::size_t i = 0; i < colours.size(); ++i) {
      if (colours[i].as<std::int32_t>()[0] == color) group.push_back(static_cast<int>(i));
    }
    delray::icet::set_group(context, std::move(group));
  });
}

void icetDrawCallback(IceTDrawCallbackType callback) {
  guarded([&] { current().settings.draw = callback; });
}

void icetEnable(IceTEnum pname) {
  guarded([&] { delray::icet::set_feature(pname, true); });
}

void icetDisable(IceTEnum pname) {
  guarded([&] { delray::icet::set_feature(pname, false); });
}

}  // extern "C"
