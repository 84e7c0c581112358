#include "composite/write_parts.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "comm/threads.h"
#include "composite/codec.h"
#include "composite/scheme.h"
#include "files/error.h"
#include "image/io.h"

namespace delray::composite {
namespace {

using image::ImageF;

// Rank k covers every pixel that k + 1 divides, nearer than the ranks before.
ImageF partial_image(int rank, int width, int height) {
  ImageF image(width, height);
  clear(image);
  const auto step = static_cast<std::size_t>(rank) + 1;
  for (std::size_t i = 0; i < image.pixels(); i += step) {
    image.colour[i] = {static_cast<float>(rank + 1) / 16, static_cast<float>(i) / 65536, 0.25F, 1};
    image.depth[i] = 10.0F - static_cast<float>(rank);
  }
  return image;
}

TEST(WriteParts, GivesTheGatheredPicture) {
  const auto folder = std::filesystem::temp_directory_path() / "delray_write_parts_test";
  std::filesystem::create_directories(folder);
  const std::filesystem::path path = folder / "whole.exr";
  struct Size {
    int width, height;
  };
  for (const Size size : {Size{1, 1}, {7, 3}, {130, 150}}) {
    for (const char* scheme : {"direct-send", "binary-swap", "tiles", "centralized"}) {
      for (const int ranks : {1, 3, 6}) {
        SCOPED_TRACE(std::string(scheme) + ", " + std::to_string(ranks));
        std::filesystem::remove(path);
        ImageF expected;
        comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
          auto layer = find_codec("active")->make(
              partial_image(communicator.rank(), size.width, size.height));
          OwnedPixels part = compose(communicator, std::move(layer), scheme,
                                     {.interlace = std::string(scheme) == "direct-send"});
          write_parts(communicator, part, path);
          part = gather(communicator, std::move(part), 0);
          if (communicator.rank() == 0) expected = take_image<image::RgbaF>(std::move(part));
        });
        const ImageF written = image::read_image_float(path);
        ASSERT_EQ(written.width, size.width);
        ASSERT_EQ(written.height, size.height);
        for (std::size_t i = 0; i < written.pixels(); ++i) {
          ASSERT_EQ(written.colour[i], expected.colour[i]) << i;
          ASSERT_EQ(written.depth[i], expected.depth[i]) << i;
        }
      }
    }
  }
  std::filesystem::remove_all(folder);
}

TEST(WriteParts, LeavesNothingWhereItCannotWrite) {
  EXPECT_THROW(
      comm::run_threads(3, 1,
                        [&](comm::Communicator& communicator) {
                          auto layer =
                              find_codec("dense")->make(partial_image(communicator.rank(), 20, 20));
                          const OwnedPixels part = compose(communicator, std::move(layer), "tree");
                          write_parts(communicator, part, "/nonexistent/folder/a.exr");
                        }),
      files::FileError);
}

}  // namespace
}  // namespace delray::composite
