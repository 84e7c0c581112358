// Levels of detail: cuts without cracks, errors that hold.
#include "packs/build/levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <random>
#include <set>

#include "files/error.h"
#include "packs/build/simplify.h"
#include "packs/build/surface_error.h"
#include "packs/build/vertices.h"
#include "packs/pack_reader.h"
#include "packs/pack_writer.h"
#include "scenes/generate.h"
#include "tests/support/temporary_folder.h"

namespace delray::packs {
namespace {

using Point = std::array<float, 3>;
using Edges = std::map<std::pair<Point, Point>, int>;

Point key(const glm::vec3& p) { return {p.x, p.y, p.z}; }

// Edges with an odd number of triangles, by the places of their ends.
std::vector<std::pair<Point, Point>> border_of(const std::vector<scenes::Mesh>& parts) {
  Edges edges;
  for (const scenes::Mesh& mesh : parts) {
    for (const glm::uvec3& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) {
        Point a = key(mesh.positions[t[k]]), b = key(mesh.positions[t[(k + 1) % 3]]);
        if (b < a) std::swap(a, b);
        ++edges[{a, b}];
      }
    }
  }
  std::vector<std::pair<Point, Point>> border;
  for (const auto& [edge, count] : edges)
    if (count % 2 == 1) border.push_back(edge);
  return border;
}

// A ball with a wavy surface and normals.
scenes::Scene wavy_ball(int n) {
  scenes::Mesh mesh;
  mesh.name = "ball";
  const auto add = [&](const glm::vec3& direction) {
    const float radius = 1 + 0.05F * std::sin(9 * direction.x) * std::sin(7 * direction.y) +
                         0.02F * std::sin(31 * direction.z);
    mesh.positions.push_back(direction * radius);
    mesh.normals.push_back(direction);
  };
  add({0, 1, 0});
  for (int j = 1; j < n; ++j) {
    const float up = 3.14159265F * static_cast<float>(j) / static_cast<float>(n);
    for (int i = 0; i < 2 * n; ++i) {
      const float turn = 3.14159265F * static_cast<float>(i) / static_cast<float>(n);
      add({std::sin(up) * std::cos(turn), std::cos(up), std::sin(up) * std::sin(turn)});
    }
  }
  add({0, -1, 0});
  const auto at = [&](int j, int i) {
    return static_cast<std::uint32_t>(1 + (j - 1) * 2 * n + i % (2 * n));
  };
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (int i = 0; i < 2 * n; ++i) {
    mesh.triangles.emplace_back(0, at(1, i + 1), at(1, i));
    for (int j = 1; j + 1 < n; ++j) {
      mesh.triangles.emplace_back(at(j, i), at(j, i + 1), at(j + 1, i));
      mesh.triangles.emplace_back(at(j, i + 1), at(j + 1, i + 1), at(j + 1, i));
    }
    mesh.triangles.emplace_back(at(n - 1, i), at(n - 1, i + 1), last);
  }
  scenes::Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({});
  scene.materials.emplace_back();
  return scene;
}

// The pages that a bound of error in the scene's units chooses.
std::vector<scenes::Mesh> cut_of(const PackReader& pack, float most) {
  std::vector<scenes::Mesh> parts;
  for (std::uint32_t i = 0; i < pack.pages().size(); ++i) {
    const PageRow& row = pack.pages()[i];
    const bool fine = row.made_of == kNoGroup || pack.groups()[row.made_of].error <= most;
    const bool coarsest =
        row.simplified_in == kNoGroup || pack.groups()[row.simplified_in].error > most;
    if (fine && coarsest) parts.push_back(pack.read(i).mesh);
  }
  return parts;
}

scenes::Mesh joined(const std::vector<scenes::Mesh>& parts) {
  scenes::Mesh all;
  for (const scenes::Mesh& part : parts) {
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
    for (const glm::uvec3& t : part.triangles) all.triangles.push_back(t + first);
  }
  return all;
}

void expect_good_levels(const scenes::Scene& scene) {
  const tests::TemporaryFolder folder;
  write_pack(folder / "a.pack", scene);
  const PackReader pack(folder / "a.pack");
  const std::vector<PageRange>& levels = pack.meshes()[0].levels;
  ASSERT_GE(levels.size(), 4U);

  // A group's error and bounds are no smaller than those of the groups that its pages come from.
  std::vector<float> errors;
  for (const PageRow& row : pack.pages()) {
    if (row.simplified_in == kNoGroup) continue;
    const Group& above = pack.groups()[row.simplified_in];
    errors.push_back(above.error);
    geometry::Box3 bounds = above.bounds;
    bounds.include(row.box);
    if (row.made_of != kNoGroup) {
      const Group& below = pack.groups()[row.made_of];
      EXPECT_GE(above.error, below.error);
      bounds.include(below.bounds);
    }
    EXPECT_EQ(bounds, above.bounds);
  }

  // However cuts are chosen, they have the border of the whole, and are no farther from it than
  // said.
  const std::vector<scenes::Mesh> exact = cut_of(pack, 0);
  const auto border = border_of({scene.meshes[0]});
  const scenes::Mesh whole = joined({scene.meshes[0]});
  std::sort(errors.begin(), errors.end());
  std::size_t last = whole.triangles.size() + 1;
  for (const double part : {0.02, 0.3, 0.6, 0.9, 1.0}) {
    const float most =
        errors[static_cast<std::size_t>(part * static_cast<double>(errors.size() - 1))];
    const std::vector<scenes::Mesh> cut = cut_of(pack, most);
    EXPECT_EQ(border_of(cut), border) << most;
    const scenes::Mesh all = joined(cut);
    EXPECT_LT(all.triangles.size(), last);
    last = all.triangles.size();
    EXPECT_LE(internal::surface_error(whole, all, 0), most);
  }
  EXPECT_LT(last, whole.triangles.size() / 4);
}

TEST(Levels, OfAClosedSurfaceHaveNoCracks) { expect_good_levels(wavy_ball(45)); }

TEST(Levels, OfATerrainKeepItsBorder) { expect_good_levels(scenes::generate("gen:terrain:10000")); }

// What cannot be coarser: pages that no group was made of.
TEST(Levels, GoOnToAFewTriangles) {
  const tests::TemporaryFolder folder;
  constexpr std::uint64_t kAll = 200'000;
  write_pack(folder / "a.pack", scenes::generate("gen:terrain:" + std::to_string(kAll)));
  const PackReader pack(folder / "a.pack");
  std::uint64_t coarsest = 0;
  for (const PageRow& page : pack.pages()) {
    if (page.simplified_in == kNoGroup) coarsest += page.triangles;
  }
  EXPECT_LE(coarsest, kAll / 80);
}

TEST(Levels, OfTrianglesThatShareNothingEndAtOnce) {
  const tests::TemporaryFolder folder;
  scenes::Scene scene = wavy_ball(30);
  scenes::Mesh soup;
  for (const glm::uvec3& t : scene.meshes[0].triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (int k = 0; k < 3; ++k)
      soup.positions.push_back(scene.meshes[0].positions[t[k]] +
                               0.001F * static_cast<float>(first));
    soup.triangles.emplace_back(first, first + 1, first + 2);
  }
  scene.meshes[0] = soup;
  write_pack(folder / "a.pack", scene);
  EXPECT_EQ(PackReader(folder / "a.pack").meshes()[0].levels.size(), 1U);
}

TEST(SurfaceError, IsTwoSidedAndHasAttributes) {
  scenes::Mesh flat;
  flat.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  flat.normals.assign(4, {0, 0, 1});
  flat.triangles = {{0, 1, 2}, {0, 2, 3}};
  scenes::Mesh other = flat;
  EXPECT_NEAR(internal::surface_error(flat, other, 1), 0, 1e-6);
  other.positions[2].z = 0.5F;
  EXPECT_NEAR(internal::surface_error(flat, other, 0), 0.5, 1e-6);
  EXPECT_NEAR(internal::surface_error(other, flat, 0), 0.5, 1e-6);
  other = flat;
  other.triangles.pop_back();  // what is missing is seen from one side only
  EXPECT_NEAR(internal::surface_error(flat, other, 0), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(internal::surface_error(other, flat, 0), std::sqrt(0.5), 1e-6);
  other = flat;
  other.normals[1] = {0, 1, 0};
  EXPECT_NEAR(internal::surface_error(flat, other, 0.1F), 0.1 * std::sqrt(2), 1e-6);
  EXPECT_EQ(internal::surface_error({}, flat, 1), 0);
}

TEST(SurfaceError, AddsWhatLiesBeneathAndLeavesOutWhatIsElsewhere) {
  scenes::Mesh fine;
  fine.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5F, 0.5F, 0.25F}};
  fine.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  scenes::Mesh flat;
  flat.positions.assign(fine.positions.begin(), fine.positions.begin() + 4);
  flat.triangles = {{0, 1, 2}, {0, 2, 3}};
  const internal::SurfaceErrors alone = internal::surface_errors({fine}, flat, 0);
  EXPECT_NEAR(alone.largest, 0.25, 1e-6);
  EXPECT_EQ(alone.triangles.size(), 2U);
  const std::vector<float> before = {0.5F, 0, 0, 0};
  const internal::SurfaceErrors added = internal::surface_errors({fine, before}, flat, 0);
  EXPECT_NEAR(added.largest, 0.75, 1e-6);
  const std::vector<std::uint8_t> measured = {1, 1, 1, 1, 0};
  const internal::SurfaceErrors part = internal::surface_errors({fine, {}, measured}, flat, 0);
  EXPECT_EQ(part.nearest[4], scenes::kNone);
  EXPECT_LT(part.largest,
            0.25F);  // the middle of the flat mesh is nearer to a slope than to the top
  EXPECT_GT(part.largest, 0);
}

