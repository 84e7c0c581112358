// Picture files: pixels, attributes and channels that come back as they were written.
#include "image/io.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <thread>
#include <utility>

#include "files/error.h"
#include "files/read_file.h"
#include "image/compare.h"
#include "image/srgb.h"
#include "tests/image/picture_folder.h"

namespace delray::image {
namespace {

using tests::expect_file_error;
using tests::opaque_or_clear;

class Io : public tests::PictureFolder {};

ImageF random_float(int width, int height) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> value(0, 4);
  ImageF image(width, height);
  clear(image);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    if (i % 4 == 0) continue;
    image.colour[i] = {value(random), value(random), value(random), value(random) / 4};
    image.depth[i] = value(random);
  }
  return image;
}

TEST_F(Io, LosslessFormatsReturnOpaqueAndClearPixels) {
  const Image8 image = opaque_or_clear(37, 70);
  for (const char* name : {"a.png", "a.tif", "a.TIFF", "a.exr"}) {
    write_image(path(name), image);
    const Image8 back = read_image8(path(name));
    ASSERT_EQ(back.width, 37);
    ASSERT_EQ(back.height, 70);
    EXPECT_TRUE(compare(image, back).equal()) << name;
  }
  EXPECT_EQ(files(), 4U);
}

TEST_F(Io, PngHoldsStraightAlphaWithinOneCodeOfIt) {
  Image8 image(256, 1);
  for (std::size_t a = 0; a < 256; ++a) {
    const float alpha = decode_alpha(static_cast<std::uint8_t>(a));
    image.colour[a] = to_8bit(RgbaF{alpha, 0.5F * alpha, 0, alpha});
    image.depth[a] = a == 0 ? kEmptyDepth : 0;
  }
  write_image(path("a.png"), image);
  const Texels texels = read_texels(path("a.png"));
  ASSERT_EQ(texels.texels.size(), 256U);
  for (std::size_t a = 1; a < 256; ++a) {
    const Rgba8 texel = texels.texels[a];
    EXPECT_EQ(texel.a, a);
    EXPECT_GE(texel.r, a > 8 ? 252 : 240) << a;
    EXPECT_EQ(texel.b, 0);
  }
  EXPECT_LE(compare(image, read_image8(path("a.png"))).max_channel_difference, 1);
}

TEST_F(Io, ExrReturnsFloatsChannelsAndAttributes) {
  const ImageF image = random_float(33, 65);
  std::vector<Channel> channels(2);
  channels[0] = {"albedo.R", std::vector<float>(image.pixels(), 0.25F)};
  channels[1] = {"id", std::vector<float>(image.pixels())};
  for (std::size_t i = 0; i < image.pixels(); ++i) channels[1].values[i] = static_cast<float>(i);
  const std::vector<Attribute> attributes = {{"delray:scene", "bunny.obj"}, {"delray:time", 0.1}};
  WriteOptions options;
  options.channels = channels;
  options.attributes = attributes;
  write_image(path("a.exr"), image, options);
  const Picture back = read_picture(path("a.exr"));
  EXPECT_TRUE(compare(image, back.image).equal());
  ASSERT_EQ(back.channels.size(), 2U);
  for (const Channel& channel : back.channels) {
    const Channel& expected = channel.name == "id" ? channels[1] : channels[0];
    EXPECT_EQ(channel.name, expected.name);
    EXPECT_EQ(channel.values, expected.values);
  }
  for (const Attribute& attribute : attributes) {
    EXPECT_NE(std::find(back.attributes.begin(), back.attributes.end(), attribute),
              back.attributes.end())
        << attribute.name;
  }
  EXPECT_TRUE(compare(image, read_image_float(path("a.exr"))).equal());
  EXPECT_TRUE(compare(to_8bit(image), read_image8(path("a.exr"))).equal());
}

TEST_F(Io, HalfRoundsColourOnly) {
  const ImageF image = random_float(9, 9);
  WriteOptions options;
  options.half = true;
  write_image(path("a.exr"), image, options);
  const ImageF back = read_image_float(path("a.exr"));
  const Comparison difference = compare(image, back);
  EXPECT_GT(difference.max_channel_difference, 0);
  EXPECT_LT(difference.max_channel_difference, 4.0 / 2048);
  EXPECT_EQ(difference.depth_differs, 0U);
}

