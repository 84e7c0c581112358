#include "raytrace/integrators/hits_by_material.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <memory>
#include <random>
#include <set>

#include "tests/support/targets.h"

namespace delray::raytrace {
namespace {

TEST(HitsByMaterial, GivesEveryHitOnceAndThoseOfAMaterialTogether) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    constexpr std::uint32_t kMaterials = 5;
    HitsByMaterial hits(kMaterials);
    for (int turn = 0; turn < 2; ++turn) {  // nothing is left over for the second
      std::vector<std::uint32_t> material_of;
      std::size_t count = 0;
      for (std::uint32_t group = 0; group < seed % 20; ++group) {
        material_of.resize(material_of.size() + kPacketRays, kMaterials);
        shading::LaneMask rest = random() & shading::kAllLanes;
        while (rest != 0) {
          const shading::LaneMask some = rest & (random() | (rest & -rest));
          const std::uint32_t material = random() % kMaterials;
          hits.add(material, group, some);
          rest &= ~some;
          for (std::uint32_t i = 0; i < kPacketRays; ++i) {
            if ((some >> i & 1) != 0) material_of[group * kPacketRays + i] = material;
          }
          count += static_cast<std::size_t>(std::popcount(some));
        }
      }
      const std::span<const std::uint32_t> all = hits.take();
      ASSERT_EQ(all.size(), count) << "seed " << seed;
      std::set<std::uint32_t> seen, done;
      std::uint32_t last = kMaterials;
      for (const std::uint32_t hit : all) {
        ASSERT_TRUE(seen.insert(hit).second) << "seed " << seed << " hit " << hit;
        const std::uint32_t material = material_of.at(hit);
        ASSERT_LT(material, kMaterials) << "seed " << seed << " hit " << hit;
        if (material != last) {
          ASSERT_TRUE(done.insert(material).second) << "seed " << seed << " hit " << hit;
        }
        last = material;
      }
    }
  }
}

TEST(HitsByMaterial, GathersWhatEachHitIsOf) {
  tests::for_each_target([] {
    Groups<RayGroup> groups;
    Groups<PathLanes> path_lanes;
    constexpr std::uint32_t kGroups = 3;
    for (std::uint32_t g = 0; g < kGroups; ++g) {
      groups.add();
      path_lanes.add();
    }
    // Every number of a group another one.
    const auto fill = [](auto& whole, float first) {
      auto* numbers = reinterpret_cast<std::byte*>(&whole);
      for (std::size_t i = 0; i + sizeof(float) <= sizeof(whole); i += sizeof(float)) {
        std::memcpy(numbers + i, &first, sizeof(float));
        first += 1.0F;
      }
    };
    for (std::uint32_t g = 0; g < kGroups; ++g) {
      fill(groups[g], static_cast<float>(g) * 10000.0F);
      fill(path_lanes[g], static_cast<float>(g) * 10000.0F + 5000.0F);
    }
    const std::uint32_t hits[] = {17, 3, 47, 0, 16, 20, 33};
    constexpr int kHits = 7;
    const auto to = std::make_unique<RayGroup>();
    const auto to_lanes = std::make_unique<PathLanes>();
    gather_hits(groups, path_lanes, hits, true, 2, *to, *to_lanes);
    EXPECT_TRUE(to->points.coloured);
    for (int i = 0; i < kPacketRays; ++i) {
      const std::uint32_t hit = hits[i < kHits ? i : 0];
      const RayGroup& group = groups[hit / kPacketRays];
      const PathLanes& lanes = path_lanes[hit / kPacketRays];
      const int lane = static_cast<int>(hit % kPacketRays);
      const auto same = [&](const auto& a, const auto& b) { return a[i] == b[lane]; };
      const auto all = [&](const shading::Vectors16& a, const shading::Vectors16& b) {
        return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
      };
      const shading::Points &a = to->points, &b = group.points;
      EXPECT_TRUE(all(a.position, b.position)) << i;
      EXPECT_TRUE(all(a.geometric_normal, b.geometric_normal)) << i;
      EXPECT_TRUE(all(a.normal, b.normal)) << i;
      EXPECT_TRUE(all(a.tangent, b.tangent) && same(a.handedness, b.handedness)) << i;
      for (int set = 0; set < 2; ++set) {
        const shading::TexturePoints &at = a.uvs[set], &other = b.uvs[set];
        EXPECT_TRUE(same(at.u, other.u) && same(at.v, other.v)) << i;
        EXPECT_TRUE(same(at.dx_u, other.dx_u) && same(at.dx_v, other.dx_v)) << i;
        EXPECT_TRUE(same(at.dy_u, other.dy_u) && same(at.dy_v, other.dy_v)) << i;
      }
      EXPECT_TRUE(all(a.colour, b.colour) && same(a.colour_alpha, b.colour_alpha)) << i;
      EXPECT_TRUE(all(to->view, group.view) && same(to->width, group.width)) << i;
      EXPECT_TRUE(same(to->spread, group.spread) && same(to->offset, group.offset)) << i;
      EXPECT_TRUE(same(to->packet.far, group.packet.far)) << i;
      EXPECT_TRUE(same(to->material, group.material)) << i;
      EXPECT_TRUE(all(to_lanes->throughput, lanes.throughput) && same(to_lanes->pdf, lanes.pdf))
          << i;
      EXPECT_TRUE(same(to_lanes->pixel, lanes.pixel) && same(to_lanes->bounce, lanes.bounce)) << i;
      EXPECT_TRUE(same(to_lanes->vertex, lanes.vertex)) << i;
    }
  });
}

}  // namespace
}  // namespace delray::raytrace
