// The documentation names files and folders of the tree: each must exist. The table of layers in
// docs/architecture.md must say what the test of layers says.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kTree = DELRAY_SOURCE_DIR;

std::string content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// The pages at the top of the tree and those of docs/.
std::vector<fs::path> pages() {
  std::vector<fs::path> found;
  for (const fs::path& folder : {kTree, kTree / "docs"}) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      // The log of changes names what there was.
      const fs::path& file = entry.path();
      if (file.extension() == ".md" && file.filename() != "CHANGELOG.md") found.push_back(file);
    }
  }
  return found;
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) {
    found.push_back((*at)[1]);
  }
  return found;
}

// "# How fast?" as links name it: "how-fast".
std::string anchor(const std::string& heading) {
  std::string name;
  for (const char c : heading) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_') {
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (c == ' ') {
      name += '-';
    }
  }
  return name;
}

bool has_heading(const fs::path& page, const std::string& wanted) {
  static const std::regex heading(R"((?:^|\n)#+ ([^\n]+))");
  for (const std::string& title : matches(content(page), heading)) {
    if (anchor(title) == wanted) return true;
  }
  return false;
}

// A path whose folder is of the tree, with a suffix or a slash at its end; NAME stands for any.
bool names_a_path(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos || slash == 0 || text.find("NAME") != std::string::npos) {
    return false;
  }
  static const std::regex path(R"([a-zA-Z0-9_./-]+(/|\.(h|cpp|py|md|txt|cmake)))");
  return std::regex_match(text, path) && fs::is_directory(kTree / text.substr(0, slash)) &&
         !text.starts_with("build/");
}

}  // namespace

TEST(Documentation, LinksLeadToPagesAndHeadings) {
  static const std::regex link(R"(\]\(([^)\s]+)\))");
  int links = 0;
  for (const fs::path& page : pages()) {
    for (const std::string& target : matches(content(page), link)) {
      if (target.find("://") != std::string::npos) continue;
      ++links;
      const std::size_t hash = target.find('#');
      const std::string name = target.substr(0, hash);
      const fs::path file = name.empty() ? page : page.parent_path() / name;
      EXPECT_TRUE(fs::exists(file)) << page << " links to " << target;
      if (hash != std::string::npos && fs::exists(file)) {
        EXPECT_TRUE(has_heading(file, target.substr(hash + 1))) << page << " links to " << target;
      }
    }
  }
  EXPECT_GT(links, 20);
}

TEST(Documentation, FilesAndFoldersThatItNamesExist) {
  static const std::regex code("`([^`\n]+)`");
  int paths = 0;
  for (const fs::path& page : pages()) {
    for (const std::string& name : matches(content(page), code)) {
      if (!names_a_path(name)) continue;
      ++paths;
      EXPECT_TRUE(fs::exists(kTree / name)) << page << " names " << name;
    }
  }
  EXPECT_GT(paths, 50);
}

TEST(Documentation, IndexHasEveryPage) {
  const std::string index = content(kTree / "docs/README.md");
  for (const fs::path& page : pages()) {
    const std::string name = page.filename().string();
    if (name == "README.md") continue;
    EXPECT_NE(index.find(name + ")"), std::string::npos) << name;
  }
}

// A public type is one that begins in the first column of a header directly in a library's folder.
TEST(Documentation, EveryPublicTypeHasAComment) {
  static const std::regex type(R"((struct|class|enum class) (alignas\(\d+\) )?\w+.*\{.*)");
  int types = 0;
  for (const auto& folder : fs::directory_iterator(kTree)) {
    if (!fs::exists(folder.path() / "CMakeLists.txt") || folder.path().filename() == "tests") {
      continue;
    }
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() != ".h") continue;
      std::ifstream header(entry.path());
      std::string before;
      for (std::string line; std::getline(header, line); before = line) {
        if (!std::regex_match(line, type)) continue;
        ++types;
        const bool told = before.starts_with("//") || before.starts_with("template");
        EXPECT_TRUE(told) << entry.path() << ": " << line;
      }
    }
  }
  EXPECT_GT(types, 100);
}
