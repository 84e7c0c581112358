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

namespace delray::image {
namespace {

class Io : public testing::Test {
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

Image8 opaque_or_clear(int width, int height) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> code(0, 255);
  Image8 image(width, height);
  clear(image);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    if (i % 3 == 0) continue;
    const auto next = [&] { return static_cast<std::uint8_t>(code(random)); };
    image.colour[i] = {next(), next(), next(), 255};
    image.depth[i] = 0;
  }
  return image;
}

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

void read_everything(const std::filesystem::path& path) {
  read_picture(path);
  read_texels(path);
}

TEST_F(Io, BrokenFilesAreErrorsThatNameThem) {
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

TEST_F(Io, FilesCutShortAreErrors) {
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
TEST_F(Io, DamagedBytesNeverCrash) {
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
TEST_F(Io, InterlacedPalettesAreRead) {
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
TEST_F(Io, DamagedPngIsOneLineAndNothingOnStandardError) {
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

TEST_F(Io, HugeSizesInTheHeaderAreRefusedBeforeAllocation) {
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

TEST_F(Io, CanvasesAreRefusedBeforeTheFileIsOpened) {
  const std::uint64_t before = files::resident_set();
  put("a.gif", std::string("GIF89a\xff\xff\xff\xff\0\0\0,\0\0\0\0\x01\0\x01\0\0", 23));
  const std::string what = expect_file_error(files::Cause::input, path("a.gif"),
                                             [&] { read_everything(path("a.gif")); });
  EXPECT_NE(what.find("65535 x 65535"), std::string::npos) << what;
  EXPECT_LT(files::resident_set(), before + (std::uint64_t{1} << 26));
}

TEST_F(Io, PicturesThatUnpackToTooMuchAreRefusedBeforeAllocation) {
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
