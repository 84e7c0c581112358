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

const std::string kMark(32, 'a');
const Resumed kResumed{kMark, {16, 32, 70, 75}, 64};

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
  void SetUp() override { save_checkpoint(path_, kMark, exposed()); }
  void TearDown() override { fs::remove(path_); }
  fs::path path_ = fs::path(testing::TempDir()) / "checkpoint_test.film";
};

TEST_F(Checkpoint, ComesBackBitByBit) {
  const Film film = exposed(), loaded = load_checkpoint(path_, kResumed);
  EXPECT_EQ(loaded.window(), film.window());
  EXPECT_EQ(std::memcmp(loaded.pixels().data(), film.pixels().data(), film.pixels().size_bytes()),
            0);
  EXPECT_EQ(std::memcmp(loaded.costs().data(), film.costs().data(), film.costs().size_bytes()), 0);
  EXPECT_EQ(loaded.total_samples(), film.total_samples());
}

TEST_F(Checkpoint, OfAnotherRenderingIsRefused) {
  EXPECT_THROW(load_checkpoint(path_, {std::string(32, 'b'), kResumed.window, 64}),
               files::FileError);
  EXPECT_THROW(load_checkpoint(path_.string() + ".none", kResumed), files::FileError);
}

TEST_F(Checkpoint, DamageIsFound) {
  const auto size = fs::file_size(path_);
  for (const std::uintmax_t at : {std::uintmax_t{3}, std::uintmax_t{60}, size / 2, size - 1}) {
    save_checkpoint(path_, kMark, exposed());
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(at));
    const int byte = file.get();
    file.seekp(static_cast<std::streamoff>(at));
    file.put(static_cast<char>(byte ^ 0x10));
    file.close();
    EXPECT_THROW(load_checkpoint(path_, kResumed), files::FileError) << at;
  }
  for (const std::uintmax_t length : {std::uintmax_t{0}, std::uintmax_t{40}, size - 5}) {
    fs::resize_file(path_, length);
    EXPECT_THROW(load_checkpoint(path_, kResumed), files::FileError) << length;
    save_checkpoint(path_, kMark, exposed());
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
    save_checkpoint(path_, kMark, film);
    EXPECT_THROW(load_checkpoint(path_, kResumed), files::FileError) << i;
  }
  Film film = exposed();
  for (std::uint32_t& samples : film.samples()) samples = 64;
  save_checkpoint(path_, kMark, film);
  EXPECT_NO_THROW(load_checkpoint(path_, kResumed));
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
