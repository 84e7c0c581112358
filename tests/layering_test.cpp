// The folders and who may include whom (docs/architecture.md): any other arrow fails here.
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
const Names kTop = {"apps", "python", "bench", "tests"};

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
        {"scenes", {"image", "comm", "parallel"}},
        {"packs", {"scenes", "image", "parallel"}},
        {"delaunay", {"parallel", "loadbalance", "comm"}},
        {"shading", {"scenes", "image", "parallel"}},
        {"composite", {"image", "comm", "parallel"}},
        {"raytrace", {"shading", "packs", "scenes", "image", "loadbalance", "comm", "parallel"}},
        {"raster",
         {"composite", "shading", "packs", "scenes", "image", "loadbalance", "comm", "parallel"}},
    };
    Names lower;
    for (const auto& [folder, ignored] : t) lower.insert(folder);
    t["c"] = lower;  // the doors: no algorithms of their own
    for (const std::string& name : kAnybody) t["c"].erase(name);
    t["icet"] = {"composite", "image", "comm", "parallel"};
    t["apps"] = lower;
    lower.insert("apps");
    t["python"] = lower;
    lower.insert("c");
    lower.insert("icet");
    lower.insert("python");
    t["bench"] = lower;
    lower.insert("bench");
    t["tests"] = lower;
    return t;
  }();
  return table;
}

// What each sub-folder may include of its folder's others, besides what lies directly in the
// folder. Those that are not here include none.
const std::map<std::string, Names> kArrowsWithin = {
    {"apps/options", {"terminal"}},
    {"apps/input", {"options"}},
    {"apps/output", {"input", "options"}},
    {"apps/pack", {"input"}},
    {"apps/render", {"input", "options"}},
    {"apps/replay", {"options", "terminal"}},
    {"apps/similar", {"input", "options", "terminal"}},
    {"apps/triangulate", {"input", "options", "output", "terminal"}},
    {"apps/verify", {"input", "options", "terminal"}},
    {"apps/view", {"input", "options", "render", "report"}},
    {"apps/compare", {"input", "options", "render", "report", "terminal"}},
    {"comm/in_process", {"transport"}},
    {"comm/mpi", {"transport"}},
    {"composite/layers", {"schemes"}},
    {"delaunay/predicates", {"mesh"}},
    {"delaunay/order", {"mesh", "predicates"}},
    {"delaunay/insertion", {"mesh", "order", "predicates"}},
    {"delaunay/construction", {"flip", "insertion", "mesh", "order", "predicates", "tiles"}},
    {"delaunay/dimensions", {"construction", "mesh", "predicates"}},
    {"delaunay/flip", {"insertion", "mesh", "predicates"}},
    {"delaunay/history", {"flip", "insertion", "mesh", "predicates"}},
    {"delaunay/cavity", {"construction", "flip", "insertion", "mesh", "order", "predicates"}},
    {"delaunay/divide_and_conquer", {"flip", "mesh", "order", "predicates"}},
    {"delaunay/dynamic", {"flip", "insertion", "mesh", "predicates"}},
    {"delaunay/natural_neighbours", {"insertion", "mesh", "predicates"}},
    {"delaunay/files", {"mesh"}},
    {"delaunay/pieces", {"files"}},
    {"delaunay/outlines", {"files", "mesh"}},
    {"delaunay/refinement", {"distributed", "flip", "insertion", "mesh", "predicates"}},
    {"delaunay/points", {"cavity", "flip", "insertion", "mesh", "order", "predicates"}},
    {"delaunay/queries", {"mesh"}},
    {"delaunay/tiles", {"mesh"}},
    {"delaunay/raster", {"mesh", "natural_neighbours", "tiles"}},
    {"delaunay/verify", {"files", "mesh"}},
    {"delaunay/distributed", {"construction", "insertion", "mesh", "predicates", "tiles"}},
    {"packs/build", {"format"}},
    {"raster/shading", {"pipeline"}},
    {"raster/distribute", {"pipeline", "shading"}},
    {"raster/packed", {"distribute", "pipeline"}},
    {"raster/strategies", {"distribute", "packed", "pipeline"}},
    {"raytrace/sampling", {"scene"}},
    {"raytrace/first_hits", {"scene"}},
    {"raytrace/integrators", {"first_hits", "sampling", "scene"}},
    {"raytrace/clusters", {"scene"}},
    {"raytrace/distributed", {"clusters", "first_hits", "integrators", "scene"}},
    {"scenes/animation", {"geometry"}},
    {"scenes/files", {"geometry"}},
    {"scenes/generators", {"animation", "geometry"}},
    {"scenes/gltf", {"animation", "files", "geometry"}},
    {"scenes/parts", {"files", "geometry"}},
};

// "folder/sub-folder" of a path in the tree, nothing where it lies directly in the folder.
std::string sub_folder(const std::string& path) {
  const std::size_t first = path.find('/'), second = path.find('/', first + 1);
  return second == std::string::npos ? std::string() : path.substr(0, second);
}

