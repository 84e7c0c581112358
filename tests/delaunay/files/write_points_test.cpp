// Points read back equal in every format.
#include "delaunay/write_points.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "delaunay/generate.h"
#include "delaunay/read_points.h"
#include "files/read_file.h"
#include "tests/support/temporary_folder.h"

namespace delray::delaunay {
namespace {

TEST(WritePoints, ReadBackEqualInEveryFormat) {
  const tests::TemporaryFolder folder;
  for (const int dim : {2, 3}) {
    PointCloud cloud = generate_points("gauss", 9000, dim, 3);
    cloud.positions[1] = {1e300, -5e-324, dim == 3 ? 1.0 / 3 : 0};
    for (const char* suffix : {".xyz", ".txt", ".csv", ".ply", ".json", ".obj", ".off", ".node"}) {
      const auto path = folder / (std::string("a") + suffix);
      write_points(path, cloud);
      const PointCloud read = read_points(path);
      EXPECT_EQ(read.positions, cloud.positions) << path;
      const bool always_z = std::string(suffix) == ".obj" || std::string(suffix) == ".off";
      EXPECT_EQ(read.has_z, dim == 3 || always_z) << path;
    }
  }
}

TEST(WritePoints, CsvKeepsAttributes) {
  const tests::TemporaryFolder folder;
  PointCloud cloud = generate_points("uniform", 3, 3, 1);
  cloud.colours = {{1, 2, 3, 255}, {4, 5, 6, 255}, {255, 0, 9, 255}};
  cloud.intensity = {0, 0.1F, 0.75F};
  cloud.classification = {2, 6, 255};
  write_points(folder / "a.csv", cloud);
  const PointCloud read = read_points(folder / "a.csv");
  EXPECT_EQ(read.positions, cloud.positions);
  EXPECT_EQ(read.colours, cloud.colours);
  EXPECT_EQ(read.intensity, cloud.intensity);
  EXPECT_EQ(read.classification, cloud.classification);
}

TEST(WritePoints, RefusesUnknownSuffixes) {
  const tests::TemporaryFolder folder;
  for (const char* name : {"a", "a.las", "a.x", "a.xy"}) {
    EXPECT_THROW(write_points(folder / name, generate_points("uniform", 3, 2, 1)),
                 std::invalid_argument);
  }
  EXPECT_EQ(folder.entries(), 0U);
  write_points(folder / "A.XYZ", generate_points("uniform", 3, 2, 1));
  EXPECT_EQ(folder.entries(), 1U);
}

}  // namespace
}  // namespace delray::delaunay
