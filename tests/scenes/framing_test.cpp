#include "scenes/framing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "scenes/camera_path.h"
#include "scenes/generate.h"

namespace delray::scenes {
namespace {

const char* const kNames[] = {"default", "front", "back", "left", "right", "top", "bottom", "iso"};

struct Projected {
  glm::dvec2 pixel;
  double depth;
};

Projected project(const View& view, const glm::dvec3& p) {
  const glm::dvec3 v = p - glm::dvec3(view.eye);
  const double depth = glm::dot(v, glm::dvec3(view.forward));
  return {{view.half_width + glm::dot(v, glm::dvec3(view.right)) / depth * view.scale,
           view.half_height - glm::dot(v, glm::dvec3(view.up)) / depth * view.scale},
          depth};
}

glm::dvec3 corner(const geometry::Box3& box, int i) {
  return {(i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
          (i & 4) != 0 ? box.high.z : box.low.z};
}

TEST(CameraAround, ShowsAllCornersOfTheBoxAndFillsTheFrame) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const float scale = std::pow(10.0F, 8 * unit(random) - 4);
    geometry::Box3 box;
    box.low = (glm::vec3(unit(random), unit(random), unit(random)) - 0.5F) * (20 * scale);
    box.high = box.low + glm::vec3(unit(random), unit(random), unit(random)) * scale;
    const int width = trial % 2 == 0 ? 1920 : 300, height = trial % 2 == 0 ? 1080 : 500;
    for (const char* name : kNames) {
      const Camera camera = camera_around(box, name, trial % 3 == 0,
                                          static_cast<float>(width) / static_cast<float>(height));
      const View view = make_view(camera, width, height);
      glm::dvec2 low(1e9), high(-1e9);
      double nearest = 1e300;
      for (int i = 0; i < 8; ++i) {
        const Projected p = project(view, corner(box, i));
        nearest = std::min(nearest, p.depth);
        ASSERT_GT(p.depth, view.near) << name << ", trial " << trial;
        low = glm::min(low, p.pixel);
        high = glm::max(high, p.pixel);
      }
      ASSERT_GT(low.x, 0) << name << ", trial " << trial;
      ASSERT_GT(low.y, 0) << name << ", trial " << trial;
      ASSERT_LT(high.x, width) << name << ", trial " << trial;
      ASSERT_LT(high.y, height) << name << ", trial " << trial;
      const glm::dvec2 before = low / glm::dvec2(width, height);
      const glm::dvec2 after = 1.0 - high / glm::dvec2(width, height);
      ASSERT_NEAR(before.x, after.x, 1e-3) << name << ", trial " << trial;
      ASSERT_NEAR(before.y, after.y, 1e-3) << name << ", trial " << trial;
      const double margin = std::min(before.x, before.y);
      ASSERT_GT(margin, 0.049) << name << ", trial " << trial;
      const bool as_close_as_may_be = nearest < 0.051 * glm::length(box.size());
      ASSERT_TRUE(margin < 0.051 || as_close_as_may_be) << name << ", trial " << trial;
    }
  }
}

TEST(CameraAround, NamesSayWhereTheEyeStands) {
  const geometry::Box3 box{{-1, -1, -1}, {1, 1, 1}};
  const auto eye = [&](const char* name, bool z_up) {
    return glm::normalize(camera_around(box, name, z_up, 1.5F).eye);
  };
  EXPECT_GT(eye("front", false).z, 0.99F);
  EXPECT_LT(eye("back", false).z, -0.99F);
  EXPECT_GT(eye("right", false).x, 0.99F);
  EXPECT_LT(eye("left", false).x, -0.99F);
  EXPECT_GT(eye("top", false).y, 0.99F);
  EXPECT_LT(eye("bottom", false).y, -0.99F);
  EXPECT_LT(eye("front", true).y, -0.99F);
  EXPECT_GT(eye("top", true).z, 0.99F);
  EXPECT_GT(eye("default", true).z, 0.1F);
  // Seen from the top, the far side of the front view is at the upper edge.
  EXPECT_GT(make_view(camera_around(box, "top", false, 1), 9, 9).up.z, -1.01F);
  EXPECT_LT(make_view(camera_around(box, "top", false, 1), 9, 9).up.z, -0.99F);
  EXPECT_GT(make_view(camera_around(box, "top", true, 1), 9, 9).up.y, 0.99F);
}

TEST(CameraAround, DegenerateBoxesGiveFiniteCameras) {
  constexpr float kHuge = 1e18F;
  const geometry::Box3 boxes[] = {{},
                                  {{2, 3, 4}, {2, 3, 4}},
                                  {{0, 0, 0}, {5, 0, 0}},
                                  {{0, 0, 0}, {0, 0, 5}},
                                  {{1e6F, 1e6F, 0}, {1e6F, 1e6F, 0}},
                                  {{-kHuge, -kHuge, -kHuge}, {kHuge, kHuge, kHuge}}};
  for (const geometry::Box3& box : boxes) {
    for (const char* name : kNames) {
      for (const bool z_up : {false, true}) {
        const Camera camera = camera_around(box, name, z_up, 16.0F / 9);
        const View view = make_view(camera, 160, 90);
        ASSERT_TRUE(std::isfinite(glm::length(glm::dvec3(camera.eye)))) << name;
        ASSERT_NE(camera.eye, camera.at) << name;
        ASSERT_GT(view.near, 0) << name;
        if (box.empty()) continue;
        for (int i = 0; i < 8; ++i) {
          const Projected p = project(view, corner(box, i));
          ASSERT_GT(p.depth, 0) << name;
          ASSERT_TRUE(p.pixel.x > 0 && p.pixel.x < 160 && p.pixel.y > 0 && p.pixel.y < 90) << name;
        }
      }
    }
  }
}

TEST(CameraAround, RefusesOtherNames) {
  EXPECT_THROW(camera_around(geometry::Box3(), "inside", false, 1), std::invalid_argument);
}

// Corners of triangles where the camera sees them, as parts of the frame.
struct Margins {
  double left = 1, right = 1, upper = 1, lower = 1;
};

Margins margins_of(const Scene& scene, const Camera& camera, int width, int height) {
  const View view = make_view(camera, width, height);
  Margins margins;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (const glm::uvec3& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) {
        const glm::vec3 p = instance.transform * glm::vec4(mesh.positions[t[k]], 1.0F);
        const Projected at = project(view, p);
        EXPECT_GT(at.depth, view.near);
        margins.left = std::min(margins.left, at.pixel.x / width);
        margins.right = std::min(margins.right, 1 - at.pixel.x / width);
        margins.upper = std::min(margins.upper, at.pixel.y / height);
        margins.lower = std::min(margins.lower, 1 - at.pixel.y / height);
      }
    }
  }
  return margins;
}