TEST_F(Io, PngKeepsTextAttributes) {
  const std::vector<Attribute> attributes = {
      {"scene", "a view"}, {"view", "S\xc3\xa4ule"}, {"frames", 3.0}};
  WriteOptions options;
  options.attributes = attributes;
  write_image(path("a.png"), opaque_or_clear(2, 2), options);
  const auto back = read_info(path("a.png")).attributes;
  for (int i = 0; i < 2; ++i) EXPECT_NE(std::ranges::find(back, attributes[i]), back.end()) << i;
}

TEST_F(Io, JpegIsThePictureOverBlack) {
  Image8 image(64, 64);
  clear(image, Rgba8{100, 150, 200, 128});
  write_image(path("a.jpg"), image);
  const Image8 back = read_image8(path("a.jpg"));
  for (const Rgba8& c : back.colour.span()) {
    EXPECT_NEAR(c.r, 100, 3);
    EXPECT_NEAR(c.g, 150, 3);
    EXPECT_NEAR(c.b, 200, 3);
    EXPECT_EQ(c.a, 255);
  }
}

TEST_F(Io, FloatPicturesAreCodedForPng) {
  const ImageF image = random_float(20, 20);
  write_image(path("f.png"), image);
  write_image(path("8.png"), to_8bit(image));
  EXPECT_TRUE(files::read_file(path("f.png")) == files::read_file(path("8.png")));
}

TEST_F(Io, InfoTellsWhatTheHeaderSays) {
  write_image(path("a.exr"), random_float(7, 3));
  const PictureInfo info = read_info(path("a.exr"));
  EXPECT_EQ(info.width, 7);
  EXPECT_EQ(info.height, 3);
  EXPECT_EQ(info.format, "openexr");
  EXPECT_EQ(info.type, "float");
  EXPECT_EQ(info.channels, (std::vector<std::string>{"R", "G", "B", "A", "Z"}));
}

TEST_F(Io, ContentDecidesOverTheSuffix) {
  const Image8 image = opaque_or_clear(5, 5);
  write_image(path("a.png"), image);
  std::filesystem::rename(path("a.png"), path("a.jpg"));
  EXPECT_TRUE(compare(image, read_image8(path("a.jpg"))).equal());
  EXPECT_EQ(read_info(path("a.jpg")).format, "png");
}

TEST_F(Io, EncodedTexelsAreDecodedUnchanged) {
  std::vector<Rgba8> texels(15 * 4);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const auto code = static_cast<std::uint8_t>(4 * i);
    texels[i] = {code, static_cast<std::uint8_t>(255 - code), 7, code};
  }
  const auto bytes = encode_png(15, 4, texels);
  const Texels back = decode_image8(bytes, "texture 0");
  EXPECT_EQ(back.width, 15);
  EXPECT_EQ(back.height, 4);
  EXPECT_EQ(back.texels, texels);
}

TEST_F(Io, PicturesMayBeMoreThanAMillionPixelsWide) {
  const std::vector<Rgba8> texels(1'000'001);
  EXPECT_GT(encode_png(1'000'001, 1, texels).size(), 100U);
  EXPECT_GT(encode_png(1, 1'000'001, texels).size(), 100U);
}

TEST_F(Io, DecodesJpegFromMemory) {
  Image8 image(8, 8);
  clear(image, Rgba8{200, 100, 50, 255});
  write_image(path("a.jpg"), image);
  const std::string file = files::read_file(path("a.jpg"));
  const Texels back = decode_image8(std::as_bytes(std::span(file)), "texture");
  ASSERT_EQ(back.texels.size(), 64U);
  EXPECT_NEAR(back.texels[9].g, 100, 3);
  EXPECT_EQ(back.texels[9].a, 255);
}

// Writes one grey channel of 16 bits.
void write_16_bits(const std::filesystem::path& path, int width, int height,
                   const std::vector<std::uint16_t>& values) {
  const auto output = OIIO::ImageOutput::create(path.string());
  ASSERT_TRUE(output);
  ASSERT_TRUE(
      output->open(path.string(), OIIO::ImageSpec(width, height, 1, OIIO::TypeDesc::UINT16)));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT16, values.data()));
  ASSERT_TRUE(output->close());
}

