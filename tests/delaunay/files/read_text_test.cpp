// Points as rows of text: separators, names of columns, and the lines that messages name.
#include "delaunay/read_points.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/delaunay/files/point_files.h"

namespace delray::delaunay {
namespace {

using tests::complaint_about_points;
using tests::points_in;
using Positions = std::vector<glm::dvec3>;

TEST(ReadText, TakesAnySeparatorAndComments) {
  const Positions expected = {{1, 2, 3}, {-4.5, 5e-3, 6}};
  for (const char* text :
       {"1 2 3\n-4.5 5e-3 6\n", "1,2,3\r\n-4.5,5e-3,6\r\n", "1;2;3\n-4.5;5e-3;6",
        "1\t2\t3\n-4.5\t5e-3\t6\n", "# c\n\n  1 ,\t2, 3  # c\n// c\n-4.5,5e-3,+6\n\n",
        "\xef\xbb\xbf"
        "1 2 3\n-4.5 5e-3 6\n"}) {
    const PointCloud cloud = points_in("a.xyz", text);
    EXPECT_EQ(cloud.positions, expected) << text;
    EXPECT_TRUE(cloud.has_z);
  }
  EXPECT_NE(complaint_about_points("a.xyz", "1 2\n+-3 4\n").find("line 2"), std::string::npos);
}

TEST(ReadText, KeepsDoublesAsWritten) {
  const PointCloud cloud =
      points_in("a.txt", "0.1 1e-320\n1e-400 123456789012345678901234567890\n-0 +7\n");
  EXPECT_FALSE(cloud.has_z);
  EXPECT_EQ(cloud.positions[0], glm::dvec3(0.1, 1e-320, 0));
  EXPECT_EQ(cloud.positions[1], glm::dvec3(0, 123456789012345678901234567890.0, 0));
  EXPECT_EQ(cloud.positions[2], glm::dvec3(0, 7, 0));
}

TEST(ReadText, FindsColumnsByName) {
  const PointCloud cloud =
      points_in("a.csv",
                "id,\"Y\",X,point name,Intensity,red,green,blue,classification,Z\n"
                "1,20,10,a,50,1,2,3,6,30\n2,21,11,b,100,255,0,4,2,31\n");
  EXPECT_EQ(cloud.positions, (Positions{{10, 20, 30}, {11, 21, 31}}));
  EXPECT_EQ(cloud.colours[1], glm::u8vec4(255, 0, 4, 255));
  EXPECT_EQ(cloud.intensity, (std::vector<float>{0.5F, 1.0F}));
  EXPECT_EQ(cloud.classification, (std::vector<std::uint8_t>{6, 2}));
  EXPECT_EQ(points_in("a.csv", "lon;lat\n1;2\n").positions, (Positions{{1, 2, 0}}));
  EXPECT_EQ(points_in("a.csv", "some title\n1 2 3\n").positions, (Positions{{1, 2, 3}}));
  EXPECT_NE(complaint_about_points("a.csv", "x,z\n1,2\n").find("no y"), std::string::npos);
}

TEST(ReadText, KnowsTheNamesThatSurveyorsAndExportersUse) {
  for (const char* names :
       {"id,lon,lat,ele", "id,lng,lat,elev", "id,long,lat,alt", "id,E,N,H", "id,East,North,dem",
        "id,X_COORD,Y_COORD,Z_COORD", "id,POINT_X,POINT_Y,POINT_Z", "id,x,y,value",
        "id,easting,northing,elevation", "e,x,y,z"}) {
    EXPECT_EQ(points_in("a.csv", std::string(names) + "\n7,1,2,3\n").positions,
              (Positions{{1, 2, 3}}))
        << names;
  }
}

TEST(ReadText, RefusesRowsThatWouldLoseTheirHeights) {
  EXPECT_NE(complaint_about_points("a.xyz", "0 0\n1 0\n0 1 5\n1 1 2\n").find("line 3"),
            std::string::npos);
  EXPECT_NE(complaint_about_points("a.csv", "0,0\n1,0,\n0,1,5\n").find("line 3"),
            std::string::npos);
  EXPECT_EQ(points_in("a.xyz", "0 0 # c\n1 0 # 5\n").size(), 2U);
}

TEST(ReadText, TakesSixColumnsAsColoursIfTheyAreBytes) {
  EXPECT_EQ(points_in("a.xyz", "1 2 3 255 0 7\n4 5 6 1 2 3\n").colours.size(), 2U);
  EXPECT_TRUE(points_in("a.xyz", "1 2 3 0 0 1\n4 5 6 0.6 0.8 0\n").colours.empty());
  EXPECT_TRUE(points_in("a.xyz", "1 2 3 0 0 1\n4 5 6 0 0 -1\n").colours.empty());
}

TEST(ReadText, SkipsALineOfCounts) {
  EXPECT_EQ(points_in("a.txt", "2\n1 2 3\n4 5 6\n").positions, (Positions{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(points_in("a.txt", "3 2\n1 2\n4 5\n7 9\n0 1\n1 2\n").size(), 3U);
  EXPECT_EQ(points_in("a.txt", "2 0\n  1.5 2.5\n  4.5 5.5").size(), 2U);
  // The same first lines can be points.
  EXPECT_EQ(points_in("a.txt", "2 0\n1 2\n4 5\n").size(), 3U);
  EXPECT_EQ(points_in("a.txt", "3 2\n1 2\n4 5\n7 9\n0 1.5\n1 2\n").size(), 6U);
  EXPECT_EQ(points_in("a.txt", "3 2\n1.5 2\n4 5\n").size(), 3U);
  EXPECT_NE(complaint_about_points("a.txt", "3\n1 2\n4 5\n").find("line 1"), std::string::npos);
  complaint_about_points("a.txt", "99999999999999999999\n1 2\n");
  complaint_about_points("a.txt", "9999999999999999\n1 2\n");
}

TEST(ReadText, NamesTheLineOfBadText) {
  EXPECT_NE(complaint_about_points("a.xyz", "1 2 3\n\n4 x 6\n").find("line 3"), std::string::npos);
  EXPECT_NE(complaint_about_points("a.xyz", "1 2 3\n4 5\n").find("line 2"), std::string::npos);
  EXPECT_NE(complaint_about_points("a.xyz", "1 2 3\n4 nan 6\n").find("line 2"), std::string::npos);
  EXPECT_NE(complaint_about_points("a.xyz", "1 -inf 3\n").find("line 1"), std::string::npos);
  EXPECT_NE(complaint_about_points("a.xyz", "1 1e999 3\n").find("line 1"), std::string::npos);
  EXPECT_NE(complaint_about_points("a.csv", "1,,3\n").find("line 1"), std::string::npos);
  EXPECT_NE(complaint_about_points("a.csv", "1,5;2,5\n").find("line 1"), std::string::npos);
  EXPECT_NE(complaint_about_points("a.xyz", "1 0x10 3\n").find("line 1"), std::string::npos);
  EXPECT_NE(complaint_about_points("a.xyz", "1\n").find("line 1"), std::string::npos);
  std::string many;
  for (int i = 0; i < 100000; ++i) many += i == 40000 || i == 90000 ? "bad\n" : "1 2 3\n";
  EXPECT_NE(complaint_about_points("a.xyz", many).find("line 40001"), std::string::npos);
}

}  // namespace
}  // namespace delray::delaunay
