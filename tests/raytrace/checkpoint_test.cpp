#include "raytrace/checkpoint.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include "files/error.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

namespace fs = std::filesystem;

const Rendering kRendering{
    std::string(32, 'a'), {{"--depth", "8"}, {"--seed", "0"}}, {16, 32, 70, 75}, 64, true};

Rendering with_samples(int samples, bool any_samples = true) {
  Rendering rendering = kRendering;
  rendering.samples = samples;
  rendering.any_samples = any_samples;
  return rendering;
}

Film exposed() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit;
  Film film({16, 32, 70, 75});
  for (PixelSum& sum : film.pixels()) sum = {{unit(random), 1, 2, 3}, unit(random), unit(random)};
  for (CellCost& cost : film.costs()) cost = {unit(random), unit(random)};
  for (std::uint32_t& samples : film.samples()) samples = 12;
  return film;
}

class Checkpoint : public testing::Test {
 protected:
  void SetUp() override { save_checkpoint(path_, kRendering, exposed()); }
  void TearDown() override { fs::remove(path_); }
  std::string refusal(const Rendering& rendering) const {
    try {
      load_checkpoint(path_, rendering);
    } catch (const files::FileError& error) {
      EXPECT_EQ(error.cause(), files::Cause::input);
      return error.what();
    }
    return "";
  }
  fs::path path_ =
      fs::path(testing::TempDir()) /
      (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".film");
};

TEST_F(Checkpoint, ComesBackBitByBit) {
  const Film film = exposed(), loaded = load_checkpoint(path_, kRendering);
  EXPECT_EQ(loaded.window(), film.window());
  EXPECT_EQ(std::memcmp(loaded.pixels().data(), film.pixels().data(), film.pixels().size_bytes()),
            0);
  EXPECT_EQ(std::memcmp(loaded.costs().data(), film.costs().data(), film.costs().size_bytes()), 0);
  EXPECT_EQ(loaded.total_samples(), film.total_samples());
}

TEST_F(Checkpoint, OfAnotherRenderingIsRefused) {
  EXPECT_THROW(load_checkpoint(path_.string() + ".none", kRendering), files::FileError);
  Rendering other = kRendering;
  other.scene[0] = 'b';
  EXPECT_NE(refusal(other).find("another scene"), std::string::npos) << refusal(other);
  other.values = {{"--depth", "2"}, {"--seed", "1"}};
  EXPECT_NE(refusal(other).find("--depth 8 there, 2 here; --seed 0 there, 1 here"),
            std::string::npos)
      << refusal(other);
  other = kRendering;
  other.values.push_back({"--light", "none"});
  EXPECT_NE(refusal(other).find("--light nothing there, none here"), std::string::npos);
}

// Each pixel has 12 samples, three whole chunks.
TEST_F(Checkpoint, GoesOnToAnotherNumberOfSamplesWhereTheyAreTheSame) {
  for (const int samples : {12, 13, 16, 64, 1000}) {
    EXPECT_EQ(refusal(with_samples(samples)), "") << samples;
  }
  EXPECT_NE(refusal(with_samples(8)).find("--spp 64 there, 8 here: there are 12 samples"),
            std::string::npos)
      << refusal(with_samples(8));
  EXPECT_NE(refusal(with_samples(128, false)).find("--spp 64 there, 128 here: samples lie on"),
            std::string::npos);
  Film film = exposed();
  for (std::uint32_t& samples : film.samples()) samples = 10;
  save_checkpoint(path_, with_samples(10), film);
  EXPECT_EQ(refusal(with_samples(10)), "");
  EXPECT_NE(refusal(with_samples(64)).find("--spp 10 there, 64 here: "), std::string::npos);
}

TEST_F(Checkpoint, IsToldFromOtherFiles) {
  EXPECT_TRUE(is_checkpoint(path_));
  EXPECT_FALSE(is_checkpoint(path_.string() + ".none"));
  EXPECT_FALSE(is_checkpoint(testing::TempDir()));
  std::ofstream(path_) << "delray picture";
  EXPECT_FALSE(is_checkpoint(path_));
  std::ofstream(path_) << "delray film 1\n";
  EXPECT_TRUE(is_checkpoint(path_));
  EXPECT_NE(refusal(kRendering).find("another version"), std::string::npos);
}

TEST_F(Checkpoint, DamageIsFound) {
  const auto size = fs::file_size(path_);
  for (const std::uintmax_t at : {std::uintmax_t{3}, std::uintmax_t{60}, size / 2, size - 1}) {
    save_checkpoint(path_, kRendering, exposed());
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(at));
    const int byte = file.get();
    file.seekp(static_cast<std::streamoff>(at));
    file.put(static_cast<char>(byte ^ 0x10));
    file.close();
    EXPECT_THROW(load_checkpoint(path_, kRendering), files::FileError) << at;
  }
  for (const std::uintmax_t length : {std::uintmax_t{0}, std::uintmax_t{40}, size - 5}) {
    fs::resize_file(path_, length);
    EXPECT_THROW(load_checkpoint(path_, kRendering), files::FileError) << length;
    save_checkpoint(path_, kRendering, exposed());
  }
}

// The checksum is right: only the film is none that a rendering could have left.
TEST_F(Checkpoint, OfAnImpossibleFilmIsRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::function<void(Film&)>> faults = {
      [](Film& film) {
        film = Film({16, 32, 70, 60});
      },
      [](Film& film) {
        film = Film({0, 0, 1 << 20, 0});
      },
      [](Film& film) { film = Film(); },
      [](Film& film) { film.samples()[3] = 65; },
      [](Film& film) { film.samples()[3] = 13; },
      [](Film& film) { film.samples()[3] = 0xFFFFFFFFU; },
      [](Film& film) { film.samples()[3] = 0; },
      [=](Film& film) { film.costs()[2].rays = nan; },
      [](Film& film) { film.costs()[2].seconds = -1.0F; },
      [=](Film& film) { film.pixels()[700].colour.g = nan; },
      [=](Film& film) { film.pixels()[700].depth = nan; },
      [](Film& film) { film.pixels()[700].squares = -1.0F; },
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    Film film = exposed();
    faults[i](film);
    save_checkpoint(path_, kRendering, film);
    EXPECT_THROW(load_checkpoint(path_, kRendering), files::FileError) << i;
  }
  Film film = exposed();
  for (std::uint32_t& samples : film.samples()) samples = 64;
  save_checkpoint(path_, kRendering, film);
  EXPECT_NO_THROW(load_checkpoint(path_, kRendering));
}

TEST(Fingerprint, ChangesWithWhatPicturesDependOn) {
  scenes::Scene scene;
  add(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  const std::string plain = fingerprint(scene, "spp 4");
  EXPECT_EQ(plain.size(), 32U);
  EXPECT_EQ(plain, fingerprint(scene, "spp 4"));
  EXPECT_NE(plain, fingerprint(scene, "spp 8"));
  scene.materials[0].roughness = 0.1F;
  const std::string rough = fingerprint(scene, "spp 4");
  EXPECT_NE(plain, rough);
  scene.meshes[0].positions[0].x = 0.5F;
  EXPECT_NE(rough, fingerprint(scene, "spp 4"));
}

}  // namespace
}  // namespace delray::raytrace
