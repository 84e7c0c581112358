// Of a cloud-optimised file only nodes are read that are asked for, and its octree is not trusted.
#include "delaunay/files/parts/copc.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <random>
#include <string>

#include "delaunay/files/parts/las_parts.h"
#include "tests/delaunay/files/laz/laz_encoder.h"
#include "tests/delaunay/files/point_files.h"

namespace delray::delaunay {
namespace {

using tests::append_bytes;

struct TestNode {
  std::int32_t level, x, y, z;
  std::size_t points;
  std::uint64_t begin = 0, size = 0;  // of its chunk
};

// Inserts a variable length record behind the header of a LAZ file.
void insert_record(std::string& laz, const std::string& user, std::uint16_t number,
                   const std::string& content) {
  std::string record(54, '\0');
  record.replace(2, user.size(), user);
  std::memcpy(&record[18], &number, sizeof number);
  const auto length = static_cast<std::uint16_t>(content.size());
  std::memcpy(&record[20], &length, sizeof length);
  record += content;
  std::uint32_t begin = 0, count = 0;
  std::memcpy(&begin, &laz[96], sizeof begin);
  std::memcpy(&count, &laz[100], sizeof count);
  std::int64_t table = 0;
  std::memcpy(&table, &laz[begin], sizeof table);
  table += static_cast<std::int64_t>(record.size());
  std::memcpy(&laz[begin], &table, sizeof table);
  begin += static_cast<std::uint32_t>(record.size());
  ++count;
  std::memcpy(&laz[96], &begin, sizeof begin);
  std::memcpy(&laz[100], &count, sizeof count);
  laz.insert(375, record);
}

std::string page_of(const std::vector<TestNode>& nodes) {
  std::string page;
  for (const TestNode& node : nodes) {
    for (const std::int32_t value : {node.level, node.x, node.y, node.z}) append_bytes(page, value);
    append_bytes(page, node.begin);
    append_bytes(page, static_cast<std::int32_t>(node.size));
    append_bytes(page, static_cast<std::int32_t>(node.points));
  }
  return page;
}

// An octree of three levels over the cube of 64 from the origin: each node has points of its cube,
// and an empty one stands in between. The nodes of level 2 are in a page of their own.
struct Octree {
  std::string bytes;
  std::vector<TestNode> nodes;
  std::size_t root_place = 0;  // of the place of the root page, in the file
};

Octree make_octree(std::mt19937& random) {
  Octree octree;
  octree.nodes = {{0, 0, 0, 0, 50}};
  for (int i = 0; i < 8; ++i) {
    octree.nodes.push_back({1, i & 1, i >> 1 & 1, i >> 2, i == 3 ? 0U : 20U + random() % 100});
  }
  for (int i = 0; i < 64; ++i) {
    if (random() % 3 != 0) {
      octree.nodes.push_back({2, i & 3, i >> 2 & 3, i >> 4, 1 + random() % 50});
    }
  }
  tests::LasFile file;
  file.format = 6;
  tests::LazOptions options;
  options.variable = true;
  for (const TestNode& node : octree.nodes) {
    if (node.points == 0) continue;
    options.chunks.push_back(node.points);
    const std::int32_t side = 6400 >> node.level;  // in steps of 0.01
    for (std::size_t i = 0; i < node.points; ++i) {
      std::string record(30, '\0');
      const std::int32_t corner[] = {node.x * side, node.y * side, node.z * side};
      for (int k = 0; k < 3; ++k) {
        const auto value = corner[k] + static_cast<std::int32_t>(random() % (side + 1));
        std::memcpy(&record[4 * k], &value, sizeof value);
      }
      record[14] = 0x11;
      file.records += record;
    }
  }
  octree.bytes = encode_laz(file, options);
  std::string description;
  for (const double value : {32.0, 32.0, 32.0, 32.0, 8.0}) append_bytes(description, value);
  description.resize(160);
  insert_record(octree.bytes, "copc", 1, description);

  const ByteSource source({"made", octree.bytes});
  const laz::LazFile laz = laz::parse_laz_file(source, parse_las_header(source));
  std::size_t chunk = 0;
  for (TestNode& node : octree.nodes) {
    if (node.points == 0) continue;
    node.begin = laz.chunks[chunk].begin;
    node.size = laz.chunks[chunk++].size;
  }
  const auto second = octree.nodes.begin() + 9;
  const std::string lower = page_of({second, octree.nodes.end()});
  std::vector<TestNode> upper(octree.nodes.begin(), second);
  upper.push_back({0, 0, 0, 0, static_cast<std::size_t>(-1), octree.bytes.size(), lower.size()});
  octree.bytes += lower;
  const std::string root = page_of(upper);
  const std::uint64_t root_begin = octree.bytes.size(), root_size = root.size();
  octree.root_place = 375 + 54 + 40;
  std::memcpy(&octree.bytes[octree.root_place], &root_begin, sizeof root_begin);
  std::memcpy(&octree.bytes[octree.root_place + 8], &root_size, sizeof root_size);
  octree.bytes += root;
  return octree;
}

PointCloud read(const std::string& bytes, const PointFilter& filter) {
  const Input input{"made", bytes};
  return read_all(LasParts(ByteSource(input), filter), filter, input.memory);
}

TEST(Copc, ReadsNodesWithinBoundsAndResolution) {
  constexpr unsigned kSeed = 20045;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (int round = 0; round < 20; ++round) {
    const Octree octree = make_octree(random);
    const PointCloud all = read(octree.bytes, {});
    for (const double resolution : {0.0, 100.0, 8.0, 7.9, 4.0, 3.0, 2.0, 0.1}) {
      PointFilter filter;
      filter.resolution = resolution;
      const auto low = static_cast<double>(random() % 64),
                 size = static_cast<double>(random() % 40);
      if (random() % 4 != 0) filter.bounds = {{low, low / 2, 0}, {low + size, low + size, 50}};
      // A level is read if the one above is not fine enough.
      const int deepest = resolution == 0 ? 9 : resolution >= 8 ? 0 : resolution >= 4 ? 1 : 2;
      std::vector<glm::dvec3> expected;
      std::size_t row = 0, could = 0;
      for (const TestNode& node : octree.nodes) {
        const double side = 64.0 / (1 << node.level);
        const glm::dvec3 corner = side * glm::dvec3(node.x, node.y, node.z);
        const bool touches =
            !filter.bounds || (glm::all(glm::lessThanEqual(corner, filter.bounds->high)) &&
                               glm::all(glm::greaterThanEqual(corner + side, filter.bounds->low)));
        if (touches && node.level <= deepest) could += node.points;
        for (std::size_t i = 0; i < node.points; ++i, ++row) {
          const glm::dvec3& p = all.positions[row];
          const bool inside =
              !filter.bounds || (glm::all(glm::lessThanEqual(p, filter.bounds->high)) &&
                                 glm::all(glm::greaterThanEqual(p, filter.bounds->low)));
          if (inside && node.level <= deepest) expected.push_back(p);
        }
      }
      EXPECT_TRUE(read(octree.bytes, filter).positions == expected) << resolution;
      const LasParts parts(ByteSource({"made", octree.bytes}), filter);
      std::uint64_t rows = 0;
      for (std::size_t i = 0; i < parts.parts(); ++i) rows += parts.most_rows(i);
      EXPECT_EQ(rows, filter.keeps_all() ? all.size() : could);
    }
  }
}

TEST(Copc, RefusesOctreesThatCannotBe) {
  std::mt19937 random(1);
  const Octree octree = make_octree(random);
  PointFilter filter;
  filter.resolution = 1;
  const auto complaint = [&](std::size_t at, auto value) -> std::string {
    std::string bytes = octree.bytes;
    std::memcpy(&bytes[at], &value, sizeof value);
    EXPECT_EQ(read(bytes, {}).size(), read(octree.bytes, {}).size());  // nobody needs the octree
    try {
      read(bytes, filter);
    } catch (const files::FileError& error) {
      return error.what();
    }
    return "";
  };
  const std::size_t root = octree.bytes.size() - 10 * 32;
  const auto contains = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  contains(complaint(octree.root_place, std::uint64_t{1} << 60), "is not in the file");
  contains(complaint(octree.root_place + 8, std::uint64_t{1} << 60), "is not in the file");
  contains(complaint(octree.root_place + 8, std::uint64_t{0}), "is not in the file");
  contains(complaint(root, std::int32_t{40}), "cannot be");
  contains(complaint(root + 16, std::uint64_t{77}), "none of the file's chunks");
  contains(complaint(root + 28, std::int32_t{51}), "none of the file's chunks");
  contains(complaint(root + 28, std::int32_t{-7}), "cannot be");
  // A page that names itself.
  std::string loop = octree.bytes;
  const auto begin = static_cast<std::uint64_t>(root);
  std::memcpy(&loop[root + 9 * 32 + 16], &begin, sizeof begin);
  const std::int32_t size = 320;
  std::memcpy(&loop[root + 9 * 32 + 24], &size, sizeof size);
  EXPECT_THROW(read(loop, filter), files::FileError);
}

TEST(Copc, ReadsTheFileOfOthers) {
  const std::filesystem::path path =
      std::filesystem::path(DELRAY_SHARED_DATA) / "lone-star.copc.laz";
  if (!exists(path)) GTEST_SKIP() << "no " << path;
  const PointCloud all = read_points(path);
  PointFilter filter;
  filter.bounds = {{515390, 4918350, 2324}, {515395, 4918370, 2330}};
  std::vector<glm::dvec3> expected;
  for (const glm::dvec3& p : all.positions) {
    if (glm::all(glm::lessThanEqual(p, filter.bounds->high)) &&
        glm::all(glm::greaterThanEqual(p, filter.bounds->low))) {
      expected.push_back(p);
    }
  }
  EXPECT_GT(expected.size(), 1000U);
  const ByteSource source(path, {});
  EXPECT_TRUE(read_all(LasParts(source, filter), filter, {}).positions == expected);
  const LasParts some(source, filter);
  std::uint64_t rows = 0;
  for (std::size_t i = 0; i < some.parts(); ++i) rows += some.most_rows(i);
  EXPECT_LT(rows, all.size());
}

}  // namespace
}  // namespace delray::delaunay
