// Two threads that take what waits, page by page.
#include "apps/view/frame_sender.h"

#include <chrono>
#include <cstring>
#include <utility>

#include "image/io.h"
#include "image/jpeg.h"
#include "image/srgb.h"

namespace delray::apps::view {
namespace {

constexpr int kMovingQuality = 80, kRestingQuality = 92;

std::vector<std::byte> picture_file(const image::Image8& picture, const FrameFacts& facts) {
  if (facts.is_complete) return image::encode_png(picture);
  return image::encode_jpeg(picture,
                            facts.stage == Stage::moving ? kMovingQuality : kRestingQuality);
}

}  // namespace

std::vector<std::byte> encode_frame(std::uint64_t number, const FrameFacts& facts,
                                    const Picture& picture) {
  Stopwatch watch;
  image::Image8 converted;
  const auto* bytes = std::get_if<image::Image8>(&picture);
  if (bytes == nullptr) {
    converted = image::to_8bit(std::get<image::ImageF>(picture));
    bytes = &converted;
  }
  const std::vector<std::byte> file = picture_file(*bytes, facts);
  const std::string header = json_text({{"frame", number},
                                        {"camera", facts.camera_number},
                                        {"stage", name_of(facts.stage)},
                                        {"width", bytes->width},
                                        {"height", bytes->height},
                                        {"type", facts.is_complete ? "image/png" : "image/jpeg"},
                                        {"samples", facts.samples},
                                        {"complete", facts.is_complete},
                                        {"render_seconds", facts.render_seconds},
                                        {"encode_seconds", watch.lap()}},
                                       -1);
  constexpr std::size_t kLength = 4;
  std::vector<std::byte> frame(kLength + header.size() + file.size());
  for (std::size_t i = 0; i < kLength; ++i)
    frame[i] = static_cast<std::byte>(header.size() >> (8 * i) & 0xFF);
  std::memcpy(frame.data() + kLength, header.data(), header.size());
  std::memcpy(frame.data() + kLength + header.size(), file.data(), file.size());
  return frame;
}

FrameSender::FrameSender(Viewers& viewers) : viewers_(viewers) {
  for (Lane* const lane : {&quick_, &exact_})
    lane->thread = std::jthread([this, lane](const std::stop_token& stop) { work(stop, *lane); });
}

FrameSender::~FrameSender() {
  for (Lane* const lane : {&quick_, &exact_}) {
    lane->thread.request_stop();
    lane->thread.join();
  }
}

void FrameSender::send(PageId page, const FrameFacts& facts, Picture&& picture) {
  const std::uint64_t number = viewers_.number_frame(page);
  if (number == 0) return;
  const std::scoped_lock lock(mutex_);
  Lane& lane = facts.is_complete ? exact_ : quick_;
  lane.waiting[page] = {number, facts, std::move(picture)};
  changed_.notify_all();
}

void FrameSender::work(const std::stop_token& stop, Lane& lane) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [&] { return !lane.waiting.empty(); })) {
    auto next = lane.waiting.extract(lane.waiting.begin());
    lock.unlock();
    const Waiting& waiting = next.mapped();
    try {
      viewers_.send_frame(next.key(), waiting.number,
                          encode_frame(waiting.number, waiting.facts, waiting.picture));
    } catch (const std::exception& error) {
      viewers_.tell(next.key(), {{"type", "error"}, {"text", error.what()}});
    }
    next = {};  // before the lock is taken
    lock.lock();
  }
}

}  // namespace delray::apps::view
