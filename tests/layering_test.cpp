// The folders and who may include whom (README.md, "Architecture"): any other arrow fails here.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

const Names kAnybody = {"geometry", "files"};  // what everyone may include
const Names kTop = {"apps", "bench", "tests"};

// What each folder may include besides itself and kAnybody.
const std::map<std::string, Names>& arrows() {
  static const std::map<std::string, Names> table = [] {
    std::map<std::string, Names> t = {
        {"geometry", {}},
        {"files", {}},
        {"parallel", {}},
        {"comm", {"parallel"}},
        {"image", {"parallel"}},
        {"loadbalance", {"parallel", "comm"}},
        {"scenes", {"image", "parallel"}},
        {"delaunay", {"parallel", "loadbalance", "comm"}},
        {"shading", {"scenes", "image", "parallel"}},
        {"composite", {"image", "comm", "parallel"}},
        {"raytrace", {"shading", "scenes", "image", "loadbalance", "comm", "parallel"}},
        {"raster", {"composite", "shading", "scenes", "image", "loadbalance", "comm", "parallel"}},
    };
    Names lower;
    for (const auto& [folder, ignored] : t) lower.insert(folder);
    t["apps"] = lower;
    lower.insert("apps");
    t["bench"] = lower;
    lower.insert("bench");
    t["tests"] = lower;
    return t;
  }();
  return table;
}

// "folder/name.h" of every include of this project in a file.
std::vector<std::string> includes(const fs::path& file) {
  static const std::regex pattern(R"(^\s*#\s*include\s*\"([^\"]+)\")");
  std::ifstream in(file);
  std::vector<std::string> found;
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_search(line, match, pattern)) found.push_back(match[1]);
  }
  return found;
}

template <class F>
void for_each_source(F&& f) {
  for (const auto& [folder, allowed] : arrows()) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(DELRAY_SOURCE_DIR) / folder)) {
      const std::string suffix = entry.path().extension();
      if (suffix == ".h" || suffix == ".cpp") f(folder, allowed, entry.path());
    }
  }
}

}  // namespace

TEST(Layering, OnlyAllowedArrows) {
  int files = 0;
  for_each_source([&](const std::string& folder, const Names& allowed, const fs::path& file) {
    ++files;
    for (const std::string& include : includes(file)) {
      const std::string target = include.substr(0, include.find('/'));
      const bool fine = target == folder || kAnybody.contains(target) || allowed.contains(target);
      // geometry and files may not lean on each other.
      const bool foundation = kAnybody.contains(folder) && target != folder;
      EXPECT_TRUE(fine && !foundation) << file << " may not include \"" << include << "\"";
    }
  });
  EXPECT_GT(files, 20);
}

TEST(Layering, IncludesAreRootedAndExist) {
  for_each_source([&](const std::string&, const Names&, const fs::path& file) {
    for (const std::string& include : includes(file)) {
      EXPECT_TRUE(fs::exists(fs::path(DELRAY_SOURCE_DIR) / include))
          << file << " includes \"" << include << "\"";
    }
  });
}

TEST(Layering, PrivateHeadersStayInTheirFolder) {
  for_each_source([&](const std::string& folder, const Names&, const fs::path& file) {
    for (const std::string& include : includes(file)) {
      if (include.find("/internal/") == std::string::npos || folder == "tests") continue;
      EXPECT_EQ(include.substr(0, include.find('/')), folder) << file << ": " << include;
    }
  });
}
