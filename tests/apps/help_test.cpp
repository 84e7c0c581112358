// Help pages: every option is told in plain words, under a heading, within the width of a page.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

const std::vector<std::string> kCommands = {"",
                                            "info",
                                            "generate",
                                            "generate points",
                                            "generate outline",
                                            "generate scene",
                                            "triangulate",
                                            "verify",
                                            "render",
                                            "view",
                                            "pack",
                                            "compose",
                                            "compare",
                                            "compare compose",
                                            "compare triangulate",
                                            "compare partition",
                                            "compare schedule",
                                            "replay",
                                            "similar",
                                            "completion",
                                            "manual"};

struct Entry {
  std::string heading, name, description;
};

// The entries of a help page: a name in the third column, and what it is beside or below it.
std::vector<Entry> entries_of(const std::string& page) {
  std::vector<Entry> entries;
  std::string heading;
  std::istringstream lines(page.substr(0, page.find("Examples:")));
  for (std::string line; std::getline(lines, line);) {
    const bool indented = line.starts_with("  ");
    if (!indented) {
      if (line.ends_with(':')) heading = line;
      continue;
    }
    if (line.size() > 2 && line[2] != ' ') {
      const std::size_t end = std::min(line.find("  ", 2), line.size());
      entries.push_back({heading, line.substr(2, end - 2), ""});
      line.erase(0, end);
    }
    const std::size_t text = line.find_first_not_of(' ');
    if (text == std::string::npos) continue;
    std::string& description = entries.back().description;
    description += (description.empty() ? "" : " ") + line.substr(text);
  }
  return entries;
}

TEST(Help, EveryEntryIsDescribedInPlainWords) {
  const Folder folder;
  for (const std::string& command : kCommands) {
    const Ran ran = run("delray " + command + " --help", folder.path());
    ASSERT_EQ(ran.exit_code, 0) << command;
    const std::vector<Entry> entries = entries_of(ran.out);
    EXPECT_GE(entries.size(), 1U) << command << ran.out;
    for (const Entry& entry : entries) {
      const std::string& text = entry.description;
      EXPECT_GE(text.size(), 6U) << command << " " << entry.name;
      EXPECT_TRUE(std::isupper(static_cast<unsigned char>(text[0])))
          << command << " " << entry.name << ": " << text;
      EXPECT_FALSE(text.ends_with('.')) << command << " " << entry.name << ": " << text;
      EXPECT_GT(entry.heading.size(), 1U) << command << " " << entry.name;
      EXPECT_EQ(text.find("(default "), std::string::npos) << "a colon: " << text;
      EXPECT_EQ(entry.name.find(':'), std::string::npos) << "a placeholder: " << entry.name;
    }
  }
}

TEST(Help, FitsAPage) {
  const Folder folder;
  for (const std::string& command : kCommands) {
    const Ran ran = run("delray " + command + " --help", folder.path());
    std::istringstream lines(ran.out.substr(0, ran.out.find("Examples:")));
    for (std::string line; std::getline(lines, line);)
      EXPECT_LE(line.size(), 80U) << command << ": " << line;
  }
}

TEST(Help, LongPagesHaveHeadings) {
  const Folder folder;
  const Ran ran = run("delray render --help", folder.path());
  std::size_t last = 0;
  for (const std::string heading :
       {"Input:", "Output:", "Picture:", "Camera and animation:", "Parallel run:",
        "Parallel run: which rank does what:", "Rasterizer (--engine raster):",
        "Ray tracer (--engine raytrace):", "General:"}) {
    const std::size_t at = ran.out.find("\n" + heading + "\n");
    ASSERT_NE(at, std::string::npos) << heading;
    EXPECT_GT(at, last) << heading;
    last = at;
  }
}

TEST(Help, NamesWhatIsLegal) {
  const Folder folder;
  const Ran ran = run("delray render --help", folder.path());
  for (const Entry& entry : entries_of(ran.out)) {
    if (entry.name == "--engine NAME") {
      EXPECT_NE(entry.description.find("raytrace"), std::string::npos);
    }
    if (entry.name == "--spp N") {
      EXPECT_EQ(entry.description, "Samples per pixel (default: 1) [1 to 65536]");
    }
    if (entry.name == "--codec NAME") {
      EXPECT_NE(entry.description.find("; one of active, bounds, lz4, dense"), std::string::npos)
          << entry.description;
    }
    if (entry.name == "--exaggeration X") {
      EXPECT_NE(entry.description.find("[above 0]"), std::string::npos) << entry.description;
    }
  }
  EXPECT_NE(ran.out.find("\n  --codec NAME "), std::string::npos);
  EXPECT_NE(ran.out.find("\n  --engine NAME "), std::string::npos);
  EXPECT_NE(ran.out.find("\n  -o, --output FILE "), std::string::npos);
  EXPECT_NE(ran.out.find("\n  --size WxH "), std::string::npos);
  EXPECT_NE(ran.out.find("\n  --spp N "), std::string::npos);
  EXPECT_NE(ran.out.find("\n  --exaggeration X "), std::string::npos);
}

TEST(Help, TellsSuffixesExitCodesAndRadices) {
  const Folder folder;
  const std::vector<std::pair<std::string, std::string>> told = {
      {"generate points", ".ply"},       {"generate points", ".csv"}, {"generate scene", ".glb"},
      {"verify", "exit code"},           {"render", "radix-k:4,2"},   {"compose", "radix-k:4,2"},
      {"compare compose", "radix-k:4,2"}};
  for (const auto& [command, what] : told) {
    std::string page;  // without what follows its entries: examples have suffixes, too
    for (const Entry& entry : entries_of(run("delray " + command + " --help", folder.path()).out)) {
      page += entry.description + "\n";
    }
    EXPECT_NE(page.find(what), std::string::npos) << command << page;
  }
}

}  // namespace
}  // namespace delray::tests
