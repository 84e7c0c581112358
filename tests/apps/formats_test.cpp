// The table of formats in README.md against the tables of readers and writers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

#include "delaunay/read_mesh.h"
#include "delaunay/read_points.h"
#include "delaunay/write_mesh.h"
#include "delaunay/write_points.h"
#include "files/format.h"
#include "image/io.h"
#include "scenes/load.h"

using namespace delray;

namespace {

using Names = std::set<std::string>;

// Cells 1 and 2 of the row that begins with "| name |": what is read and what is written.
struct Row {
  Names read, written;
};
Row row(const std::string& name) {
  std::ifstream page(DELRAY_SOURCE_DIR "/README.md");
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("| " + name + " |")) continue;
    Names cells[3];
    std::istringstream text(line.substr(1));
    for (Names& names : cells) {
      std::string cell, word;
      std::getline(text, cell, '|');
      std::ranges::replace(cell, ',', ' ');
      for (std::istringstream words(cell); words >> word;) names.insert(word);
    }
    return {cells[1], cells[2]};
  }
  ADD_FAILURE() << "README.md has no row " << name;
  return {};
}

Names names_of(const auto& table) {
  Names names;
  for (const auto& entry : table) names.emplace(entry.name);
  return names;
}

// ".png .jpg" as PNG, JPG.
Names formats(const std::string& suffixes) {
  Names names;
  std::istringstream words(suffixes);
  for (std::string word; words >> word;) {
    std::ranges::transform(word, word.begin(), [](unsigned char c) { return std::toupper(c); });
    names.insert(word.substr(1));
  }
  return names;
}

}  // namespace

TEST(Formats, ReadmeNamesThoseOfTheTables) {
  EXPECT_EQ(row("scenes").read, names_of(scenes::scene_readers()));
  EXPECT_EQ(row("points").read, names_of(delaunay::point_readers()));
  EXPECT_EQ(row("points").written, names_of(delaunay::point_writers()));
  EXPECT_EQ(row("meshes").read, names_of(delaunay::mesh_readers()));
  EXPECT_EQ(row("meshes").written, names_of(delaunay::mesh_writers()));
  EXPECT_EQ(row("pictures").read, formats(files::suffixes(files::Format::image)));
  std::string written;
  for (const char* suffix : image::picture_suffixes()) written += std::string(suffix) + " ";
  EXPECT_EQ(row("pictures").written, formats(written));
}
