// Packs rays as far as they have something to say: without a point while they have met nothing, and
// with as many layers as there are. A message that is too short, too long or of no kind is refused.
#include "raytrace/distributed/pack_messages.h"

#include <cstddef>
#include <cstring>

#include "comm/bad_message.h"

namespace delray::raytrace {
namespace {

class Writer {
 public:
  explicit Writer(std::size_t size) : buffer_(size) {}
  void put(const void* from, std::size_t size) {
    std::memcpy(buffer_.data() + at_, from, size);
    at_ += size;
  }
  comm::Buffer take() { return std::move(buffer_); }

 private:
  comm::Buffer buffer_;
  std::size_t at_ = 0;
};

// The point is last in a ray, and what few points need is last in a point.
constexpr std::size_t kPlainRay = offsetof(RayMessage, point) + offsetof(shading::Point, second);

std::size_t size_of(const RayMessage& ray) {
  if (ray.instance == kMiss) return offsetof(RayMessage, point);
  return ray.return_address.second_uvs != 0 ? sizeof(RayMessage) : kPlainRay;
}
std::size_t size_of(const ShadowMessage& shadow) {
  return offsetof(ShadowMessage, layer) + shadow.layers * sizeof(Layer);
}

}  // namespace

comm::Buffer pack(MessageKind kind, std::span<const RayMessage> rays,
                  std::span<const ShadowMessage> shadows) {
  std::size_t size = sizeof(MessageHeader);
  for (const RayMessage& ray : rays) size += size_of(ray);
  for (const ShadowMessage& shadow : shadows) size += size_of(shadow);
  MessageHeader header;
  header.kind = kind;
  header.rays = static_cast<std::uint32_t>(rays.size());
  header.shadows = static_cast<std::uint32_t>(shadows.size());
  Writer out(size);
  out.put(&header, sizeof(header));
  for (const RayMessage& ray : rays) out.put(&ray, size_of(ray));
  for (const ShadowMessage& shadow : shadows) out.put(&shadow, size_of(shadow));
  return out.take();
}

MessageHeader header_of(const comm::Buffer& message) {
  comm::check_message(message.size() >= sizeof(MessageHeader));
  MessageHeader header;
  std::memcpy(&header, message.data(), sizeof header);
  comm::check_message(header.kind <= MessageKind::load);
  return header;
}

RayQueue unpack_rays(const comm::Buffer& message, const MessageHeader& header) {
  constexpr std::size_t kRay = offsetof(RayMessage, point);
  constexpr std::size_t kShadow = offsetof(ShadowMessage, layer);
  const std::byte* at = message.data() + sizeof(MessageHeader);
  std::size_t rest = message.size() - sizeof(MessageHeader);
  const auto read = [&](void* to, std::size_t size) {
    comm::check_message(rest >= size);
    std::memcpy(to, at, size);
  };
  const auto advance = [&](std::size_t size) {
    at += size;
    rest -= size;
  };
  comm::check_message(rest / kRay >= header.rays && rest / kShadow >= header.shadows);
  RayQueue result;
  result.rays.reserve(header.rays);
  for (std::uint32_t i = 0; i < header.rays; ++i) {
    RayMessage& ray = result.rays.emplace_back();
    read(static_cast<void*>(&ray), kRay);
    if (ray.instance != kMiss) read(static_cast<void*>(&ray), size_of(ray));
    advance(size_of(ray));
  }
  result.shadows.reserve(header.shadows);
  for (std::uint32_t i = 0; i < header.shadows; ++i) {
    ShadowMessage& shadow = result.shadows.emplace_back();
    read(static_cast<void*>(&shadow), kShadow);
    comm::check_message(shadow.layers <= SeeThrough::kMost &&
                        at[offsetof(ShadowMessage, occluded)] <= std::byte{1});
    read(static_cast<void*>(&shadow), size_of(shadow));
    advance(size_of(shadow));
  }
  comm::check_message(rest == 0);
  return result;
}

comm::Buffer with_header(const MessageHeader& header, const comm::Buffer& content) {
  Writer out(sizeof(header) + content.size());
  out.put(&header, sizeof(header));
  if (!content.empty()) out.put(content.data(), content.size());
  return out.take();
}

}  // namespace delray::raytrace
