// What ranks that share a scene out send each other: rays, answers, clusters and loads.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "comm/buffer.h"
#include "raytrace/distributed/travelling.h"

namespace delray::raytrace {

enum class MessageKind : std::uint32_t { meet, answer, fetch, cluster, move, load };

// How every message begins.
struct MessageHeader {
  MessageKind kind = MessageKind::meet;
  std::uint32_t cluster = 0;
  std::uint32_t rays = 0, shadows = 0;
  std::uint64_t load = 0;
};

// Of a ray the point travels only if there is one, and no more layers than there are.
comm::Buffer pack(MessageKind kind, std::span<const TravellingRay> rays,
                  std::span<const TravellingShadow> shadows);

// How a message begins. Throws comm::BadMessage where it is too short or of no kind.
MessageHeader header_of(const comm::Buffer& message);

// The rays and shadows of a message of pack(), which are all that follows the header. Throws
// comm::BadMessage where they are not.
struct Travellers {
  std::vector<TravellingRay> rays;
  std::vector<TravellingShadow> shadows;
};
Travellers unpack_travellers(const comm::Buffer& message, const MessageHeader& header);

comm::Buffer with_header(const MessageHeader& header, const comm::Buffer& content);

}  // namespace delray::raytrace
