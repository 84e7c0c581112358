// Clusters that travel in fewer bytes come out as they went in.
#include "raytrace/clusters/compress_cluster.h"

#include <gtest/gtest.h>

#include <random>

#include "comm/bad_message.h"
#include "scenes/generate.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

std::vector<ClusterData> clusters_of(const scenes::Scene& scene) {
  const shading::Shader shader = shading::make_shader(scene);
  const std::vector<GeometryInstance> instances = make_instances(scene, shader, true);
  return cut_clusters(instances, 0, stored_triangles(instances), 500);
}

bool equal(const comm::Buffer& a, const comm::Buffer& b) {
  return std::ranges::equal(a.as<std::byte>(), b.as<std::byte>());
}

TEST(CompressCluster, IsExactAndSmaller) {
  std::size_t packed = 0, compressed = 0;
  for (const ClusterData& cluster : clusters_of(scenes::generate("gen:terrain:4000"))) {
    const comm::Buffer message = compress(cluster), plain = pack(cluster);
    packed += plain.size();
    compressed += message.size();
    EXPECT_TRUE(equal(pack(decompress_cluster(message.as<std::byte>())), plain));
  }
  EXPECT_LT(4 * compressed, 3 * packed);
  const ClusterData nothing;
  EXPECT_TRUE(equal(pack(decompress_cluster(compress(nothing).as<std::byte>())), pack(nothing)));
}

// What comes damaged is refused or comes out as some cluster, and takes no more memory than that.
TEST(CompressCluster, SurvivesAnything) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  scenes::Scene scene;
  add(scene, sphere(8));
  const comm::Buffer message = compress(clusters_of(scene)[0]);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<std::byte> bytes(message.as<std::byte>().begin(), message.as<std::byte>().end());
    if (i % 3 == 0) bytes.resize(random() % bytes.size());
    for (int k = 0; k < 3 && !bytes.empty(); ++k)
      bytes[random() % bytes.size()] = static_cast<std::byte>(random());
    try {
      decompress_cluster(bytes);
    } catch (const comm::BadMessage&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace delray::raytrace
