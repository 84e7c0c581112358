// Packs rays as far as they have something to say, part by part. A message that is too short, too
// long or of no kind is refused.
#include "raytrace/distributed/pack_messages.h"

#include <cstddef>
#include <cstring>
#include <type_traits>

#include "comm/bad_message.h"

namespace delray::raytrace {
namespace {

// What few points need is last in a point.
constexpr std::size_t kPlainHit = offsetof(HitPoint, point) + offsetof(shading::Point, second);

// Visits the parts of a ray that travel in a message of a kind, in order: visit(address of the
// part, its bytes). What a part says of the following ones is known when they are visited.
template <class Ray, class Visit>
void for_parts(MessageKind kind, Ray& ray,
               Visit&& visit) requires(std::is_same_v<std::remove_const_t<Ray>, RayMessage>) {
  visit(&ray.return_address, sizeof ray.return_address);
  visit(&ray.nearest, sizeof ray.nearest);
  if (kind != MessageKind::answer) {
    visit(&ray.ray, sizeof ray.ray);
    visit(&ray.view, sizeof ray.view);
    visit(&ray.width, sizeof ray.width);
    visit(&ray.spread, sizeof ray.spread);
  }
  if (ray.return_address.found != 0) {
    if constexpr (!std::is_const_v<Ray>) ray.hit = std::make_unique<HitPoint>();
    visit(ray.hit.get(), ray.return_address.second_uvs != 0 ? sizeof(HitPoint) : kPlainHit);
  }
}

template <class Shadow, class Visit>
void for_parts(MessageKind kind, Shadow& shadow,
               Visit&& visit) requires(std::is_same_v<std::remove_const_t<Shadow>, ShadowMessage>) {
  visit(&shadow.return_address, sizeof shadow.return_address);
  if (kind != MessageKind::answer) {
    visit(&shadow.ray, sizeof shadow.ray);
    visit(&shadow.far, sizeof shadow.far);
  }
  if constexpr (!std::is_const_v<Shadow>) {
    comm::check_message(shadow.return_address.layers <= SeeThrough::kMost);
    shadow.layers.resize(shadow.return_address.layers);
  }
  if (!shadow.layers.empty()) visit(shadow.layers.data(), shadow.layers.size() * sizeof(Layer));
}

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

}  // namespace

comm::Buffer pack(MessageKind kind, std::span<const RayMessage> rays,
                  std::span<const ShadowMessage> shadows) {
  std::size_t size = sizeof(MessageHeader);
  const auto count = [&](const void*, std::size_t bytes) { size += bytes; };
  for (const RayMessage& ray : rays) for_parts(kind, ray, count);
  for (const ShadowMessage& shadow : shadows) for_parts(kind, shadow, count);
  MessageHeader header;
  header.kind = kind;
  header.rays = static_cast<std::uint32_t>(rays.size());
  header.shadows = static_cast<std::uint32_t>(shadows.size());
  Writer out(size);
  out.put(&header, sizeof(header));
  const auto put = [&](const void* part, std::size_t bytes) { out.put(part, bytes); };
  for (const RayMessage& ray : rays) for_parts(kind, ray, put);
  for (const ShadowMessage& shadow : shadows) for_parts(kind, shadow, put);
  return out.take();
}

MessageHeader header_of(const comm::Buffer& message) {
  comm::check_message(message.size() >= sizeof(MessageHeader));
  MessageHeader header;
  std::memcpy(&header, message.data(), sizeof header);
  comm::check_message(header.kind <= MessageKind::no_rays);
  return header;
}

RayQueue unpack_rays(const comm::Buffer& message, const MessageHeader& header) {
  const std::byte* at = message.data() + sizeof(MessageHeader);
  std::size_t rest = message.size() - sizeof(MessageHeader);
  const auto read = [&](void* to, std::size_t size) {
    comm::check_message(rest >= size);
    std::memcpy(to, at, size);
    at += size;
    rest -= size;
  };
  // No ray is shorter.
  comm::check_message(rest / (sizeof(ReturnAddress) + sizeof(NearestHit)) >= header.rays &&
                      rest / sizeof(ReturnAddress) >= header.shadows);
  RayQueue result;
  result.rays.reserve(header.rays);
  for (std::uint32_t i = 0; i < header.rays; ++i) {
    for_parts(header.kind, result.rays.emplace_back(), read);
  }
  result.shadows.reserve(header.shadows);
  for (std::uint32_t i = 0; i < header.shadows; ++i) {
    for_parts(header.kind, result.shadows.emplace_back(), read);
  }
  comm::check_message(rest == 0);
  return result;
}

comm::Buffer pack_tiles(std::span<const std::uint32_t> tiles) {
  MessageHeader header;
  header.kind = MessageKind::tiles;
  return with_header(header, comm::Buffer::of(std::as_bytes(tiles)));
}

std::vector<std::uint32_t> unpack_tiles(const comm::Buffer& message, std::uint32_t all) {
  comm::check_message(message.size() >= sizeof(MessageHeader));
  const std::size_t bytes = message.size() - sizeof(MessageHeader);
  comm::check_message(bytes % sizeof(std::uint32_t) == 0);
  std::vector<std::uint32_t> tiles(bytes / sizeof(std::uint32_t));
  if (bytes > 0) std::memcpy(tiles.data(), message.data() + sizeof(MessageHeader), bytes);
  for (const std::uint32_t tile : tiles) comm::check_message(tile < all);
  return tiles;
}

void set_load_of(comm::Buffer& message, std::uint64_t load) {
  std::memcpy(message.data() + offsetof(MessageHeader, load), &load, sizeof load);
}

comm::Buffer with_header(const MessageHeader& header, const comm::Buffer& content) {
  Writer out(sizeof(header) + content.size());
  out.put(&header, sizeof(header));
  if (!content.empty()) out.put(content.data(), content.size());
  return out.take();
}

}  // namespace delray::raytrace