std::string in_tree(const fs::path& file) {
  return fs::relative(file, DELRAY_SOURCE_DIR).generic_string();
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

TEST(Layering, OnlyAllowedArrowsWithinFolders) {
  for_each_source([&](const std::string& folder, const Names&, const fs::path& file) {
    const std::string from = sub_folder(in_tree(file));
    if (from.empty() || folder == "tests" || folder == "bench") return;
    const auto allowed = kArrowsWithin.find(from);
    for (const std::string& include : includes(file)) {
      const std::string to = sub_folder(include);
      if (to.empty() || to == from || !include.starts_with(folder + "/")) continue;
      const bool fine =
          allowed != kArrowsWithin.end() && allowed->second.contains(to.substr(folder.size() + 1));
      EXPECT_TRUE(fine) << file << " may not include \"" << include << "\"";
    }
  });
}

// A header directly in a folder is for everybody, one in a sub-folder for its folder alone.
TEST(Layering, PrivateHeadersStayInTheirFolder) {
  for_each_source([&](const std::string& folder, const Names&, const fs::path& file) {
    if (folder == "tests" || folder == "bench") return;
    for (const std::string& include : includes(file)) {
      // A door that shares what the program is made of.
      if (folder == "python" && include.starts_with("apps/")) continue;
      if (!sub_folder(include).empty()) {
        EXPECT_EQ(include.substr(0, include.find('/')), folder) << file << ": " << include;
      }
    }
  });
}

// A folder that is larger has a part that deserves a name.
TEST(Layering, FoldersAreSmallEnoughToLookThrough) {
  constexpr int kMost = 40;
  std::map<std::string, int> files;
  for (const auto& [folder, ignored] : arrows()) {
    const fs::path top = fs::path(DELRAY_SOURCE_DIR) / folder;
    if (folder == "tests") continue;  // some have corpora
    for (const auto& entry : fs::recursive_directory_iterator(top)) {
      if (entry.is_regular_file()) ++files[in_tree(entry.path().parent_path())];
    }
  }
  for_each_source([&](const std::string& folder, const Names&, const fs::path& file) {
    if (folder == "tests") ++files[in_tree(file.parent_path())];
  });
  EXPECT_GT(files.size(), 12);
  for (const auto& [folder, count] : files) EXPECT_LE(count, kMost) << folder;
}

// The rows "| `folder/` | content | one, two |"; an empty cell stands for nothing.
TEST(Layering, ArchitectureTellsTheSameArrows) {
  static const std::regex row(R"(\| `([a-z]+)/` \| [^|]* \|([^|]*)\|)");
  static const std::regex word("[a-z]+");
  std::ifstream page(fs::path(DELRAY_SOURCE_DIR) / "docs/architecture.md");
  Names told;
  std::smatch match;
  for (std::string line; std::getline(page, line);) {
    if (!std::regex_match(line, match, row)) continue;
    const std::string folder = match[1], cell = match[2];
    ASSERT_TRUE(arrows().contains(folder)) << folder;
    told.insert(folder);
    if (cell == " all of the above ") {
      EXPECT_TRUE(kTop.contains(folder)) << folder;
      continue;
    }
    Names names;
    for (std::sregex_iterator at(cell.begin(), cell.end(), word), end; at != end; ++at) {
      names.insert(at->str());
    }
    EXPECT_EQ(names, arrows().at(folder)) << folder;
  }
  EXPECT_EQ(told.size(), arrows().size());
}

// The rows "| `folder/` | `one/` what it holds; `two/` ... |" name every sub-folder with sources.
TEST(Layering, ArchitectureNamesEverySubFolder) {
  static const std::regex row(R"(\| `([a-z]+)/` \|([^|]*)\|)"), name("`([a-z_]+)/`");
  std::ifstream page(fs::path(DELRAY_SOURCE_DIR) / "docs/architecture.md");
  Names told, there;
  std::smatch match;
  for (std::string line; std::getline(page, line);) {
    if (!std::regex_match(line, match, row)) continue;
    const std::string folder = match[1], cell = match[2];
    for (std::sregex_iterator at(cell.begin(), cell.end(), name), end; at != end; ++at) {
      told.insert(folder + "/" + (*at)[1].str());
    }
  }
  for_each_source([&](const std::string& folder, const Names&, const fs::path& file) {
    const std::string part = sub_folder(in_tree(file));
    if (!part.empty() && folder != "tests" && folder != "bench") there.insert(part);
  });
  EXPECT_EQ(told, there);
}

// What a source is for is said before what it includes.
TEST(Layering, EverySourceBeginsWithAComment) {
  for_each_source([&](const std::string& folder, const Names&, const fs::path& file) {
    if (folder == "tests") return;  // the names of tests say it
    std::ifstream in(file);
    std::string first;
    std::getline(in, first);
    EXPECT_TRUE(first.starts_with("// ")) << in_tree(file) << ": " << first;
  });
}
