#include "files/coordinate_system.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/support/temporary_folder.h"

namespace delray::files {
namespace {

void put(std::string& bytes, std::size_t at, std::uint64_t value, std::size_t size) {
  std::memcpy(bytes.data() + at, &value, size);
}

std::string record(std::uint16_t kind, const std::string& content) {
  std::string head(54, '\0');
  head.replace(2, 15, "LASF_Projection");
  put(head, 18, kind, 2);
  put(head, 20, content.size(), 2);
  return head + content;
}

std::string las_with(const std::string& records, std::uint32_t count) {
  std::string header(227, '\0');
  header.replace(0, 4, "LASF");
  put(header, 94, 227, 2);
  put(header, 100, count, 4);
  return header + records;
}

TEST(CoordinateSystem, IsReadFromRecordsOfLas) {
  const tests::TemporaryFolder folder;
  const std::string keys("\1\0\2\0\3\0\4\0", 8);
  const auto path = folder.write(
      "a.las",
      las_with(record(2112, std::string("LOCAL_CS[\"here\"]\0\0", 18)) + record(34735, keys) +
                   record(34736, std::string(16, '\0')) + record(34737, "names|"),
               4));
  const CoordinateSystem system = read_las_coordinate_system(path);
  EXPECT_EQ(system.well_known_text, "LOCAL_CS[\"here\"]");
  EXPECT_EQ(system.geo_keys, (std::vector<std::uint16_t>{1, 2, 3, 4}));
  EXPECT_EQ(system.geo_numbers, (std::vector<double>{0, 0}));
  EXPECT_EQ(system.geo_texts, "names|");
  EXPECT_FALSE(system.empty());
}

TEST(CoordinateSystem, IsUnknownWhereFilesBreakOff) {
  const tests::TemporaryFolder folder;
  const std::string whole = las_with(record(2112, "LOCAL_CS[]"), 1000000000);
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    EXPECT_TRUE(read_las_coordinate_system(folder.write("a.las", whole.substr(0, size))).empty());
  }
  EXPECT_FALSE(read_las_coordinate_system(folder.write("a.las", whole)).empty());
  EXPECT_TRUE(read_las_coordinate_system(folder.write("b.ply", "ply\n")).empty());
  EXPECT_TRUE(read_las_coordinate_system(folder / "none").empty());
  EXPECT_TRUE(read_las_coordinate_system("/dev/zero").empty());
}

}  // namespace
}  // namespace delray::files
