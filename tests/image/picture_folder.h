// A folder for the picture files of a test, and what tests of reading and writing them share.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "files/error.h"
#include "image/image.h"

namespace delray::tests {

class PictureFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("delray_io_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), {}));
  }
  void put(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

 private:
  std::filesystem::path folder_;
};

// Every third pixel is clear.
inline image::Image8 opaque_or_clear(int width, int height) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> code(0, 255);
  image::Image8 picture(width, height);
  clear(picture);
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    if (i % 3 == 0) continue;
    const auto next = [&] { return static_cast<std::uint8_t>(code(random)); };
    picture.colour[i] = {next(), next(), next(), 255};
    picture.depth[i] = 0;
  }
  return picture;
}

// Expects f to throw FileError of this cause that names the file; returns the message.
template <class F>
std::string expect_file_error(files::Cause cause, const std::filesystem::path& path, F&& f) {
  try {
    f();
  } catch (const files::FileError& error) {
    EXPECT_EQ(error.cause(), cause) << error.what();
    EXPECT_EQ(error.file(), path.string());
    return error.what();
  }
  ADD_FAILURE() << "no FileError for " << path;
  return {};
}

}  // namespace delray::tests
