// What ranks that share a scene out send each other: rays, answers, clusters, loads and tiles.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "comm/buffer.h"
#include "raytrace/distributed/ray_message.h"

namespace delray::raytrace {

enum class MessageKind : std::uint32_t {
  intersect,
  answer,
  fetch,
  cluster,
  move,
  load,
  tiles,
  request_rays,  // the reply is intersect or no_rays
  no_rays
};

// How every message begins. `load`: of a message of kind load, or with Distribution::tells_loads of
// all.
struct MessageHeader {
  MessageKind kind = MessageKind::intersect;
  std::uint32_t cluster = 0;
  std::uint32_t rays = 0, shadows = 0;
  std::uint64_t load = 0;
};

// Only what is needed travels: an answer leaves the ray itself out, the point comes only with a hit
// that another rank found, and there are as many layers as were passed.
comm::Buffer pack(MessageKind kind, std::span<const RayMessage> rays,
                  std::span<const ShadowMessage> shadows);

// How a message begins. Throws comm::BadMessage where it is too short or of no kind.
MessageHeader header_of(const comm::Buffer& message);

// The rays and shadows of a message of pack(), which are all that follows the header. Throws
// comm::BadMessage where they are not.
RayQueue unpack_rays(const comm::Buffer& message, const MessageHeader& header);

// Numbers of tiles, all of them less than `all`. Throws comm::BadMessage where they are not.
comm::Buffer pack_tiles(std::span<const std::uint32_t> tiles);
std::vector<std::uint32_t> unpack_tiles(const comm::Buffer& message, std::uint32_t all);

// Sets MessageHeader::load of a packed message.
void set_load_of(comm::Buffer& message, std::uint64_t load);

comm::Buffer with_header(const MessageHeader& header, const comm::Buffer& content);

}  // namespace delray::raytrace
