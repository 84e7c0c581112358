#include "raytrace/internal/ray_messages.h"

#include <cstddef>
#include <cstring>

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

std::size_t size_of(const TravellingRay& ray) {
  return ray.placement == kMiss ? offsetof(TravellingRay, point) : sizeof(TravellingRay);
}
std::size_t size_of(const TravellingShadow& shadow) {
  return offsetof(TravellingShadow, layer) + shadow.layers * sizeof(Layer);
}

}  // namespace

comm::Buffer pack(MessageKind kind, std::span<const TravellingRay> rays,
                  std::span<const TravellingShadow> shadows) {
  std::size_t size = sizeof(MessageHeader);
  for (const TravellingRay& ray : rays) size += size_of(ray);
  for (const TravellingShadow& shadow : shadows) size += size_of(shadow);
  MessageHeader header;
  header.kind = kind;
  header.rays = static_cast<std::uint32_t>(rays.size());
  header.shadows = static_cast<std::uint32_t>(shadows.size());
  Writer out(size);
  out.put(&header, sizeof(header));
  for (const TravellingRay& ray : rays) out.put(&ray, size_of(ray));
  for (const TravellingShadow& shadow : shadows) out.put(&shadow, size_of(shadow));
  return out.take();
}

Travellers unpack_travellers(const comm::Buffer& message, const MessageHeader& header) {
  Travellers result;
  const std::byte* at = message.data() + sizeof(MessageHeader);
  result.rays.reserve(header.rays);
  for (std::uint32_t i = 0; i < header.rays; ++i) {
    TravellingRay& ray = result.rays.emplace_back();
    std::memcpy(static_cast<void*>(&ray), at, offsetof(TravellingRay, point));
    if (ray.placement != kMiss) std::memcpy(static_cast<void*>(&ray), at, sizeof(ray));
    at += size_of(ray);
  }
  result.shadows.reserve(header.shadows);
  for (std::uint32_t i = 0; i < header.shadows; ++i) {
    TravellingShadow& shadow = result.shadows.emplace_back();
    std::memcpy(static_cast<void*>(&shadow), at, offsetof(TravellingShadow, layer));
    std::memcpy(static_cast<void*>(&shadow), at, size_of(shadow));
    at += size_of(shadow);
  }
  return result;
}

comm::Buffer with_header(const MessageHeader& header, const comm::Buffer& content) {
  Writer out(sizeof(header) + content.size());
  out.put(&header, sizeof(header));
  if (!content.empty()) out.put(content.data(), content.size());
  return out.take();
}

}  // namespace delray::raytrace