TEST_F(Io, RawChannelsAreTheNumbersOfTheFile) {
  for (const char* name : {"16.png", "16.tif"}) {
    write_16_bits(path(name), 3, 1, {0, 258, 65535});
    const RawChannels wide = read_float_channels(path(name));
    EXPECT_EQ(wide.channels.size(), 1U);
    EXPECT_EQ(wide.values, (std::vector<double>{0, 258, 65535})) << name;
  }
  Image8 image(2, 1);
  clear(image);
  image.colour[0] = {1, 134, 16, 255};
  image.colour[1] = {1, 2, 3, 255};
  write_image(path("a.png"), image);
  const RawChannels codes = read_float_channels(path("a.png"));
  EXPECT_EQ(codes.values, (std::vector<double>{1, 134, 16, 255, 1, 2, 3, 255}));
  ImageF heights(1, 1);
  clear(heights, RgbaF{-3776.25F, 1e-30F, 0, 1});
  write_image(path("a.exr"), heights);
  EXPECT_EQ(read_float_channels(path("a.exr")).values[0], -3776.25);
}

TEST_F(Io, DecodesSixteenBitsBetweenTheCodes) {
  write_16_bits(path("a.png"), 2, 1, {0x8080, 0x8000});
  const ImageF image = read_image_float(path("a.png"));
  EXPECT_EQ(image.colour[0].r, image.colour[0].g);
  EXPECT_NEAR(image.colour[0].r, decode_srgb(128), 1e-7);
  EXPECT_LT(image.colour[1].r, image.colour[0].r);
  EXPECT_GT(image.colour[1].r, decode_srgb(127));
  EXPECT_EQ(image.colour[0].a, 1);
  EXPECT_EQ(image.depth[0], 0);
}

TEST_F(Io, SameCallWritesTheSameBytes) {
  const Image8 image = opaque_or_clear(12, 12);
  for (const char* suffix : picture_suffixes()) {
    write_image(path(std::string("a") + suffix), image);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // dates in headers have seconds
  for (const char* suffix : picture_suffixes()) {
    write_image(path(std::string("b") + suffix), image);
    EXPECT_TRUE(files::read_file(path(std::string("a") + suffix)) ==
                files::read_file(path(std::string("b") + suffix)))
        << suffix;
  }
}

TEST_F(Io, UnknownSuffixIsRefusedWithTheKnownOnes) {
  const std::string what = expect_file_error(files::Cause::device, path("a.xyz"), [&] {
    write_image(path("a.xyz"), opaque_or_clear(1, 1));
  });
  for (const char* suffix : picture_suffixes()) EXPECT_NE(what.find(suffix), std::string::npos);
  EXPECT_EQ(files(), 0U);
  EXPECT_TRUE(is_picture_suffix("x/y.PNG"));
  EXPECT_FALSE(is_picture_suffix("png"));
}

TEST_F(Io, FailedWritingLeavesNothingBehind) {
  for (const char* suffix : picture_suffixes()) {
    const auto target = path("missing") / (std::string("a") + suffix);
    const std::string what = expect_file_error(files::Cause::device, target,
                                               [&] { write_image(target, opaque_or_clear(1, 1)); });
    EXPECT_EQ(what.find(".part"), std::string::npos) << what;
  }
  EXPECT_EQ(files(), 0U);
}

TEST_F(Io, ReadsPicturesFromPipes) {
  const Image8 image = opaque_or_clear(20, 10);
  for (const char* suffix : {".png", ".exr", ".tif", ".jpg"}) {
    const auto file = path(std::string("a") + suffix), pipe = path(std::string("pipe") + suffix);
    write_image(file, image);
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const std::jthread writer([&] { std::ofstream(pipe) << files::read_file(file); });
    EXPECT_EQ(read_info(pipe).width, 20);
    EXPECT_EQ(read_texels(pipe).texels, read_texels(file).texels);
  }
}

TEST_F(Io, ReadsElevationsOfARealFile) {
  const std::filesystem::path file =
      std::filesystem::path(DELRAY_SHARED_DATA) / "fuji-terrain-rgb.png";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
  const RawChannels raw = read_float_channels(file);
  ASSERT_EQ(raw.width, 512);
  ASSERT_EQ(raw.height, 512);
  ASSERT_GE(raw.channels.size(), 3U);
  double highest = -1e9;
  for (std::size_t i = 0; i < raw.values.size(); i += raw.channels.size()) {
    const double height =
        -10000 + (raw.values[i] * 65536 + raw.values[i + 1] * 256 + raw.values[i + 2]) / 10;
    highest = std::max(highest, height);
  }
  EXPECT_NEAR(highest, 3776, 30);  // metres; Fuji
}

}  // namespace
}  // namespace delray::image
