// Parts of an input are the points of the whole, whatever files it consists of, and filters keep
// what one that looks at every point keeps.
#include "delaunay/open_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <string>

#include "delaunay/write_points.h"
#include "parallel/parallel_for.h"
#include "tests/delaunay/files/laz/laz_encoder.h"
#include "tests/delaunay/files/point_files.h"

namespace delray::delaunay {
namespace {

using files::FileError;
using tests::TemporaryFolder;
using Paths = std::vector<std::filesystem::path>;

constexpr unsigned kSeed = 20042;

// All parts, read in any order and twice, behind each other.
PointCloud join(const PointParts& input) {
  std::vector<PointCloud> parts(input.parts());
  parallel::parallel_for(0, parts.size(), 1, [&](std::size_t i) {
    const std::size_t part = parts.size() - 1 - i;
    input.read(part, parts[part]);
    PointCloud again;
    input.read(part, again);
    EXPECT_EQ(again.positions, parts[part].positions);
    EXPECT_EQ(again.colours, parts[part].colours);
  });
  PointCloud all;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_LE(parts[i].size(), input.most_rows(i));
    const auto append = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(all.positions, parts[i].positions);
    append(all.colours, parts[i].colours);
    append(all.intensity, parts[i].intensity);
    append(all.classification, parts[i].classification);
    append(all.warnings, parts[i].warnings);
    all.has_z = all.has_z || parts[i].has_z;
  }
  return all;
}

void expect_equal(const PointCloud& a, const PointCloud& b) {
  EXPECT_EQ(a.has_z, b.has_z);
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_TRUE(a.colours == b.colours);
  EXPECT_TRUE(a.intensity == b.intensity);
  EXPECT_TRUE(a.classification == b.classification);
}

// Records of LAS points: x, y and z from 0 to 99.99, all returns, some classes.
tests::LasFile las_file(unsigned format, std::size_t points, std::mt19937& random) {
  tests::LasFile file;
  file.format = format;
  const std::size_t size = file.record_size();
  file.records.assign(points * size, '\0');
  for (std::size_t i = 0; i < points; ++i) {
    char* record = file.records.data() + i * size;
    for (int k = 0; k < 3; ++k) {
      const auto value = static_cast<std::int32_t>(random() % 10000);
      std::memcpy(record + 4 * k, &value, sizeof value);
    }
    const unsigned count = 1 + random() % 4, number = 1 + random() % count;
    record[14] = static_cast<char>(format >= 6 ? number | count << 4 : number | count << 3);
    record[format >= 6 ? 16 : 15] = static_cast<char>(random() % 4);
    record[12] = static_cast<char>(random() % 256);
    if (format == 3) record[28] = static_cast<char>(random() % 200);
  }
  return file;
}

std::string text_file(std::size_t rows, bool named, std::mt19937& random) {
  std::string text = named ? "x;y;height;class;intensity;note\r\n" : "# made\n\n";
  const char* const separator = named ? ";" : " ";
  for (std::size_t i = 0; i < rows; ++i) {
    for (int k = 0; k < 3; ++k) {
      text += std::to_string(static_cast<int>(random() % 200000) - 100000) + "." +
              std::to_string(random() % 1000) + (k < 2 ? separator : "");
    }
    if (named) text += ";" + std::to_string(random() % 9) + ";" + std::to_string(i % 7) + ";t";
    text += named ? "\r\n" : "\n";
    if (random() % 1000 == 0) text += "  \n# " + std::string(random() % 300, 'c') + "\n";
  }
  return text + "1" + separator + "2" + separator + "3" + (named ? ";4;5;6" : "");
}

PointCloud random_cloud(std::size_t points, std::mt19937& random) {
  PointCloud cloud;
  cloud.has_z = true;
  std::uniform_real_distribution<double> uniform(-1e3, 1e3);
  for (std::size_t i = 0; i < points; ++i) {
    cloud.positions.emplace_back(uniform(random), uniform(random), uniform(random));
    cloud.colours.emplace_back(random() % 256, random() % 256, random() % 256, 255);
    cloud.intensity.push_back(static_cast<float>(random() % 100) / 99.0F);
  }
  return cloud;
}

std::string pcd_file(const PointCloud& cloud) {
  std::string bytes =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS y x z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\n" +
      std::string("WIDTH ") + std::to_string(cloud.size()) + "\nHEIGHT 1\nPOINTS " +
      std::to_string(cloud.size()) + "\nDATA binary\n";
  for (const glm::dvec3& p : cloud.positions) {
    for (const double value : {p.y, p.x, p.z}) tests::append_bytes(bytes, value);
  }
  return bytes;
}

// Files that are cut into several parts each, of every format that can be.
Paths large_files(const TemporaryFolder& folder, std::mt19937& random) {
  const PointCloud cloud = random_cloud(140'000, random);
  write_points(folder.path() / "a.ply", cloud);
  Paths paths = {folder.path() / "a.ply", folder.write("b.xyz", text_file(110'000, false, random)),
                 folder.write("c.csv", text_file(90'000, true, random)),
                 folder.write("d.pcd", pcd_file(cloud))};
  const tests::LasFile las = las_file(3, 150'000, random), new_las = las_file(6, 70'000, random);
  paths.push_back(folder.write("e.las", encode_las(las)));
  paths.push_back(folder.write("f.laz", encode_laz(las, {.chunks = {25'000}})));
  paths.push_back(
      folder.write("g.laz", encode_laz(new_las, {.chunks = {9'000, 1, 50'000}, .variable = true})));
  return paths;
}

TEST(OpenPoints, PartsAreThePointsOfEachFile) {
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  const TemporaryFolder folder;
  const Paths paths = large_files(folder, random);
  PointCloud expected;
  for (const auto& path : paths) {
    SCOPED_TRACE(path);
    const PointCloud whole = read_points(path);
    const auto parts = open_points(std::span(&path, 1));
    EXPECT_GT(parts->parts(), 1U);
    expect_equal(join(*parts), whole);
    expect_equal(read_points(*parts), whole);
    expected.positions.insert(expected.positions.end(), whole.positions.begin(),
                              whole.positions.end());
  }
  // The LAS and the LAZ have the same points; all files together are one behind the other.
  EXPECT_EQ(read_points(paths[4]).positions, read_points(paths[5]).positions);
  EXPECT_TRUE(read_points(paths, {}).positions == expected.positions);
  EXPECT_TRUE(join(*open_points(paths)).positions == expected.positions);
  const Paths all = {folder.path()};
  EXPECT_TRUE(read_points(all, {}).positions == expected.positions);
}

TEST(OpenPoints, ReadsTextWhoseRangesEndAnywhere) {
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  const TemporaryFolder folder;
  constexpr std::size_t kRange = std::size_t{1} << 21;
  // Lines that begin and end about where ranges do, and one that is longer than a range.
  for (int shift = -3; shift <= 3; ++shift) {
    std::string text = "0 0\n";
    text +=
        "# " + std::string(kRange + static_cast<std::size_t>(shift + 8) - text.size() - 12, 'c');
    text += "\n1 1\n2 2\n";
    text += "#" + std::string(3 * kRange, 'd') + "\n3 3\n4 4";
    const Paths paths = {folder.write("a.xyz", text)};
    const PointCloud points = join(*open_points(paths));
    ASSERT_EQ(points.size(), 5U) << shift;
    for (int i = 0; i < 5; ++i) EXPECT_EQ(points.positions[i], glm::dvec3(i, i, 0));
  }
}

TEST(OpenPoints, NamesTheLineOfAnErrorInAnyPart) {
  std::mt19937 random(kSeed);
  const TemporaryFolder folder;
  std::string text = text_file(120'000, false, random);
  const auto bad = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 2;
  text += "\n1 2 x\n";
  const Paths paths = {folder.write("a.xyz", text)};
  try {
    read_points(paths, {});
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.place(), "line " + std::to_string(bad));
  }
}

TEST(OpenPoints, LooksAtCountsInTheFirstRow) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    const Paths paths = {folder.write("a.txt", text)};
    return join(*open_points(paths)).positions;
  };
  EXPECT_EQ(read("2\n1 2\n3 4\n").size(), 2U);
  EXPECT_EQ(read("2\n1 2\n3 4\n5 6\n").size(), 2U);      // the third row is no point
  EXPECT_EQ(read("2 1\n0.5 2\n3 4\n0 1\n").size(), 2U);  // an outline
  EXPECT_EQ(read("2 7\n1 2\n3 4\n").size(), 3U);         // points all
  EXPECT_EQ(read("3 0\n0.5 2\n3 4\n5 6\n").size(), 3U);  // counts, of three points
  EXPECT_EQ(read("1 2\r3 4\r5 6\r").size(), 3U);         // line ends of old
}

TEST(OpenPoints, KeepsWhatTheFilterSays) {
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  const TemporaryFolder folder;
  for (const unsigned format : {3U, 6U}) {
    const tests::LasFile file = las_file(format, 30'000, random);
    const Paths paths = {folder.write("a.laz", encode_laz(file, {.chunks = {7'000}}))};
    const PointCloud all = read_points(paths, {});
    for (const ReturnChoice& choice : return_choices()) {
      SCOPED_TRACE(choice.name);
      PointFilter filter;
      filter.returns = &choice;
      filter.classes.emplace(0b1001);
      filter.bounds = {{10, 20, 5}, {60, 70, 80}};
      filter.bounds_z = true;
      std::vector<glm::dvec3> expected;
      for (std::size_t i = 0; i < all.size(); ++i) {
        const char* record = file.records.data() + i * file.record_size();
        const int returns = static_cast<unsigned char>(record[14]);
        const int number = format >= 6 ? returns & 15 : returns & 7,
                  count = format >= 6 ? returns >> 4 : returns >> 3 & 7;
        const glm::dvec3& p = all.positions[i];
        const int kind = all.classification[i];
        const bool first = number == 1, last = number == count;
        const bool wanted = choice.name == "first"           ? first
                            : choice.name == "last"          ? last
                            : choice.name == "only"          ? count == 1
                            : choice.name == "intermediate"  ? !first && !last
                            : choice.name == "first-of-many" ? first && count > 1
                                                             : last && count > 1;
        if (wanted && (kind == 0 || kind == 3) && p.x >= 10 && p.x <= 60 && p.y >= 20 &&
            p.y <= 70 && p.z >= 5 && p.z <= 80) {
          expected.push_back(p);
        }
      }
      EXPECT_FALSE(expected.empty());
      EXPECT_TRUE(read_points(paths, filter).positions == expected);
      EXPECT_TRUE(join(*open_points(paths, filter)).positions == expected);
    }
  }
}

TEST(OpenPoints, RefusesFiltersWithoutEffect) {
  const TemporaryFolder folder;
  const Paths paths = {folder.write("a.xyz", "1 2\n3 4\n")};
  PointFilter classes, returns, resolution, heights, plane;
  classes.classes.emplace(4);
  returns.returns = &return_choices()[0];
  resolution.resolution = 1;
  heights.bounds = plane.bounds = {{0, 0, 0}, {2, 2, 2}};
  heights.bounds_z = true;
  for (const PointFilter& filter : {classes, returns, resolution, heights}) {
    EXPECT_THROW(open_points(paths, filter), std::invalid_argument);
  }
  EXPECT_EQ(read_points(paths, plane).size(), 1U);
  plane.bounds = {{7, 7, 0}, {8, 8, 0}};
  EXPECT_THROW(read_points(paths, plane), FileError);
}

TEST(OpenPoints, TakesFoldersAndPatterns) {
  const TemporaryFolder folder;
  for (const char* name : {"b2.xyz", "a10.xyz", "a9.xyz", ".hidden.xyz", "notes.md", "c.ele"}) {
    folder.write(name, std::string(name) == "notes.md" ? "words" : "1 2\n");
  }
  std::filesystem::create_directory(folder.path() / "x.xyz");
  const auto names = [&](const Paths& inputs) {
    std::string list;
    for (const auto& path : expand_inputs(inputs)) list += path.filename().string() + " ";
    return list;
  };
  EXPECT_EQ(names({folder.path()}), "a10.xyz a9.xyz b2.xyz ");
  EXPECT_EQ(names({folder.path() / "*9*", folder.path() / "?2.xyz", folder.path() / "a10.xyz"}),
            "a9.xyz b2.xyz a10.xyz ");
  EXPECT_EQ(names({folder.path() / "*"}), "a10.xyz a9.xyz b2.xyz c.ele notes.md ");
  EXPECT_EQ(names({"-", "missing.xyz"}), "- missing.xyz ");
  EXPECT_THROW(expand_inputs(Paths{folder.path() / "z*"}), FileError);
  EXPECT_THROW(expand_inputs(Paths{folder.path() / "x.xyz"}), FileError);
  EXPECT_THROW(expand_inputs(Paths{folder.path() / "none" / "*"}), FileError);
  folder.write("[1].xyz", "1 2\n");
  EXPECT_EQ(names({folder.path() / "[1].xyz"}), "[1].xyz ");
}

TEST(OpenPoints, LeavesOutWhatNotAllFilesHave) {
  const TemporaryFolder folder;
  const Paths paths = {folder.write("a.csv", "x,y,z,class\n1,2,3,4\n"),
                       folder.write("b.csv", "x,y\n5,6\n"),
                       folder.write("c.csv", "lon,lat,class\n7,8,9\n")};
  const PointCloud cloud = read_points(paths, {});
  EXPECT_EQ(cloud.size(), 3U);
  EXPECT_TRUE(cloud.has_z);
  EXPECT_TRUE(cloud.classification.empty());
  EXPECT_FALSE(cloud.geographic);
  EXPECT_EQ(cloud.warnings.size(), 1U);
}

// Most files of an input are good; the first bad one is named.
TEST(OpenPoints, NamesTheFileThatIsBad) {
  const TemporaryFolder folder;
  const Paths paths = {folder.write("a.xyz", "1 2\n"), folder.write("b\x1b[2J.xyz", "1 2\n1 x\n"),
                       folder.write("c.xyz", "")};
  try {
    open_points(paths);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(error.file().find("c.xyz"), std::string::npos);
  }
  try {
    read_points(std::span(paths).first(2), {});
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(error.file().find("[2J.xyz"), std::string::npos);
    EXPECT_EQ(error.place(), "line 2");
  }
}

}  // namespace
}  // namespace delray::delaunay
