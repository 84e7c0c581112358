// Behind IceTContext: everything that the interface sets, and what the last frame was.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "comm/communicator.h"
#include "geometry/rect.h"
#include "icet/image.h"
#include "icet/interface.h"
#include "parallel/arena.h"

namespace delray::icet {

// A rectangle of the display, whose pixel rows go upwards here, and who shows it.
struct Tile {
  geometry::Rect place;
  int display = 0;
};

// Settings that icetCopyState copies.
struct Settings {
  IceTBitField diagnostics = ICET_DIAG_ALL_NODES | ICET_DIAG_WARNINGS;
  int render_width = 0, render_height = 0;
  IceTEnum colour_format = ICET_IMAGE_COLOR_RGBA_UBYTE, depth_format = ICET_IMAGE_DEPTH_FLOAT;
  std::vector<Tile> tiles;
  std::vector<glm::dvec3> bounds;    // their convex hull is all that is drawn; empty: not known
  IceTEnum strategy = ~IceTEnum{0};  // none yet
  IceTEnum single_image = ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC;
  IceTEnum mode = ICET_COMPOSITE_MODE_Z_BUFFER;
  IceTDrawCallbackType draw = nullptr;
  std::uint64_t enabled = 0;  // bit i: feature ICET_STATE_ENABLE_START + i
  bool gl_initialised = false;
  unsigned gl_read_buffer = 0x0405;  // GL_BACK
  IceTGLDrawCallbackType gl_draw = nullptr;

  Settings();
  bool is_enabled(IceTEnum feature) const {
    return (enabled >> (feature - ICET_STATE_ENABLE_START) & 1) != 0;
  }
  void enable(IceTEnum feature, bool on);
  bool blends() const { return mode == ICET_COMPOSITE_MODE_BLEND; }
  bool has_colour() const { return colour_format != ICET_IMAGE_COLOR_NONE; }
  bool has_depth() const { return depth_format != ICET_IMAGE_DEPTH_NONE; }
};

// The smallest rectangle with all tiles; empty where there are none.
geometry::Rect display_of(const Settings& settings);
// The tile that a rank shows; -1 where it shows none.
int tile_of(const Settings& settings, int rank);

// Times of the last frame in seconds, and bytes of it.
struct Timings {
  double render = 0, buffer_read = 0, buffer_write = 0, compress = 0, compare = 0, collect = 0,
         total = 0;
  std::uint64_t bytes_sent = 0;
  double composite() const { return total - render - buffer_read - buffer_write; }
};

// State of the frame that is being drawn, or of the last one.
struct Frame {
  bool has_begun = false, is_drawing = false;
  int count = 0;
  glm::dmat4 projection{1}, modelview{1};
  glm::vec4 background{}, true_background{};
  bool corrects_background = false;
  geometry::Rect contained{};  // of the display: where this rank may have drawn something
  double near_depth = -1, far_depth = 1;
  std::vector<int> tiles;  // those that this rank draws
  geometry::Rect rendered{};
  int valid_tile = -1, valid_offset = 0, valid_pixels = 0;
  Timings timings{};
};

}  // namespace delray::icet

// What the handle points to.
struct IceTContextStruct {
  explicit IceTContextStruct(std::unique_ptr<delray::comm::Communicator> all);

  std::unique_ptr<delray::comm::Communicator> ranks;
  std::vector<int> order;        // ranks from the front to the back
  std::vector<int> replication;  // ranks that draw the same as this one, itself among them
  delray::icet::Settings settings;
  delray::icet::Frame frame;
  delray::icet::ImagePool pool;
  std::vector<delray::icet::Image> drawings;  // what callbacks have filled
  delray::icet::Image result;                 // what the last frame returned
  delray::parallel::Arena arena{1};           // ranks of a machine share its cores
};

namespace delray::icet {

using Context = IceTContextStruct;

// The one that functions of the interface are about, as in IceT one for the whole process: threads
// take turns. Throws Error (operation) where there is none.
Context& current();
// The same for what may not be called while a frame is drawn, as callbacks could: it would change
// what is being drawn. Throws Error (operation) then, too.
Context& current_not_drawing();
// Null where there is none.
Context* current_or_none() noexcept;

}  // namespace delray::icet
