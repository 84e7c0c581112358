#include "comm/network_file.h"

#include <gtest/gtest.h>

#include "files/error.h"

namespace delray::comm {
namespace {

TEST(NetworkFile, EveryRowOfTheTableIsReadBackFromItsText) {
  for (const NamedNetwork& row : networks()) {
    const NamedNetwork read = parse_network(network_text(row), "a.json");
    EXPECT_EQ(read.name, row.name);
    EXPECT_EQ(read.description, row.description);
    EXPECT_EQ(read.network.latency, row.network.latency);
    EXPECT_EQ(read.network.overhead, row.network.overhead);
    EXPECT_EQ(read.network.hop_seconds, row.network.hop_seconds);
    EXPECT_DOUBLE_EQ(read.network.seconds_per_byte, row.network.seconds_per_byte);
    EXPECT_DOUBLE_EQ(read.network.copy_seconds_per_byte, row.network.copy_seconds_per_byte);
    EXPECT_EQ(read.network.topology.shape, row.network.topology.shape);
  }
}

TEST(NetworkFile, ReadsEachKey) {
  const NamedNetwork read = parse_network(
      R"({"schema": "delray.network/1", "topology": "grid", "sides": [16, 64], "latency": 3e-5,
          "hop_latency": 4e-8, "overhead": 0, "bytes_per_second": 2e8,
          "copy_bytes_per_second": 1e8, "shared_cores": 2})",
      "folder/paragon.json");
  EXPECT_EQ(read.name, "paragon");
  EXPECT_EQ(read.network.topology.sides, (std::vector{16, 64}));
  EXPECT_EQ(read.network.hop_seconds, 4e-8);
  EXPECT_EQ(read.network.overhead, 0);
  EXPECT_EQ(read.network.seconds_per_byte, 5e-9);
  EXPECT_EQ(read.network.copy_seconds_per_byte, 1e-8);
  EXPECT_EQ(read.network.shared_cores, 2);
}

TEST(NetworkFile, ErrorsNameFileAndPlace) {
  const std::string begin = R"({"schema": "delray.network/1", )";
  const std::string rest = R"("latency": 1, "overhead": 0, "bytes_per_second": 1)";
  const struct {
    std::string text, place;
  } cases[] = {
      {"{\n\n]", "line 3"},
      {"[]", ""},
      {"{}", "\"schema\""},
      {begin + rest + "}", "\"topology\""},
      {begin + rest + R"(, "topology": "star"})", "\"topology\""},
      {begin + rest + R"(, "topology": 3})", "\"topology\""},
      {begin + R"("topology": "ring", "overhead": 0, "bytes_per_second": 1})", "\"latency\""},
      {begin + R"("topology": "ring", "latency": -1, "overhead": 0, "bytes_per_second": 1})",
       "\"latency\""},
      {begin + R"("topology": "ring", "latency": 0, "overhead": 0, "bytes_per_second": 0})",
       "\"bytes_per_second\""},
      {begin + R"("topology": "ring", "latency": 0, "overhead": "", "bytes_per_second": 1})",
       "\"overhead\""},
      {begin + rest + R"(, "topology": "ring", "sides": [4]})", "\"sides\""},
      {begin + rest + R"(, "topology": "grid", "sides": []})", "\"sides\""},
      {begin + rest + R"(, "topology": "grid", "sides": [4, 0.5]})", "\"sides[1]\""},
      {begin + rest + R"(, "topology": "grid", "arity": 4})", "\"arity\""},
      {begin + rest + R"(, "topology": "tree", "arity": 1})", "\"arity\""},
      {begin + rest + R"(, "topology": "bus", "hop_latency": 1})", "\"hop_latency\""},
      {begin + rest + R"(, "topology": "bus", "channels": -1})", "\"channels\""},
      {begin + rest + R"(, "topology": "bus", "lanes": 1})", "\"lanes\""},
  };
  for (const auto& one : cases) {
    try {
      parse_network(one.text, "a.json");
      ADD_FAILURE() << one.text;
    } catch (const files::FileError& error) {
      EXPECT_EQ(error.cause(), files::Cause::input);
      EXPECT_EQ(error.file(), "a.json");
      EXPECT_EQ(error.place(), one.place) << one.text << '\n' << error.what();
    }
  }
}

}  // namespace
}  // namespace delray::comm
