// One page's view of the scene: its camera, size and options, and which picture of it is due next.
// Knows neither sockets nor renderers; time is what the caller says.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>

#include "apps/view/look.h"
#include "apps/view/message.h"
#include "scenes/camera.h"

namespace delray::apps::view {

// The pictures of a camera, each better than the one before.
enum class Stage : std::uint8_t {
  moving,  // by the rasterizer, as large as can be made 30 times a second
  sharp,   // by the rasterizer, of full size
  coarse,  // by rays, a quarter as wide and high
  still    // as the options want it; with rays it grows
};
const char* name_of(Stage stage);

// A picture that is to be made.
struct Order {
  Stage stage = Stage::still;
  std::uint64_t camera_number = 0;  // of the page's CameraMessage; 0: none yet
  std::uint64_t version = 0;  // what it is of: an order of another version is not due any more
  scenes::Camera camera;
  int width = 0, height = 0;
  std::shared_ptr<const Look> look;
  bool figures = false;

  const RenderRequest& request() const {
    return stage == Stage::moving || stage == Stage::sharp ? look->moving : look->still;
  }
  const Options& options() const {
    return stage == Stage::moving || stage == Stage::sharp ? look->moving_options
                                                           : look->still_options;
  }
};

// What pictures cost: a part that every one takes, for its triangles, and one that grows with its
// area, by least squares over the last ones.
class FrameCost {
 public:
  // A picture of this area, as a part of the whole one's, took so many seconds.
  void note(double area, double seconds);
  // The area that takes so many seconds, 16 where it would be more; where most of a picture's time
  // is not for its area, one that adds no more than half to that: a smaller one would hardly be
  // quicker.
  double area_in(double seconds) const;

 private:
  double weight_ = 0, area_ = 0, seconds_ = 0, area2_ = 0, product_ = 0;  // sums
  double fixed_ = 0;                                                      // seconds
};

// The camera of a page and what pictures of it are due.
class Viewer {
 public:
  Viewer(std::shared_ptr<const Look> look, const Options& options)
      : look_(std::move(look)), options_(options) {}

  void resize(const SizeMessage& size);
  // A camera that the program chose, and the distance of its clipping plane; 0: none.
  void place(const scenes::Camera& camera, float clip);
  // Whether that is another camera than before.
  bool move(const CameraMessage& message, double now);
  void set_look(std::shared_ptr<const Look> look, const Options& options);
  void watch(const WatchMessage& message);
  // All that it shows is another, such as the scene.
  void renew() {
    ++version_;
    stage_ = Stage::sharp;
    complete_ = false;
  }

  // Whether there is a size, so that it can be shown at all.
  bool has_size() const { return width_ > 0; }
  bool has_camera() const { return has_camera_; }
  int width() const { return width_; }
  int height() const { return height_; }
  const scenes::Camera& camera() const { return camera_; }
  float clip() const { return clip_; }
  const std::shared_ptr<const Look>& look() const { return look_; }
  const Options& options() const { return options_; }
  bool is_visible() const { return visible_; }
  std::uint64_t version() const { return version_; }

  // The picture that is due; none while the page is hidden, has not shown those that it was sent,
  // or has the last one.
  std::optional<Order> next(double now) const;
  // Seconds until next() may say something else although nothing happened.
  double wait(double now) const;
  // An order was rendered in so many seconds: of a picture that grows, is it done?
  void done(const Order& order, double seconds, bool is_complete);
  // A picture goes to the page: its number, from 1 on. The page says up to which it has seen them
  // or will never see them.
  std::uint64_t send(double now);
  void seen(const SeenMessage& message) { seen_ = std::max(seen_, std::min(message.frame, sent_)); }

 private:
  bool is_moving(double now) const;
  bool is_busy(double now) const;

  std::shared_ptr<const Look> look_;
  Options options_;
  int width_ = 0, height_ = 0;
  scenes::Camera camera_;
  float clip_ = 0;
  bool has_camera_ = false, moving_ = false, visible_ = true, figures_ = false, complete_ = false;
  std::uint64_t camera_number_ = 0, rendered_number_ = 0, version_ = 0;
  std::uint64_t sent_ = 0, seen_ = 0;
  double moved_at_ = 0, sent_at_ = 0;
  double scale_ = 1;  // of pictures that move, in either direction
  FrameCost cost_;    // of those
  Stage stage_ = Stage::sharp;
};

}  // namespace delray::apps::view
