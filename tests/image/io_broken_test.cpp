// Picture files that are cut, damaged or larger than they look: errors that name them, before
// memory is taken.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <string_view>

#include "files/error.h"
#include "files/memory_budget.h"
#include "files/read_file.h"
#include "image/io.h"
#include "tests/image/picture_folder.h"

namespace delray::image {
namespace {

using tests::expect_file_error;
using tests::opaque_or_clear;

class BrokenPictures : public tests::PictureFolder {};

void read_everything(const std::filesystem::path& path) {
  read_picture(path);
  read_texels(path);
}

TEST_F(BrokenPictures, BrokenFilesAreErrorsThatNameThem) {
  expect_file_error(files::Cause::input, path("none.png"), [&] { read_image8(path("none.png")); });
  std::mt19937 random(7);
  for (const char* suffix : {".png", ".exr", ".tif", ".jpg", ".tga", ".hdr", ".webp", ".gif", ""}) {
    const std::string name = std::string("a") + suffix;
    put(name, "");
    expect_file_error(files::Cause::input, path(name), [&] { read_everything(path(name)); });
    std::string garbage(5000, ' ');
    for (char& c : garbage) c = static_cast<char>(random());
    garbage[0] = 'x';
    put(name, garbage);
    expect_file_error(files::Cause::input, path(name), [&] { read_everything(path(name)); });
  }
  const std::byte nothing[1] = {};
  EXPECT_THROW(decode_image8({nothing, 0}, "t"), files::FileError);
  EXPECT_THROW(decode_image8(nothing, "t"), files::FileError);
}

TEST_F(BrokenPictures, FilesCutShortAreErrors) {
  const Image8 image = opaque_or_clear(64, 200);
  for (const char* suffix : {".png", ".exr", ".tif", ".jpg"}) {
    const std::string whole_name = std::string("whole") + suffix,
                      name = std::string("cut") + suffix;
    write_image(path(whole_name), image);
    const std::string whole = files::read_file(path(whole_name));
    for (const std::size_t size :
         {std::size_t{4}, std::size_t{9}, std::size_t{40}, std::size_t{200}, whole.size() / 4,
          whole.size() / 2, whole.size() * 9 / 10}) {
      SCOPED_TRACE(name + " " + std::to_string(size));
      put(name, whole.substr(0, size));
      expect_file_error(files::Cause::input, path(name), [&] { read_picture(path(name)); });
      expect_file_error(files::Cause::input, path(name), [&] { read_texels(path(name)); });
      expect_file_error(files::Cause::input, path(name), [&] { read_float_channels(path(name)); });
    }
  }
}

// Any result or a FileError, but no crash and no other exception.
TEST_F(BrokenPictures, DamagedBytesNeverCrash) {
  std::mt19937 random(8);
  for (const char* suffix : {".png", ".exr", ".tif", ".jpg"}) {
    const std::string name = std::string("a") + suffix;
    write_image(path(name), opaque_or_clear(20, 20));
    const std::string whole = files::read_file(path(name));
    for (int k = 0; k < 60; ++k) {
      std::string damaged = whole;
      for (int flips = 0; flips < 4; ++flips) {
        const std::size_t range =
            k % 2 == 0 ? std::min<std::size_t>(400, whole.size()) : whole.size();
        damaged[random() % range] = static_cast<char>(random());
      }
      put(name, damaged);
      try {
        read_everything(path(name));
      } catch (const files::FileError& error) {
        EXPECT_EQ(error.file(), path(name).string());
      }
    }
  }
}

std::string from_hex(std::string_view digits) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    bytes.push_back(static_cast<char>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16)));
  }
  return bytes;
}

const std::string kPng = "89504e470d0a1a0a0000000d49484452";  // and what the header says

