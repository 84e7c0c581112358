// Floats are triangulated as the doubles that equal them.
#include <gtest/gtest.h>

#include <vector>

#include "delaunay/generate.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {
namespace {

struct Vertex {
  char name[4];
  float x, y, z;
  int colour;
};

TEST(TriangulateFloats, IsThatOfEqualDoubles) {
  for (const char* kind : {"uniform", "grid", "duplicates", "collinear"}) {
    SCOPED_TRACE(kind);
    const auto cloud = generate_points(kind, 1000, 2, 3);
    std::vector<Vertex> interleaved;
    std::vector<glm::vec2> floats;
    std::vector<glm::dvec2> doubles;
    for (const glm::dvec3& p : cloud.positions) {
      const glm::vec2 q(p);
      floats.push_back(q);
      doubles.emplace_back(q);
      interleaved.push_back({{}, q.x, q.y, 9, 0});
    }
    const Hash128 expected = hash(triangulate(view(doubles)).triangulation);
    EXPECT_EQ(hash(triangulate(view(floats)).triangulation), expected);
    const PointView<float> strided{reinterpret_cast<const std::byte*>(&interleaved[0].x),
                                   interleaved.size(), sizeof(Vertex)};
    EXPECT_EQ(hash(triangulate(strided).triangulation), expected);
  }
  EXPECT_EQ(triangulate(PointView<float>{}).triangulation.size(), 0U);
}

}  // namespace
}  // namespace delray::delaunay
