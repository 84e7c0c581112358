// Rays through messages: what is needed arrives, and nothing else travels.
#include "raytrace/distributed/pack_messages.h"

#include <gtest/gtest.h>

#include "comm/bad_message.h"

namespace delray::raytrace {
namespace {

RayMessage some_ray(bool found, bool second_uvs) {
  RayMessage ray;
  ray.return_address = {.rank = 3, .pixel_task = 4, .group = 5, .lane = 6};
  ray.return_address.found = found ? 1 : 0;
  ray.return_address.second_uvs = second_uvs ? 1 : 0;
  ray.nearest = {7.5F, 8, 9};
  ray.ray.origin = {1, 2, 3};
  ray.ray.direction = {4, 5, 6};
  ray.ray.way.next = 17;
  ray.ray.way.note(2);
  ray.view = {0, 1, 0};
  ray.width = 0.25F;
  ray.spread = 0.125F;
  if (!found) return ray;
  ray.hit = std::make_unique<HitPoint>();
  ray.hit->u = 0.75F;
  ray.hit->point.position = {10, 11, 12};
  ray.hit->point.second.uv = {13, 14};
  return ray;
}

ShadowMessage some_shadow(std::size_t layers) {
  ShadowMessage shadow;
  shadow.return_address.lane = 11;
  shadow.return_address.occluded = layers == 0 ? 1 : 0;
  shadow.return_address.layers = static_cast<std::uint8_t>(layers);
  shadow.ray.origin = {1, 2, 3};
  shadow.far = 4.0F;
  for (std::size_t i = 0; i < layers; ++i) {
    shadow.layers.push_back({static_cast<float>(i), 2, 3, glm::vec3(0.5F)});
  }
  return shadow;
}

RayQueue through_message(MessageKind kind, const RayQueue& queue, std::size_t* bytes = nullptr) {
  const comm::Buffer message = pack(kind, queue.rays, queue.shadows);
  if (bytes != nullptr) *bytes = message.size();
  const MessageHeader header = header_of(message);
  EXPECT_EQ(header.kind, kind);
  return unpack_rays(message, header);
}

TEST(PackMessages, RaysToIntersectKeepEverything) {
  RayQueue queue;
  queue.rays.push_back(some_ray(true, true));
  queue.rays.push_back(some_ray(false, false));
  queue.shadows = {some_shadow(0), some_shadow(3)};
  const RayQueue arrived = through_message(MessageKind::intersect, queue);
  ASSERT_EQ(arrived.rays.size(), 2U);
  ASSERT_EQ(arrived.shadows.size(), 2U);
  for (const RayMessage& ray : arrived.rays) {
    EXPECT_EQ(ray.return_address.lane, 6);
    EXPECT_EQ(ray.nearest.triangle, 9U);
    EXPECT_EQ(ray.ray.direction, glm::vec3(4, 5, 6));
    EXPECT_EQ(ray.ray.way.next, 17U);
    EXPECT_TRUE(ray.ray.way.has_been_at(2));
    EXPECT_FALSE(ray.ray.way.has_been_at(3));
    EXPECT_EQ(ray.view, glm::vec3(0, 1, 0));
    EXPECT_EQ(ray.spread, 0.125F);
  }
  EXPECT_EQ(arrived.rays[0].hit->point.position, glm::vec3(10, 11, 12));
  EXPECT_EQ(arrived.rays[0].hit->point.second.uv, glm::vec2(13, 14));
  EXPECT_EQ(arrived.shadows[1].far, 4.0F);
  ASSERT_EQ(arrived.shadows[1].layers.size(), 3U);
  EXPECT_EQ(arrived.shadows[1].layers[2].distance, 2.0F);
}

TEST(PackMessages, AnswersLeaveTheRayOut) {
  RayQueue queue;
  queue.rays.push_back(some_ray(true, false));
  queue.shadows = {some_shadow(2)};
  std::size_t there = 0, back = 0;
  through_message(MessageKind::intersect, queue, &there);
  const RayQueue arrived = through_message(MessageKind::answer, queue, &back);
  EXPECT_LT(back + 2 * sizeof(TravellingRay), there);
  ASSERT_EQ(arrived.rays.size(), 1U);
  EXPECT_EQ(arrived.rays[0].nearest.far, 7.5F);
  EXPECT_EQ(arrived.rays[0].hit->u, 0.75F);
  EXPECT_EQ(arrived.rays[0].hit->point.position, glm::vec3(10, 11, 12));
  EXPECT_EQ(arrived.shadows[0].layers.size(), 2U);
  queue.rays.clear();
  queue.shadows = {some_shadow(0)};
  through_message(MessageKind::answer, queue, &back);
  EXPECT_EQ(back, sizeof(MessageHeader) + sizeof(ReturnAddress));
}

TEST(PackMessages, RefusesWhatIsCutOrTooLong) {
  RayQueue queue;
  queue.rays.push_back(some_ray(true, true));
  queue.shadows = {some_shadow(1)};
  for (const MessageKind kind : {MessageKind::intersect, MessageKind::answer}) {
    const comm::Buffer message = pack(kind, queue.rays, queue.shadows);
    const MessageHeader header = header_of(message);
    for (std::size_t size = sizeof(MessageHeader); size < message.size(); ++size) {
      const comm::Buffer part = comm::Buffer::of(std::span(message.data(), size));
      EXPECT_THROW(unpack_rays(part, header), comm::BadMessage) << size;
    }
    comm::Buffer longer(message.size() + 1);
    std::copy_n(message.data(), message.size(), longer.data());
    EXPECT_THROW(unpack_rays(longer, header), comm::BadMessage);
  }
}

TEST(Progression, ForgetsTheRankThatItWasAtLongestAgo) {
  Progression way;
  for (int rank = 0; rank <= static_cast<int>(Progression::kKnown); ++rank) way.note(rank);
  EXPECT_FALSE(way.has_been_at(0));
  for (int rank = 1; rank <= static_cast<int>(Progression::kKnown); ++rank) {
    EXPECT_TRUE(way.has_been_at(rank)) << rank;
  }
  EXPECT_FALSE(way.has_been_everywhere(Progression::kKnown + 1));
}

TEST(Progression, KnowsWhenThereIsNowhereElseToGo) {
  Progression way;
  way.note(1);
  way.note(1);
  EXPECT_FALSE(way.has_been_everywhere(2));
  way.note(0);
  EXPECT_TRUE(way.has_been_everywhere(2));
  EXPECT_FALSE(way.has_been_everywhere(3));
}

TEST(PackMessages, TilesArriveAndThoseThatThereAreNotAreRefused) {
  const std::vector<std::uint32_t> tiles = {0, 7, 99};
  const comm::Buffer message = pack_tiles(tiles);
  EXPECT_EQ(header_of(message).kind, MessageKind::tiles);
  EXPECT_EQ(unpack_tiles(message, 100), tiles);
  EXPECT_TRUE(unpack_tiles(pack_tiles({}), 0).empty());
  EXPECT_THROW(unpack_tiles(message, 99), comm::BadMessage);
  const std::span<const std::byte> bytes(message.data(), message.size());
  EXPECT_THROW(unpack_tiles(comm::Buffer::of(bytes.first(bytes.size() - 1)), 100),
               comm::BadMessage);
}

}  // namespace
}  // namespace delray::raytrace
