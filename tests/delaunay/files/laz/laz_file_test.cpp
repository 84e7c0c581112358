// LAZ files read the same points as the LAS files that they were made of, and damaged ones are
// refused.
#include "delaunay/files/laz/laz_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "delaunay/files/point_readers.h"
#include "tests/delaunay/files/laz/laz_encoder.h"

namespace delray::tests {
namespace {

using delaunay::PointCloud;

PointCloud read(const std::string& content) { return delaunay::read_las_points({"test", content}); }

std::string complaint(const std::string& content) {
  try {
    read(content);
  } catch (const files::FileError& error) {
    return error.what();
  }
  return "";
}

template <class T>
void put_at(char* record, std::size_t at, T value) {
  std::memcpy(record + at, &value, sizeof value);
}

// Random records of pulses with one to five returns: flight lines with steady steps, jumps over the
// whole range of coordinates, several scanner channels, times that go on, stand still, go back and
// change lines.
class Pulses {
 public:
  Pulses(unsigned format, std::uint64_t seed) : format_(format), random_(seed) {}

  std::string records(std::size_t count, std::size_t size) {
    std::string bytes(count * size, '\0');
    for (std::size_t i = 0; i < count; ++i) {
      if (number_ >= count_) next_pulse();
      ++number_;
      next_record(bytes.data() + i * size, size);
    }
    return bytes;
  }

 private:
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  bool once_in(int n) { return below(n) == 0; }
  std::uint32_t any() { return static_cast<std::uint32_t>(random_()); }

  void next_pulse() {
    number_ = 0;
    count_ = once_in(3) ? 1 + below(5) : 1;
    x_ += 100 + static_cast<std::uint32_t>(below(7));
    y_ += static_cast<std::uint32_t>(below(3) - 1);
    if (once_in(50)) x_ = any();
    if (once_in(50)) y_ = any();
    constexpr std::int64_t kSteps[] = {7,  7,  7,   7,   7,    0,       14,
                                       70, -7, -40, -90, 5000, 7 * 500, 7 * 600};
    time_ += kSteps[below(14)] * (once_in(40) ? 1000 : 1);
    if (once_in(30)) time_ += std::int64_t{below(5) - 2} << 33;
    if (once_in(10)) channel_ = static_cast<unsigned>(below(4));
  }

  void next_record(char* record, std::size_t size) {
    put_at(record, 0, x_ + static_cast<std::uint32_t>(number_));
    put_at(record, 4, y_ - static_cast<std::uint32_t>(number_));
    put_at(record, 8,
           once_in(100) ? any() : 500U - 20 * static_cast<unsigned>(number_) + any() % 4);
    put_at(record, 12, static_cast<std::uint16_t>(once_in(3) ? any() : 200 + below(4)));
    const auto number = static_cast<unsigned>(number_), count = static_cast<unsigned>(count_);
    std::size_t end = 20;
    if (format_ >= 6) {
      record[14] = static_cast<char>(number | count << 4);
      record[15] = static_cast<char>(channel_ << 4 | (any() & 0xcf));
      record[16] = static_cast<char>(once_in(5) ? below(256) : 2);
      put_at(record, 22, time_);
      end = 30;
    } else {
      record[14] = static_cast<char>(number | count << 3 | (once_in(9) ? any() & 0xc0 : 0));
      record[15] = static_cast<char>(once_in(5) ? below(256) : 2);
      record[16] = static_cast<char>(below(20));
      record[17] = static_cast<char>(once_in(7) ? below(256) : 0);
      put_at(record, 18, static_cast<std::uint16_t>(once_in(20) ? below(65536) : 3));
      if (format_ == 1 || format_ == 3) {
        put_at(record, 20, time_);
        end = 28;
      }
    }
    if (format_ == 2 || format_ == 3 || format_ >= 7) {
      for (int k = 0; k < 3; ++k) {
        if (!once_in(3)) colour_[k] = static_cast<std::uint16_t>(any());
        if (once_in(4)) colour_[k] = colour_[0];
      }
      if (once_in(4)) colour_[1] = colour_[2] = colour_[0];
      std::memcpy(record + end, colour_, sizeof colour_);
      end += sizeof colour_;
    }
    for (; end < size; ++end) record[end] = static_cast<char>(below(3));
  }