// A lopsided thing placed a few times: its box's corners are empty.
Scene with_instances() {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.2F, 3, 0.1F}, {0, 0.3F, 2}, {100, 100, 100}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 2, 3}};  // the last vertex is none of theirs
  scene.meshes.push_back(mesh);
  for (int i = 0; i < 5; ++i) {
    Instance instance;
    const float angle = 0.7F * static_cast<float>(i);
    instance.transform = glm::mat4x3({std::cos(angle), 0, std::sin(angle)}, {0, 1, 0},
                                     {-std::sin(angle), 0, std::cos(angle)},
                                     {static_cast<float>(i * i), -0.3F * static_cast<float>(i), 1});
    scene.instances.push_back(instance);
  }
  scene.materials.emplace_back();
  return scene;
}

TEST(CameraAround, LeavesEqualMarginsAroundWhatIsDrawn) {
  Scene generated = generate("gen:terrain:2000"), city = generate("gen:city:3000");
  const Scene placed = with_instances();
  for (const Scene* scene : {&std::as_const(generated), &std::as_const(city), &placed}) {
    for (const char* name : kNames) {
      for (const auto& [width, height] : {std::pair{960, 540}, std::pair{300, 500}}) {
        const float aspect = static_cast<float>(width) / static_cast<float>(height);
        const Camera camera = camera_around(*scene, name, aspect);
        const Margins margins = margins_of(*scene, camera, width, height);
        EXPECT_NEAR(margins.left, margins.right, 1e-4) << name;
        EXPECT_NEAR(margins.upper, margins.lower, 1e-4) << name;
        EXPECT_NEAR(std::min(margins.left, margins.upper), 0.05, 1e-4) << name;
      }
    }
  }
}