// 5 x 3 pixels of a palette, two bits each, interlaced.
TEST_F(BrokenPictures, InterlacedPalettesAreRead) {
  put("a.png",
      from_hex(kPng + "00000005000000030203000001515f1dfd0000000c504c5445000000ff000000ff000000ff"
                      "9bc013dc000000154944415478da6360008206860e8602860b0c390e00104702f5b2b6abbe"
                      "0000000049454e44ae426082"));
  const Texels texels = read_texels(path("a.png"));
  ASSERT_EQ(texels.width, 5);
  ASSERT_EQ(texels.height, 3);
  EXPECT_EQ(texels.texels[0], (Rgba8{0, 0, 0, 255}));
  EXPECT_EQ(texels.texels[1], (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(texels.texels[14], (Rgba8{0, 255, 0, 255}));
}

// libpng would write to standard error.
TEST_F(BrokenPictures, DamagedPngIsOneLineAndNothingOnStandardError) {
  const std::string end = "0000000049454e44ae426082";
  write_image(path("whole.png"), opaque_or_clear(64, 64));
  const std::string whole = files::read_file(path("whole.png"));
  std::string flipped = whole;
  flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 1);
  const std::vector<std::pair<std::string, std::string>> files = {
      {"has no header", whole.substr(0, 8) + "abcabcabcabcabcabcabcabcabcabc"},
      {"ends early", whole.substr(0, whole.size() / 2)},
      {"checksum", flipped},
      {"no pixels", from_hex(kPng +
                             "000000000000000008000000001ee023ce000000084944415478da03000000"
                             "00016fddc991" +
                             end)},
      {"lacks pixels", from_hex(kPng +
                                "000000040000000408000000008c9ac1a20000000d4944415478da63606462"
                                "6601000019000b380454b4" +
                                end)},
      {"row of pixels", from_hex(kPng +
                                 "00000002000000010800000000d14920560000000b4944415478da636764"
                                 "0200001c000b6fe4ccd6" +
                                 end)},
      {"no palette", from_hex(kPng +
                              "00000002000000010803000000c3fc8fb80000000b4944415478da63606000"
                              "00000300012b094d84" +
                              end)},
      {"unknown kind", from_hex(kPng +
                                "000000020000000103020000000c90d9cc0000000b4944415478da6360600000"
                                "000300012b094d84" +
                                end)}};
  for (const auto& [why, content] : files) {
    SCOPED_TRACE(why);
    put("a.png", content);
    testing::internal::CaptureStderr();
    const std::string what =
        expect_file_error(files::Cause::input, path("a.png"), [&] { read_texels(path("a.png")); });
    EXPECT_THROW(decode_image8(std::as_bytes(std::span(content)), "t"), files::FileError);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_NE(what.find(why), std::string::npos) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
  }
}

TEST_F(BrokenPictures, HugeSizesInTheHeaderAreRefusedBeforeAllocation) {
  write_image(path("a.png"), opaque_or_clear(4, 4));
  std::string png = files::read_file(path("a.png"));
  // Width and height of the IHDR chunk at byte 16; its checksum is then wrong, too.
  png.replace(16, 8, std::string("\x00\x10\x00\x00\x00\x10\x00\x00", 8));
  put("a.png", png);
  expect_file_error(files::Cause::input, path("a.png"), [&] { read_everything(path("a.png")); });
  put("a.pgm", "P5 1000000 1000000 255\n abc");
  const std::string what = expect_file_error(files::Cause::input, path("a.pgm"),
                                             [&] { read_everything(path("a.pgm")); });
  EXPECT_NE(what.find("1000000 x 1000000"), std::string::npos) << what;
}

TEST_F(BrokenPictures, CanvasesAreRefusedBeforeTheFileIsOpened) {
  const std::uint64_t before = files::resident_set();
  put("a.gif", std::string("GIF89a\xff\xff\xff\xff\0\0\0,\0\0\0\0\x01\0\x01\0\0", 23));
  const std::string what = expect_file_error(files::Cause::input, path("a.gif"),
                                             [&] { read_everything(path("a.gif")); });
  EXPECT_NE(what.find("65535 x 65535"), std::string::npos) << what;
  EXPECT_LT(files::resident_set(), before + (std::uint64_t{1} << 26));
}

TEST_F(BrokenPictures, PicturesThatUnpackToTooMuchAreRefusedBeforeAllocation) {
  Image8 image(3000, 3000);
  clear(image, Rgba8{9, 9, 9, 255});
  for (const char* suffix : {".png", ".exr", ".tif", ".jpg"}) {
    const auto file = path(std::string("a") + suffix);
    write_image(file, image);
    const std::uint64_t before = files::resident_set();
    const files::MemoryBudget little(before + (std::uint64_t{1} << 25));
    const std::string bytes = files::read_file(file);
    expect_file_error(files::Cause::memory, file, [&] { read_picture(file, little); });
    expect_file_error(files::Cause::memory, file, [&] { read_texels(file, little); });
    expect_file_error(files::Cause::memory, file, [&] { read_float_channels(file, little); });
    expect_file_error(files::Cause::memory, "t",
                      [&] { decode_image8(std::as_bytes(std::span(bytes)), "t", little); });
    EXPECT_LT(files::resident_set(), before + (std::uint64_t{1} << 25)) << suffix;
    EXPECT_EQ(read_texels(file).width, 3000);
  }
}

}  // namespace
}  // namespace delray::image