  unsigned format_;
  std::mt19937_64 random_;
  std::uint32_t x_ = 1000, y_ = 2000;
  std::int64_t time_ = std::int64_t{0x41d0} << 48;
  unsigned channel_ = 0;
  int number_ = 0, count_ = 0;
  std::uint16_t colour_[3] = {};
};

LasFile make_file(unsigned format, std::size_t extra_bytes, std::size_t count, std::uint64_t seed) {
  LasFile file{format, extra_bytes, ""};
  file.records = Pulses(format, seed).records(count, file.record_size());
  return file;
}

void expect_same_points(const LasFile& file, const LazOptions& options) {
  const PointCloud expected = read(encode_las(file)), got = read(encode_laz(file, options));
  EXPECT_EQ(got.positions, expected.positions);
  EXPECT_EQ(got.intensity, expected.intensity);
  EXPECT_EQ(got.classification, expected.classification);
  EXPECT_EQ(got.colours, expected.colours);
}

constexpr unsigned kFormats[] = {0, 1, 2, 3, 6, 7, 8};

TEST(LazFile, ReadsWhatTheUncompressedFileHolds) {
  for (const unsigned format : kFormats) {
    for (const std::size_t extra_bytes : {0, 3}) {
      for (const int version : {3, 4}) {
        const std::uint64_t seed = format * 100 + extra_bytes * 10 + static_cast<unsigned>(version);
        SCOPED_TRACE("seed " + std::to_string(seed));
        const LasFile file = make_file(format, extra_bytes, 3000, seed);
        expect_same_points(file, {{1000}, false, version});
        expect_same_points(file, {{700}, false, version, true});
        expect_same_points(file, {{1, 2, 500, 1, 1500, 996}, true, version});
      }
    }
  }
}

TEST(LazFile, ReadsOnePointAndNone) {
  for (const unsigned format : kFormats) {
    expect_same_points(make_file(format, 0, 1, 7), {{50}});
    expect_same_points(make_file(format, 0, 51, 7), {{50}});
    expect_same_points(make_file(format, 0, 0, 7), {{50}});
  }
}

// Long enough that counts are halved, and that an encoder carries over several bytes.
TEST(LazFile, ReadsLongChunks) {
  for (const unsigned format : {3U, 7U}) {
    expect_same_points(make_file(format, 1, 40000, 11), {{40000}});
  }
}

TEST(LazFile, LeavesOutFieldsWithoutBytes) {
  const LasFile file = make_file(6, 0, 2, 5);
  std::string bytes = encode_laz(file, {{2}});
  // Behind header, description and place of the table: the first point, the number of points,
  // sizes.
  const std::size_t begin = 375 + 54 + 34 + 6 + 8, sizes = begin + 30 + 4;
  std::uint32_t heights;
  std::memcpy(&heights, &bytes[sizes + 4], sizeof heights);
  ASSERT_GT(heights, 0U);
  // All of them become bytes of the classification, which is skipped over then.
  std::uint32_t plane, classes;
  std::memcpy(&plane, &bytes[sizes], sizeof plane);
  std::memcpy(&classes, &bytes[sizes + 8], sizeof classes);
  put_at(bytes.data(), sizes + 4, std::uint32_t{0});
  put_at(bytes.data(), sizes + 8, std::uint32_t{0});
  put_at(bytes.data(), sizes + 12, heights + classes + 7);  // of the flags, which nobody reads
  const PointCloud cloud = read(bytes);
  EXPECT_EQ(cloud.positions[1].z, cloud.positions[0].z);
  EXPECT_EQ(cloud.classification[1], cloud.classification[0]);
}

TEST(LazFile, RefusesFilesThatAreCutShort) {
  for (const unsigned format : {1U, 7U}) {
    const std::string bytes = encode_laz(make_file(format, 0, 500, 3), {{100}});
    for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 40) {
      EXPECT_NE(complaint(bytes.substr(0, length)), "") << "format " << format << ", " << length;
    }
  }
}

TEST(LazFile, SurvivesDamage) {
  for (const unsigned format : kFormats) {
    const std::string good = encode_laz(make_file(format, 2, 400, 9), {{100}});
    std::mt19937 random(format);
    for (int i = 0; i < 60; ++i) {
      std::string bytes = good;
      for (int k = 0; k < 3; ++k) {
        bytes[std::uniform_int_distribution<std::size_t>(96, bytes.size() - 1)(random)] =
            static_cast<char>(random());
      }
      complaint(bytes);  // or none: what matters is that nothing else happens
    }
  }
}

TEST(LazFile, NamesTheChunkThatIsDamaged) {
  std::string bytes = encode_laz(make_file(6, 0, 300, 3), {{100}});
  const std::size_t first_chunk = 375 + 54 + 34 + 6 + 8;
  // The first layer takes more bytes than the chunk has.
  put_at(bytes.data(), first_chunk + 30 + 4, std::uint32_t{0x7fffffff});
  EXPECT_NE(complaint(bytes).find("chunk 0: is damaged"), std::string::npos) << complaint(bytes);
}

TEST(LazFile, TellsWhatIsNotRead) {
  const std::string good = encode_laz(make_file(1, 0, 10, 3), {{100}});
  constexpr std::size_t kDescription = 227 + 54;
  const auto with = [&](std::size_t at, auto value) {
    std::string bytes = good;
    put_at(bytes.data(), at, value);
    return complaint(bytes);
  };
  EXPECT_NE(with(227 + 2, 'X').find("without its record on compression"), std::string::npos);
  EXPECT_NE(with(kDescription, std::uint16_t{9}).find("unknown compressor 9"), std::string::npos);
  EXPECT_NE(with(kDescription + 2, std::uint16_t{1}).find("entropy coder"), std::string::npos);
  EXPECT_NE(with(kDescription + 34 + 4, std::uint16_t{1}).find("coding of version 1"),
            std::string::npos);
  EXPECT_NE(with(kDescription + 34 + 6, std::uint16_t{9}).find("wave packets (point format 1)"),
            std::string::npos);
  EXPECT_NE(with(kDescription + 34 + 6, std::uint16_t{5}).find("items of type 5"),
            std::string::npos);
  EXPECT_NE(with(105, std::uint16_t{30}).find("describes points of 28 bytes"), std::string::npos);
  EXPECT_NE(with(107, std::uint32_t{111}).find("the header announces 111"), std::string::npos);
  EXPECT_NE(with(227 + 54 + 34 + 12, std::int64_t{1} << 40).find("the table of chunks is not"),
            std::string::npos);
}

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream content;
  content << file.rdbuf();
  return content.str();
}

TEST(LazFile, ReadsTheFilesOfOthers) {
  const std::filesystem::path folder = DELRAY_SHARED_DATA;
  if (!exists(folder / "autzen_trim.laz")) GTEST_SKIP() << "no " << folder / "autzen_trim.laz";
  const PointCloud expected = read(content_of(folder / "autzen_trim.las")),
                   got = read(content_of(folder / "autzen_trim.laz"));
  EXPECT_EQ(got.positions, expected.positions);
  EXPECT_EQ(got.intensity, expected.intensity);
  EXPECT_EQ(got.classification, expected.classification);
  EXPECT_EQ(got.colours, expected.colours);
  EXPECT_EQ(read(content_of(folder / "lone-star.copc.laz")).size(), 518862U);
}

}  // namespace
}  // namespace delray::tests