TEST(CameraAround, ShowsThePartThatIsFramed) {
  Scene scene = with_instances();
  const Camera all = camera_around(scene, "iso", 1.5F);
  Mesh& mesh = scene.meshes[0];
  mesh.positions.push_back({0.5F, 1e6F, 0});
  mesh.triangles.push_back({0, 1, 5});
  EXPECT_GT(glm::length(camera_around(scene, "iso", 1.5F).eye), 1e5F);
  scene.framed = {glm::vec3(-1000), glm::vec3(1000)};
  const Camera framed = camera_around(scene, "iso", 1.5F);
  EXPECT_EQ(framed.eye, all.eye);
  EXPECT_EQ(framed.at, all.at);
}

TEST(CameraAround, ATurntableLeavesNothingOutOfTheFrame) {
  Scene scene = with_instances();
  for (const bool z_up : {false, true}) {
    scene.z_up = z_up;
    const FarthestPoints farthest = farthest_points(scene);
    const glm::dvec3 axis = z_up ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    const Camera camera = camera_around(turned(farthest, axis, 24), "default", z_up, 1.5F);
    const geometry::Box3 box = bounds(farthest);
    const glm::dvec3 middle = (glm::dvec3(box.low) + glm::dvec3(box.high)) * 0.5;
    double least = 1;
    for (const Camera& turn : turntable(camera, 60, middle)) {
      const Margins margins = margins_of(scene, turn, 300, 200);
      for (const double margin : {margins.left, margins.right, margins.upper, margins.lower}) {
        ASSERT_GT(margin, 0.04);
        least = std::min(least, margin);
      }
    }
    EXPECT_LT(least, 0.06);
  }
}

// Whichever rank has which triangles, all see the same.
TEST(CameraAround, IsTheSameToTheBitForPartsOfAScene) {
  const char* const name = "gen:terrain:5000";
  const Scene whole = generate(name);
  ASSERT_TRUE(has_parts(name));
  for (const int parts : {1, 2, 3, 7}) {
    std::vector<ScenePart> scenes;
    for (int i = 0; i < parts; ++i) scenes.push_back(generate_part(name, i, parts));
    const auto of_all = [&](std::span<const glm::dvec3> directions) {
      std::vector<glm::dvec3> farthest;
      for (int i = parts; i-- > 0;) {
        keep_farthest(directions, Extent(scenes[static_cast<std::size_t>(i)].scene)(directions),
                      farthest);
      }
      return farthest;
    };
    for (const char* view : kNames) {
      const Camera expected = camera_around(whole, view, 1.5F);
      const Camera actual = camera_around(FarthestPoints(of_all), view, whole.z_up, 1.5F);
      EXPECT_EQ(actual.eye, expected.eye) << view;
      EXPECT_EQ(actual.at, expected.at) << view;
      EXPECT_EQ(actual.near, expected.near) << view;
    }
  }
}

TEST(Extent, HasTheFarthestVertexOfAllInstances) {
  const Scene scene = with_instances();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < 50; ++i) directions.emplace_back(unit(random), unit(random), unit(random));
  const std::vector<glm::dvec3> farthest = Extent(scene)(directions);
  ASSERT_EQ(farthest.size(), directions.size());
  for (std::size_t k = 0; k < directions.size(); ++k) {
    double reach = -1e300;
    for (const Instance& instance : scene.instances) {
      for (int i = 0; i < 4; ++i) {
        const glm::vec3 p = instance.transform * glm::vec4(scene.meshes[0].positions[i], 1.0F);
        reach = std::max(reach, glm::dot(glm::dvec3(p), directions[k]));
      }
    }
    EXPECT_EQ(glm::dot(farthest[k], directions[k]), reach);
  }
  EXPECT_TRUE(Extent(Scene())(directions).empty());
}

}  // namespace
}  // namespace delray::scenes