TEST(Levels, AreMeasuredAgainstTheFinestOnes) {
  // Of a surface that is as rough at every scale errors would add up over levels.
  const tests::TemporaryFolder folder;
  scenes::Scene scene = scenes::generate("gen:terrain:40000");
  const scenes::Mesh whole = joined({scene.meshes[0]});  // by position alone
  scene.meshes[0].normals.clear();
  scene.meshes[0].colours.clear();
  scene.meshes[0].uvs.clear();
  write_pack(folder / "a.pack", scene);
  const PackReader pack(folder / "a.pack");
  for (const std::size_t level : {1U, 2U, 3U}) {
    const PageRange& range = pack.meshes()[0].levels[level];
    std::vector<scenes::Mesh> parts;
    float said = 0;
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
      parts.push_back(pack.read(i).mesh);
      said = std::max(said, pack.groups()[pack.pages()[i].made_of].error);
    }
    const float measured = internal::surface_error(whole, joined(parts), 0);
    EXPECT_GE(said, measured) << level;
    EXPECT_LE(said, 1.25F * measured) << level;
  }
}

scenes::Scene points_in_a_square(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(0, 1);
  scenes::Scene scene;
  scenes::Mesh mesh;
  mesh.shape.kind = scenes::Shape::Kind::point;
  mesh.shape.in_pixels = false;
  mesh.shape.radius = 0.001F;
  std::vector<glm::vec3> places;
  places.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) places.emplace_back(place(random), place(random), 0);
  for (const std::uint32_t i : internal::order_along_curve(places)) {
    mesh.triangles.emplace_back(mesh.positions.size());
    mesh.positions.push_back(places[i]);
  }
  scene.meshes.push_back(std::move(mesh));
  scene.instances.emplace_back();
  scene.materials.emplace_back();
  return scene;
}

