// Packs of scenes that have animations, which packs leave out.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "packs/pack_writer.h"
#include "packs/unpack.h"
#include "scenes/generate.h"
#include "scenes/pose.h"
#include "scenes/write_glb.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

std::string hash_of(const Folder& folder, const std::string& scene, const std::string& options) {
  const Ran ran = run("delray render " + scene + " -o p.png --stats - -q --size 320x200" + options,
                      folder.path());
  EXPECT_EQ(ran.exit_code, 0) << scene << options << "\n" << ran.err;
  if (ran.exit_code != 0) return scene;
  return nlohmann::json::parse(ran.out)["image"]["hash"].get<std::string>();
}

// Meshes that are placed once, turned and scaled, and that an animation moves: rays meet them in
// their own coordinates.
scenes::Scene turned_parts() {
  scenes::Scene scene = scenes::generate("gen:machine:30000");
  std::vector<std::uint8_t> is_placed(scene.meshes.size(), 0);
  for (scenes::Instance& instance : scene.instances) {
    if (is_placed[instance.mesh]++ == 0) continue;
    const scenes::Mesh copy = scene.meshes[instance.mesh];
    instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
    scene.meshes.push_back(copy);
    is_placed.push_back(1);
  }
  std::mt19937 random(20261128);
  for (scenes::AnimatedNode& node : scene.animations.nodes) {
    glm::dvec4 q(0, 0, 0, 1);
    for (int k = 0; k < 3; ++k) q[k] = static_cast<double>(random() % 2001) / 1000 - 1;
    node.rotation = glm::normalize(q);
    node.scale *= 0.7 + static_cast<double>(random() % 1000) / 1000;
  }
  scenes::pose(scene, {});
  return scene;
}

TEST(Pack, OfWhatMovesRendersAsItDoesAtRest) {
  const Folder folder;
  const scenes::Scene scene = turned_parts();
  scenes::write_glb(folder / "m.glb", scene);
  packs::write_pack(folder / "m.pack", scene);
  packs::PackReader pack(folder / "m.pack");
  EXPECT_EQ(scenes::mesh_motions(packs::unpack(pack)), scenes::mesh_motions(scene));
  for (const std::string view : {"", " --view iso"}) {
    const std::string raster = hash_of(folder, "m.glb", view);
    for (const std::string how : {"", " --ranks 3", " --strategy sort-first --ranks 3"})
      EXPECT_EQ(hash_of(folder, "m.pack", how + view), raster) << how << view;
    const std::string rays = hash_of(folder, "m.glb", " --engine raytrace" + view);
    for (const std::string how : {"", " --data object", " --data object --ranks 3"})
      EXPECT_EQ(hash_of(folder, "m.pack", " --engine raytrace" + how + view), rays) << how << view;
  }
}

TEST(Pack, OfWhatMovesTakesMoreMeshes) {
  const Folder folder;
  packs::write_pack(folder / "m.pack", turned_parts());
  packs::PackReader pack(folder / "m.pack");
  scenes::Scene scene = packs::unpack(pack);
  for (int i = 0; i < 40; ++i) scene.meshes.push_back(scene.meshes.front());
  const std::vector<scenes::MeshMotion> motions = scenes::mesh_motions(scene);
  ASSERT_EQ(motions.size(), scene.meshes.size());
  EXPECT_EQ(motions.back(), scenes::MeshMotion::still);
  packs::write_pack(folder / "more.pack", scene);
  packs::PackReader more(folder / "more.pack");
  EXPECT_EQ(scenes::mesh_motions(packs::unpack(more)), motions);
}

}  // namespace
}  // namespace delray::tests
