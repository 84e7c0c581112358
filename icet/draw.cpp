// A frame: the tiles that this rank may have something in are drawn, or taken from an image that is
// there, and composited with those of the others.
//
// Pixels stay where they were drawn or given; several tiles may be drawn at once (floating
// viewport).
#include "icet/draw.h"

#include <algorithm>
#include <cstdint>
#include <glm/gtc/type_ptr.hpp>
#include <type_traits>
#include <utility>
#include <vector>

#include "icet/compose_frame.h"
#include "icet/error.h"
#include "icet/pixels.h"
#include "icet/strategies.h"
#include "icet/viewport.h"

namespace delray::icet {
namespace {

using geometry::Rect;

// Marks the frame as being drawn, and measures how long that takes.
class Drawing {
 public:
  explicit Drawing(Frame& frame) : frame_(frame), begin_(icetWallTime()) {
    frame_.is_drawing = true;
  }
  ~Drawing() {
    frame_.is_drawing = false;
    frame_.timings.total = icetWallTime() - begin_;
  }
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

 private:
  Frame& frame_;
  double begin_;
};

void check_settings(const Settings& settings) {
  if (settings.tiles.empty())
    throw Error(ICET_INVALID_OPERATION, "there are no tiles to draw; see icetAddTile");
  if (find_strategy(strategies(), settings.strategy) == nullptr)
    throw Error(ICET_INVALID_OPERATION, "no strategy was chosen; see icetStrategy");
  if (!settings.blends()) {
    if (!settings.has_depth())
      throw Error(ICET_INVALID_OPERATION, "images without depth cannot be composited by depth");
    return;
  }
  if (!settings.has_colour() || settings.colour_format == ICET_IMAGE_COLOR_RGB_FLOAT)
    throw Error(ICET_INVALID_VALUE, "colours without alpha cannot be blended");
  if (settings.has_depth())
    raise_warning(ICET_INVALID_VALUE, "depths mean nothing where colours are blended");
}

void begin_frame(Context& context, const View& view) {
  Frame& frame = context.frame;
  const int count = frame.count + 1;
  frame = {};
  frame.count = count;
  frame.has_begun = true;
  if (view.projection != nullptr) frame.projection = glm::make_mat4(view.projection);
  if (view.modelview != nullptr) frame.modelview = glm::make_mat4(view.modelview);
  if (view.background != nullptr) frame.true_background = glm::make_vec4(view.background);
  const bool blends = context.settings.blends();
  frame.background = blends ? glm::vec4(0) : frame.true_background;
  frame.corrects_background = blends &&
                              context.settings.is_enabled(ICET_CORRECT_COLORED_BACKGROUND) &&
                              word_of(as_bytes(frame.true_background)) != 0;
  context.pool.give_back(std::move(context.result.bytes));
  context.pool.give_back(std::move(context.result.floats));
  context.result.bytes = {};
  context.result.floats = {};
}

// Where this rank may have drawn something, and in which tiles.
void find_contained(Context& context, const View& view, const Rect* valid) {
  Frame& frame = context.frame;
  const Rect display = display_of(context.settings);
  const bool is_known = view.projection != nullptr && view.modelview != nullptr;
  const Projected projected =
      project(is_known ? context.settings.bounds : std::vector<glm::dvec3>(),
              frame.projection * frame.modelview, display);
  frame.contained = projected.rect;
  if (valid != nullptr) frame.contained = geometry::intersection(frame.contained, *valid);
  frame.near_depth = projected.near_depth;
  frame.far_depth = projected.far_depth;
  frame.tiles = tiles_to_draw(context, frame.contained);
  if (context.replication.size() < 2 || frame.tiles.empty()) return;
  Settings own = context.settings;
  own.tiles.clear();
  for (const int tile : frame.tiles) {
    own.tiles.push_back(context.settings.tiles[static_cast<std::size_t>(tile)]);
  }
  frame.contained = geometry::intersection(frame.contained, display_of(own));
}

// The part of `contained` that a rectangle of the display has, in its own coordinates.
Rect part_in(const Rect& place, const Rect& contained) {
  const Rect part = geometry::intersection(place, contained);
  if (part.empty()) return {};
  return {part.x0 - place.x0, part.y0 - place.y0, part.x1 - place.x0, part.y1 - place.y0};
}

// Draws the tiles of a rank by a function.
template <class Colour>
class TileDrawer {
 public:
  TileDrawer(Context& context, const DrawFunction& draw)
      : context_(context), draw_(draw), tiles_(context.settings.tiles.size()) {
    // One for each tile, and one for several: they stay where they are.
    context.drawings.resize(tiles_.size() + 1);
  }

