// Triangulations of measured points and of points that have broken triangulators, against what CGAL
// makes of them.
#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>
#include <string>

#include "delaunay/read_points.h"
#include "delaunay/triangulate.h"
#include "delaunay/verify.h"

namespace delray::delaunay {
namespace {

const std::filesystem::path kFolder = DELRAY_SHARED_DATA;

struct Reference {
  const char* file;
  std::size_t simplices;
  const char* hash;
  friend void PrintTo(const Reference& reference, std::ostream* out) { *out << reference.file; }
};

class RealPoints : public testing::TestWithParam<Reference> {};

TEST_P(RealPoints, GiveTheReferenceTriangulation) {
  const auto& [file, simplices, expected] = GetParam();
  if (!exists(kFolder / file)) GTEST_SKIP() << "no " << kFolder / file;
  const PointCloud cloud = read_points(kFolder / file);
  const Triangulation triangulation = triangulate(view(cloud.positions)).triangulation;
  EXPECT_EQ(triangulation.size(), simplices);
  EXPECT_EQ(to_string(hash(triangulation)), expected);
  const Verdict verdict = verify_triangles(view(cloud.positions), triangulation.vertices);
  EXPECT_TRUE(verdict.canonical) << verdict.reason;
  EXPECT_EQ(verdict.distinct, triangulation.distinct);
}

INSTANTIATE_TEST_SUITE_P(
    InThePlane, RealPoints,
    testing::Values(Reference{"CSite1-lidar.ply", 614707, "401bd0c147061f69ad2db19f00f8c5c1"},
                    Reference{"ukraine.json", 1711, "3dcde560f8f40eb3a691bfa027acf8ea"},
                    Reference{"issue13.json", 15, "ac74b401071a0b107c0144c74f1d04f9"},
                    Reference{"robustness1.json", 141, "474e09309f63df556173da7a9cfe90b0"},
                    Reference{"robustness2.json", 1924, "88801148ef447a8b6f7b602146eb3b3e"}),
    [](const auto& instance) {
      std::string name = instance.param.file;
      std::erase_if(name, [](char c) { return c == '.' || c == '-'; });
      return name;
    });

TEST(OtherRealPoints, AreCanonicalToo) {
  if (!exists(kFolder)) GTEST_SKIP() << "no real data in " << kFolder;
  for (const char* file : {"autzen_trim.las", "LakeSuperior.txt", "spot.obj", "teapot.obj"}) {
    const PointCloud cloud = read_points(kFolder / file);
    const Triangulation triangulation = triangulate(view(cloud.positions)).triangulation;
    const Verdict verdict = verify_triangles(view(cloud.positions), triangulation.vertices);
    EXPECT_TRUE(verdict.canonical) << file << ": " << verdict.reason;
  }
}

}  // namespace
}  // namespace delray::delaunay
