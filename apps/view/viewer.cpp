// Stages follow each other until something changes; the size of moving pictures follows from how
// long the last ones took.
#include "apps/view/viewer.h"

#include <algorithm>
#include <cmath>

namespace delray::apps::view {
namespace {

constexpr double kFrame = 1.0 / 30;  // seconds that a picture that moves may take
constexpr double kPause = 0.2;       // seconds after which a camera that was moving stands still
// Pictures that are on their way to a page: one that travels, one that is shown.
constexpr std::uint64_t kMostUnseen = 2;
constexpr double kLost = 2;             // seconds after which nobody waits for a page any more
constexpr double kLeastScale = 0.25;    // of moving pictures
constexpr double kScaleStep = 1.0 / 8;  // so that sizes do not change all the time
constexpr int kLeastSide = 16;
constexpr std::int64_t kMostPixels = std::int64_t{1} << 24;

// Pixels a side, as a part of what the page has.
int scaled(int side, double scale) {
  return std::max(std::min(side, kLeastSide), static_cast<int>(std::lround(side * scale)));
}

}  // namespace

void FrameCost::note(double area, double seconds) {
  constexpr double kKept = 0.9;            // of what was known, after each picture
  constexpr double kLeastVariance = 1e-3;  // of areas, for a slope that can be believed
  for (double* const sum : {&weight_, &area_, &seconds_, &area2_, &product_}) *sum *= kKept;
  weight_ += 1;
  area_ += area;
  seconds_ += seconds;
  area2_ += area * area;
  product_ += area * seconds;
  const double variance = area2_ / weight_ - area_ * area_ / (weight_ * weight_);
  if (variance > kLeastVariance) {
    const double covariance = product_ / weight_ - area_ * seconds_ / (weight_ * weight_);
    fixed_ = (seconds_ - covariance / variance * area_) / weight_;
  }
  fixed_ = std::clamp(fixed_, 0.0, seconds_ / weight_);
}

double FrameCost::area_in(double seconds) const {
  constexpr double kMost = 16;
  if (weight_ == 0) return kMost;
  const double by_area = (seconds_ / weight_ - fixed_) * weight_ / area_;
  const double left = std::max(seconds - fixed_, fixed_ / 2);
  return by_area * kMost <= left ? kMost : left / by_area;
}

const char* name_of(Stage stage) {
  constexpr const char* kNames[] = {"moving", "sharp", "coarse", "still"};
  return kNames[static_cast<std::size_t>(stage)];
}

void Viewer::resize(const SizeMessage& size) {
  const double area = static_cast<double>(size.width) * size.height;
  const double shrink = std::min(1.0, std::sqrt(static_cast<double>(kMostPixels) / area));
  const int width = scaled(size.width, shrink), height = scaled(size.height, shrink);
  if (width == width_ && height == height_) return;
  width_ = width;
  height_ = height;
  renew();
}

void Viewer::place(const scenes::Camera& camera, float clip) {
  camera_ = camera;
  clip_ = clip;
  has_camera_ = true;
  moving_ = false;
  renew();
}

bool Viewer::move(const CameraMessage& message, double now) {
  const PageCamera& page = message.camera;
  const bool same = has_camera_ && page.eye == camera_.eye && page.at == camera_.at &&
                    page.up == camera_.up && page.fov == camera_.vertical_fov &&
                    page.height == camera_.height && page.clip == clip_;
  camera_number_ = message.number;
  moving_ = message.moving;
  moved_at_ = now;
  if (same) return false;
  camera_.eye = page.eye;
  camera_.at = page.at;
  camera_.up = page.up;
  camera_.vertical_fov = page.fov;
  camera_.height = page.height;
  clip_ = page.clip;
  camera_.near = page.clip;
  camera_.far = 0;
  camera_.name.clear();
  has_camera_ = true;
  renew();
  return true;
}

void Viewer::set_look(std::shared_ptr<const Look> look, const Options& options) {
  look_ = std::move(look);
  options_ = options;
  renew();
}

void Viewer::watch(const WatchMessage& message) {
  visible_ = message.visible;
  if (message.figures && !figures_) renew();  // the last picture had none
  figures_ = message.figures;
}

bool Viewer::is_moving(double now) const { return moving_ && now - moved_at_ < kPause; }

bool Viewer::is_busy(double now) const {
  return sent_ - seen_ >= kMostUnseen && now - sent_at_ < kLost;
}

std::optional<Order> Viewer::next(double now) const {
  if (!visible_ || !has_size() || !has_camera_ || is_busy(now)) return std::nullopt;
  Order order;
  order.stage = stage_;
  if (is_moving(now)) {
    if (rendered_number_ == camera_number_) return std::nullopt;
    order.stage = Stage::moving;
  } else if (complete_ && stage_ == Stage::still) {
    return std::nullopt;
  }
  const double scale = order.stage == Stage::moving   ? scale_
                       : order.stage == Stage::coarse ? 0.25
                                                      : 1.0;
  order.width = scaled(width_, scale);
  order.height = scaled(height_, scale);
  order.camera_number = camera_number_;
  order.version = version_;
  order.camera = camera_;
  order.look = look_;
  order.figures = figures_;
  const SamplingOptions& lens = look_->still.sampling;
  order.camera.aperture = static_cast<float>(lens.aperture);
  order.camera.focus = static_cast<float>(lens.focus);
  return order;
}

double Viewer::wait(double now) const {
  constexpr double kForEver = 1e9;
  if (!visible_) return kForEver;
  double until = kForEver;
  if (is_moving(now)) until = std::min(until, moved_at_ + kPause - now);
  if (is_busy(now)) until = std::min(until, sent_at_ + kLost - now);
  return std::max(until, 0.0);
}

void Viewer::done(const Order& order, double seconds, bool is_complete) {
  if (order.stage == Stage::moving) {
    rendered_number_ = order.camera_number;
    cost_.note(
        static_cast<double>(order.width) * order.height / (static_cast<double>(width_) * height_),
        std::max(seconds, 1e-4));
    // Half of the way at once: a frame may have been slow for reasons of its own.
    const double ideal = std::sqrt(cost_.area_in(kFrame)) * 1.01;
    const double wanted = std::clamp((scale_ + ideal) / 2, kLeastScale, 1.0);
    if (wanted < scale_ - kScaleStep / 2 || wanted >= scale_ + kScaleStep)
      scale_ = std::round(wanted / kScaleStep) * kScaleStep;
    return;
  }
  if (order.version != version_ || order.stage != stage_) return;
  if (stage_ == Stage::still) {
    complete_ = is_complete;
    return;
  }
  const bool has_rays = is_raytrace(look_->still);
  stage_ = stage_ == Stage::sharp && has_rays ? Stage::coarse : Stage::still;
  complete_ = false;
}

std::uint64_t Viewer::send(double now) {
  sent_at_ = now;
  return ++sent_;
}

}  // namespace delray::apps::view