  TilePixels<Colour> draw_all() {
    Frame& frame = context_.frame;
    const Settings& settings = context_.settings;
    const Rect& all = frame.contained;
    const bool floats = settings.is_enabled(ICET_FLOATING_VIEWPORT) && frame.tiles.size() > 1 &&
                        all.width() <= settings.render_width &&
                        all.height() <= settings.render_height;
    if (floats) {
      frame.rendered = placed_at(all);
      Image& image = draw(tiles_.size(), all, {0, 0, all.width(), all.height()});
      for (const int tile : frame.tiles) borrow(image, all, tile);
    }
    const auto& own = frame.tiles;
    for (int tile = 0; tile < static_cast<int>(tiles_.size()); ++tile) {
      const bool is_own = std::find(own.begin(), own.end(), tile) != own.end();
      if (is_own ? floats : !settings.is_enabled(ICET_RENDER_EMPTY_IMAGES)) continue;
      frame.rendered = place_of(tile);
      Image& image = draw(static_cast<std::size_t>(tile), frame.rendered,
                          part_in(frame.rendered, frame.contained));
      if (is_own) borrow(image, frame.rendered, tile);
    }
    return std::move(tiles_);
  }

 private:
  const Rect& place_of(int tile) const {
    return context_.settings.tiles[static_cast<std::size_t>(tile)].place;
  }
  // What is drawn where a rectangle begins.
  Rect placed_at(const Rect& at) const {
    return {at.x0, at.y0, at.x0 + context_.settings.render_width,
            at.y0 + context_.settings.render_height};
  }

  // The pixels of a tile in an image that begins where `at` does.
  void borrow(Image& image, const Rect& at, int tile) {
    const Settings& settings = context_.settings;
    const Rect& place = place_of(tile);
    auto& planes = image.planes(Colour{});
    composite::BorrowedPixels<Colour> pixels;
    pixels.colour = settings.has_colour() ? planes.colour.data() : nullptr;
    pixels.depth = settings.has_depth() ? planes.depth.data() : nullptr;
    pixels.stride = image.width;
    pixels.origin = (place.y0 - at.y0) * pixels.stride + (place.x0 - at.x0);
    // An image that is smaller than the tile has no more.
    pixels.window = part_in(place, geometry::intersection(context_.frame.contained, placed_at(at)));
    tiles_[static_cast<std::size_t>(tile)] = pixels;
  }

  Image& draw(std::size_t drawing, const Rect& at, const Rect& part) {
    const Settings& settings = context_.settings;
    Frame& frame = context_.frame;
    Image& image = context_.drawings[drawing];
    image.width = settings.render_width;
    image.height = settings.render_height;
    image.colour_format = settings.colour_format;
    image.depth_format = settings.depth_format;
    auto& planes = image.planes(Colour{});
    if (planes.width != image.width || planes.height != image.height)
      planes = image::BasicImage<Colour>(image.width, image.height);
    if (image.is_rgb() && image.rgb.size() != 3 * image.pixels())
      image.rgb = image::Plane<float>(3 * image.pixels());
    const glm::dmat4 projection =
        projection_of(placed_at(at), display_of(settings), frame.projection);
    const IceTInt readback[4] = {part.x0, part.y0, part.width(), part.height()};
    const double begin = icetWallTime();
    draw_(glm::value_ptr(projection), glm::value_ptr(frame.modelview),
          glm::value_ptr(frame.background), readback, handle_of(image));
    frame.timings.render += icetWallTime() - begin;
    if constexpr (std::is_same_v<Colour, image::RgbaF>) {
      if (image.is_rgb()) add_alpha(image.rgb.data(), image.pixels(), planes.colour.data());
    }
    return image;
  }