TEST(Levels, OfPointsAreNestedAndCoverAll) {
  const tests::TemporaryFolder folder;
  const scenes::Scene scene = points_in_a_square(100'000, 5);
  write_pack(folder / "a.pack", scene);
  const PackReader pack(folder / "a.pack");
  const std::vector<PageRange>& levels = pack.meshes()[0].levels;
  ASSERT_GE(levels.size(), 10U);
  std::uint64_t before = 100'000;
  double overlapping = 0;
  for (std::size_t level = 1; level < levels.size(); ++level) {
    const PageRange& range = levels[level];
    std::uint64_t points = 0;
    double area = 0;
    std::set<std::uint32_t> groups;
    std::vector<glm::vec3> places;
    float error = 0;
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
      points += pack.pages()[i].triangles;
      const Group& group = pack.groups()[pack.pages()[i].made_of];
      error = std::max(error, group.error);
      if (groups.insert(pack.pages()[i].made_of).second) {
        const glm::vec3 size = group.bounds.size();
        area += static_cast<double>(size.x) * size.y;
      }
      for (const glm::vec3& p : pack.read(i).mesh.positions) places.push_back(p);
    }
    // Bounds reach no farther into each other than pages of the finest level do.
    if (level == 1) overlapping = area;
    EXPECT_LE(area, 1.02 * overlapping) << level;
    // The thinnest cover takes 0.385 for a square of the error; there are some more for borders,
    // and as the largest error counts.
    EXPECT_LE(error * error * static_cast<float>(points), 0.7F) << level;
    const double kept = static_cast<double>(points) / static_cast<double>(before);
    EXPECT_LE(kept, level <= 2 ? 0.57 : 0.805) << level;
    EXPECT_GE(kept, level <= 2 ? 0.41 : 0.58) << level;
    before = points;
    for (std::size_t i = 0; i < scene.meshes[0].positions.size(); i += 997) {
      float nearest = 2;
      for (const glm::vec3& p : places)
        nearest = std::min(nearest, glm::distance(p, scene.meshes[0].positions[i]));
      EXPECT_LE(nearest, error) << level;
    }
  }
  EXPECT_LE(before, 1000U);
}

TEST(Levels, OfPointsAreRefusedWhereTheyDoNotFitTheMemory) {
  const tests::TemporaryFolder folder;
  WriteOptions options;
  options.memory = files::MemoryBudget(1);
  EXPECT_THROW(write_pack(folder / "a.pack", points_in_a_square(20'000, 6), options),
               files::FileError);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.pack"));
  options.memory = files::MemoryBudget(files::resident_set() + (std::uint64_t{64} << 20));
  write_pack(folder / "a.pack", points_in_a_square(20'000, 6), options);
}

TEST(Simplify, KeepsTheBorderAndHalfOfTheTriangles) {
  const scenes::Mesh mesh = scenes::generate("gen:terrain:8000").meshes[0];
  const scenes::Mesh simplified = internal::simplify(mesh);
  EXPECT_EQ(border_of({simplified}), border_of({mesh}));
  EXPECT_LE(simplified.triangles.size(), mesh.triangles.size() / 2 + 1);
}

}  // namespace
}  // namespace delray::packs
