// Outlines come back from .poly as they were written, and generated ones are what they say.
#include "delaunay/outline.h"

#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

#include "files/error.h"
#include "files/read_file.h"
#include "tests/support/temporary_folder.h"

namespace delray::delaunay {
namespace {

TEST(Outline, ComesBackFromAFile) {
  const tests::TemporaryFolder folder;
  Outline outline = generate_outline("country", 300, 9);
  for (const bool has_z : {false, true}) {
    outline.points.has_z = has_z;
    if (has_z) outline.points.positions[3].z = 0.1;
    write_outline(folder / "a.poly", outline);
    const Outline read = read_outline(folder / "a.poly");
    EXPECT_EQ(read.points.positions, outline.points.positions);
    EXPECT_EQ(read.points.has_z, has_z);
    EXPECT_EQ(read.segments, outline.segments);
    EXPECT_EQ(read.holes, outline.holes);
  }
}

TEST(Outline, PointsMayBeInTheNodeFileBesideIt) {
  const tests::TemporaryFolder folder;
  folder.write("a.node", "3 2 1 0\n1 0 0 5\n2 1 0 6\n3 0 1 7\n");
  folder.write("a.poly", "0 2 0 0\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n");
  const Outline outline = read_outline(folder / "a.poly");
  EXPECT_EQ(outline.points.size(), 3U);
  EXPECT_EQ(outline.points.positions[2], glm::dvec3(0, 1, 7));
  EXPECT_EQ(outline.segments.back(), (std::array<std::uint32_t, 2>{2, 0}));
}

TEST(Outline, BrokenFilesAreRefusedWithTheirLine) {
  const struct {
    const char *content, *message;
  } files[] = {
      {"", "empty"},
      {"3 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n0\n0\n", "dimension 2"},
      {"3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n", "no segments"},
      {"3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n2 0\n0 0 1\n", "line 5"},
      {"3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n1 0\n0 0 3\n", "line 6: refers to a point"},
      {"2 2 0 0\n1 0 0\n2 1 0\n1 0\n1 1 -9223372036854775808\n", "line 5: refers to a point"},
      {"3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n1 0\n0 0\n", "line 6: the line ends too early"},
      {"3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n-1 0\n", "line 5: a negative number"},
      {"3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n0\n1\n0 nan 1\n", "line 7: not a finite number"},
      {"3 2 0 0\n0 0 0\n1 x 0\n2 0 1\n0\n0\n", "line 3: not a number"},
  };
  const tests::TemporaryFolder folder;
  for (const auto& [content, message] : files) {
    folder.write("b.poly", content);
    try {
      read_outline(folder / "b.poly");
      ADD_FAILURE() << content;
    } catch (const files::FileError& error) {
      EXPECT_EQ(error.cause(), files::Cause::input);
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos)
          << error.what() << " for " << content;
    }
  }
}

TEST(Outline, GeneratedOnesAreClosedWithAboutAsManyPointsAsAskedFor) {
  for (const OutlineGenerator& kind : outline_generators()) {
    for (const std::size_t n : {60, 1000, 5000}) {
      const Outline outline = generate_outline(kind.name, n, 4);
      SCOPED_TRACE(std::string(kind.name) + " " + std::to_string(n));
      EXPECT_GT(2 * outline.points.size(), n);
      EXPECT_LT(outline.points.size(), 2 * n);
      std::map<std::uint32_t, int> leaving;
      for (const auto& [a, b] : outline.segments) {
        ++leaving[a];
        --leaving[b];
      }
      EXPECT_EQ(leaving.size(), outline.points.size());
      for (const auto& [row, balance] : leaving) EXPECT_EQ(balance, 0) << row;
      for (const glm::dvec3& p : outline.points.positions) {
        EXPECT_TRUE(p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1);
      }
      EXPECT_EQ(generate_outline(kind.name, n, 4).points.positions, outline.points.positions);
      EXPECT_NE(generate_outline(kind.name, n, 5).points.positions, outline.points.positions);
    }
  }
  EXPECT_THROW(generate_outline("none", 100, 1), std::invalid_argument);
  EXPECT_THROW(generate_outline("lake", 7, 1), std::invalid_argument);
}

}  // namespace
}  // namespace delray::delaunay