  Context& context_;
  const DrawFunction& draw_;
  TilePixels<Colour> tiles_;
};

// The tiles of an image of all of the display that is there already. `with_alpha` holds what has to
// be converted.
template <class Colour>
TilePixels<Colour> tiles_of(Context& context, const void* colour, const float* depth,
                            image::Plane<image::RgbaF>& with_alpha) {
  const Settings& settings = context.settings;
  const Rect display = display_of(settings);
  TilePixels<Colour> tiles(settings.tiles.size());
  if (settings.colour_format == ICET_IMAGE_COLOR_RGB_FLOAT && !context.frame.tiles.empty()) {
    with_alpha = image::Plane<image::RgbaF>(static_cast<std::size_t>(display.area()));
    add_alpha(static_cast<const float*>(colour), with_alpha.size(), with_alpha.data());
    colour = with_alpha.data();
  }
  for (const int tile : context.frame.tiles) {
    const Rect& place = settings.tiles[static_cast<std::size_t>(tile)].place;
    composite::BorrowedPixels<Colour> pixels{static_cast<const Colour*>(colour), depth};
    pixels.stride = display.width();
    pixels.origin = (place.y0 - display.y0) * pixels.stride + (place.x0 - display.x0);
    pixels.window = part_in(place, context.frame.contained);
    tiles[static_cast<std::size_t>(tile)] = pixels;
  }
  return tiles;
}

// Composites what make() gives; where it throws, the other ranks hear of it, too.
template <class Colour, class F>
void compose(Context& context, F&& make) {
  TilePixels<Colour> tiles;
  try {
    check_settings(context.settings);
    tiles = make(Colour{});
  } catch (...) {
    fail_frame(context);
    throw;
  }
  context.arena.execute([&] { compose_frame(context, tiles); });
}

template <class F>
IceTImage compose(Context& context, F&& make) {
  const IceTEnum format = context.settings.colour_format;
  if (format == ICET_IMAGE_COLOR_RGBA_FLOAT || format == ICET_IMAGE_COLOR_RGB_FLOAT) {
    compose<image::RgbaF>(context, make);
  } else {
    compose<image::Rgba8>(context, make);
  }
  return context.frame.valid_pixels > 0 ? handle_of(context.result) : icetImageNull();
}

// An image of all of the display, with the rectangle of it that is valid.
struct DrawnImage {
  const void* colour = nullptr;
  const float* depth = nullptr;
  const IceTInt* valid = nullptr;  // x, y, width, height
};

// The part of the display that a program tells by any numbers: x, y, width, height.
Rect part_of(const Rect& display, const IceTInt* given) {
  const auto cut = [](int begin, int end, std::int64_t at) {
    return static_cast<int>(std::clamp<std::int64_t>(begin + at, begin, end));
  };
  const std::int64_t x = given[0], y = given[1];
  return {cut(display.x0, display.x1, x), cut(display.y0, display.y1, y),
          cut(display.x0, display.x1, x + given[2]), cut(display.y0, display.y1, y + given[3])};
}

IceTImage composite_image(Context& context, const View& view, const DrawnImage& image) {
  begin_frame(context, view);
  const Drawing drawing(context.frame);
  const Settings& settings = context.settings;
  image::Plane<image::RgbaF> with_alpha;
  return compose(context, [&](auto colour) {
    if ((settings.has_colour() && image.colour == nullptr) ||
        (settings.has_depth() && !settings.blends() && image.depth == nullptr))
      throw Error(ICET_INVALID_VALUE, "there is no colour or depth to composite");
    const Rect display = display_of(settings);
    const Rect valid = image.valid != nullptr ? part_of(display, image.valid) : display;
    find_contained(context, view, &valid);
    return tiles_of<decltype(colour)>(context, settings.has_colour() ? image.colour : nullptr,
                                      image.depth, with_alpha);
  });
}

}  // namespace

IceTImage draw_frame(Context& context, const View& view, const DrawFunction& draw) {
  begin_frame(context, view);
  const Drawing drawing(context.frame);
  return compose(context, [&](auto colour) {
    if (!draw) throw Error(ICET_INVALID_OPERATION, "there is no function that draws");
    find_contained(context, view, nullptr);
    return TileDrawer<decltype(colour)>(context, draw).draw_all();
  });
}

}  // namespace delray::icet

extern "C" {

IceTImage icetDrawFrame(const IceTDouble* projection_matrix, const IceTDouble* modelview_matrix,
                        const IceTFloat* background_color) {
  using namespace delray::icet;
  return guarded([&] {
    Context& context = current_not_drawing();
    return draw_frame(context, {projection_matrix, modelview_matrix, background_color},
                      context.settings.draw);
  });
}

IceTImage icetCompositeImage(const IceTVoid* color_buffer, const IceTVoid* depth_buffer,
                             const IceTInt* valid_pixels_viewport,
                             const IceTDouble* projection_matrix,
                             const IceTDouble* modelview_matrix,
                             const IceTFloat* background_color) {
  using namespace delray::icet;
  return guarded([&] {
    return composite_image(
        current_not_drawing(), {projection_matrix, modelview_matrix, background_color},
        {color_buffer, static_cast<const float*>(depth_buffer), valid_pixels_viewport});
  });
}

}  // extern "C"
