// delray similar: the nearest of a decimated and turned copy is its original.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "scenes/generate.h"
#include "scenes/load.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

// Corners in one cell of a lattice become one, where the first of them is (Rossignac and Borrel
// 1993), and all are moved.
void write_copy(const scenes::Scene& scene, double cells, const glm::dmat4& transform,
                const std::filesystem::path& path) {
  glm::dvec3 low(1e300), high(-1e300);
  const auto for_each_triangle = [&](auto&& f) {
    for (const scenes::Instance& instance : scene.instances) {
      const scenes::Mesh& mesh = scene.meshes[instance.mesh];
      for (const glm::uvec3& corners : mesh.triangles) {
        std::array<glm::dvec3, 3> p;
        for (int k = 0; k < 3; ++k) {
          p[k] = glm::dmat4x3(instance.transform) * glm::dvec4(mesh.positions[corners[k]], 1);
        }
        f(p);
      }
    }
  };
  for_each_triangle([&](const auto& p) {
    for (const glm::dvec3& x : p) {
      low = glm::min(low, x);
      high = glm::max(high, x);
    }
  });
  const double cell = glm::length(high - low) / cells;
  std::map<std::array<long, 3>, int> numbers;
  std::ofstream file(path);
  file.precision(9);
  std::string faces;
  for_each_triangle([&](const auto& p) {
    std::array<int, 3> face;
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<long, 3> key;
      for (int axis = 0; axis < 3; ++axis) {
        key[static_cast<std::size_t>(axis)] = std::lround((p[k][axis] - low[axis]) / cell);
      }
      const auto [entry, is_new] = numbers.try_emplace(key, static_cast<int>(numbers.size()) + 1);
      face[k] = entry->second;
      if (!is_new) continue;
      const glm::dvec3 moved = transform * glm::dvec4(p[k], 1);
      file << "v " << moved.x << ' ' << moved.y << ' ' << moved.z << '\n';
    }
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) return;
    faces += "f " + std::to_string(face[0]) + ' ' + std::to_string(face[1]) + ' ' +
             std::to_string(face[2]) + '\n';
  });
  file << faces;
}

glm::dmat4 random_motion(std::mt19937& random) {
  const auto number = [&] { return std::uniform_real_distribution<>(-1, 1)(random); };
  glm::dmat4 transform = glm::translate(glm::dmat4(1), glm::dvec3(number(), number(), number()));
  transform = glm::rotate(transform, 3 * number(),
                          glm::normalize(glm::dvec3(number(), number(), 1.1 + number())));
  return glm::scale(transform, glm::dvec3(1.5 + number()));
}

// Copies of each model, against all of them, by three and six features, of one by others, too.
void expect_originals(const std::vector<std::string>& models, double cells, std::uint32_t seed) {
  const Folder folder;
  std::mt19937 random(seed);
  std::string all;
  for (const std::string& model : models) all += " " + model;
  for (const std::string& model : models) {
    std::vector<std::string> warnings;
    write_copy(scenes::load(model, warnings), cells, random_motion(random), folder / "copy.obj");
    const bool is_first = model == models.front();
    for (const int dim : is_first ? std::vector{3, 4, 5, 6} : std::vector{3, 6}) {
      const Ran ran =
          run("delray similar" + all + " --to copy.obj -n 2 --stats - --dim " + std::to_string(dim),
              folder.path());
      ASSERT_EQ(ran.exit_code, 0) << ran.err;
      const json told = json::parse(ran.out);
      EXPECT_EQ(told["schema"], "delray.similar/1");
      EXPECT_EQ(told["features"].size(), static_cast<std::size_t>(dim));
      EXPECT_EQ(told["models"][0]["model"], model) << "seed " << seed << "\n" << told.dump(1);
      EXPECT_LT(told["models"][0]["distance"], told["models"][1]["distance"]);
    }
  }
}

TEST(SimilarCommand, FindsTheOriginalsOfGeneratedModels) {
  const Folder folder;
  std::vector<std::string> models;
  for (const char* kind : {"spheres", "cornell", "terrain", "city", "machine", "cloth", "arm"}) {
    const std::string name = std::string(kind) + ".glb";
    ASSERT_EQ(
        run("delray generate scene " + std::string(kind) + " -n 4000 -o " + name, folder.path())
            .exit_code,
        0);
    models.push_back(folder / name);
  }
  expect_originals(models, 60, 3);
}

TEST(SimilarCommand, FindsTheOriginalsOfScannedModels) {
  const std::filesystem::path data = DELRAY_SHARED_DATA;
  std::vector<std::string> models;
  for (const char* name :
       {"armadillo.obj", "nefertiti.obj", "spot.obj", "stanford-bunny.obj", "teapot.obj"}) {
    if (std::filesystem::exists(data / name)) models.push_back(data / name);
  }
  if (models.size() < 3) GTEST_SKIP() << "no models in " << data;
  expect_originals(models, 40, 5);
}

TEST(SimilarCommand, SaysWhatIsMissing) {
  const Folder folder;
  folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("points.xyz", "0 0 0\n1 0 0\n0 1 1\n");
  EXPECT_EQ(run("delray similar --to flat.obj", folder.path()).exit_code, 2);
  EXPECT_EQ(run("delray similar flat.obj", folder.path()).exit_code, 2);
  EXPECT_EQ(run("delray similar flat.obj --to flat.obj --dim 2", folder.path()).exit_code, 2);
  EXPECT_EQ(run("delray similar flat.obj --to missing.obj", folder.path()).exit_code, 3);
  // One model, whose copy is no farther.
  const Ran ran = run("delray similar flat.obj --to flat.obj", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_NE(ran.out.find("0.0000  flat.obj"), std::string::npos) << ran.out;
}

// Means of equal features differ from them by rounding, which is no measure of anything.
TEST(SimilarCommand, DistancesFromCopiesOfOneModelAreThoseOfItsFeatures) {
  const Folder folder;
  folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("long.obj", "v 0 0 0\nv 7 0 0\nv 0 1 0\nf 1 2 3\n");
  std::string models;
  for (int copies = 1; copies <= 12; ++copies) {
    models += " flat.obj";
    const Ran ran =
        run("delray similar" + models + " --to long.obj -n 50 --stats -", folder.path());
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    const json told = json::parse(ran.out);
    ASSERT_EQ(told["models"].size(), static_cast<std::size_t>(copies));
    for (const json& model : told["models"]) EXPECT_LT(model["distance"], 10) << copies;
  }
}

}  // namespace
}  // namespace delray::tests
