// delray completion and delray manual: made of the help texts, in the shells themselves.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

#include "loadbalance/partition.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " > /dev/null").c_str()) == 0;
}

// What bash offers for the last of the words.
std::set<std::string> offered(const Folder& folder, const std::string& words, int count) {
  const Ran ran = run("delray completion bash > c.bash && bash -c 'source c.bash; COMP_WORDS=(" +
                          words + "); COMP_CWORD=" + std::to_string(count - 1) +
                          "; _delray; printf \"%s\\n\" \"${COMPREPLY[@]}\"'",
                      folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  std::set<std::string> result;
  std::istringstream text(ran.out);
  for (std::string word; std::getline(text, word);) result.insert(word);
  return result;
}

TEST(Completion, BashOffersCommandsOptionsAndNames) {
  const Folder folder;
  EXPECT_EQ(offered(folder, "delray tri", 2), std::set<std::string>{"triangulate"});
  EXPECT_EQ(offered(folder, "delray compare \"\"", 3).count("compose"), 1U);
  EXPECT_EQ(offered(folder, "delray render x.glb --stra", 4), std::set<std::string>{"--strategy"});
  EXPECT_EQ(offered(folder, "delray render --engine ray", 4), std::set<std::string>{"raytrace"});
  const std::set<std::string> partitions = offered(folder, "delray render --partition \"\"", 4);
  EXPECT_EQ(partitions.size(), loadbalance::partitioners().size());
  for (const auto& partitioner : loadbalance::partitioners())
    EXPECT_EQ(partitions.count(partitioner.name), 1U) << partitioner.name;
}

TEST(Completion, BashOffersFilesWithSpacesInTheirNames) {
  const Folder folder;
  for (const std::string name : {"my scene.obj", "my other scene.obj", "yours.obj"})
    folder.write(name, "");
  const std::set<std::string> mine = {"my scene.obj", "my other scene.obj"};
  EXPECT_EQ(offered(folder, "delray render my", 3), mine);
  EXPECT_EQ(offered(folder, "delray render -o my", 4), mine);
}

TEST(Completion, BashOffersNamesAndFilesWhereAnOptionTakesBoth) {
  const Folder folder;
  folder.write("dusk.exr", "");
  EXPECT_EQ(offered(folder, "delray render --light d", 4),
            (std::set<std::string>{"default", "dusk.exr"}));
}

TEST(Completion, BashOffersWhatLeavesTheChoiceToTheProgram) {
  const Folder folder;
  for (const std::string words : {"render --background", "render --background au",
                                  "triangulate --order", "triangulate --method a"}) {
    const bool begun = words.back() == 'a' || words.back() == 'u';
    EXPECT_EQ(offered(folder, "delray " + words + (begun ? "" : " \"\""), 4).count("auto"), 1U)
        << words;
  }
  EXPECT_EQ(offered(folder, "delray generate points uni", 4), std::set<std::string>{"uniform"});
}

struct Completed {
  std::string command, option;
  std::set<std::string> names;
};

// The options that take values, and what the script for bash offers for them.
std::vector<Completed> completed_options(const Folder& folder) {
  const Ran ran = run("delray completion bash", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  const std::regex line(R"(^ *'([a-z ]*):(--[a-z-]+)'\) _delray_(files|words '([^']*)');.*)");
  std::vector<Completed> result;
  std::istringstream script(ran.out);
  std::smatch match;
  for (std::string text; std::getline(script, text);) {
    if (!std::regex_match(text, match, line)) continue;
    std::istringstream words(match[4].str());
    Completed one{match[1].str(), match[2].str(), {}};
    for (std::string word; words >> word;) one.names.insert(word);
    result.push_back(one);
  }
  return result;
}

// An option that refuses a value because it is not among some names offers these, and no others.
TEST(Completion, OffersWhatOptionsTakeAndNothingElse) {
  const Folder folder;
  folder.write("p.xyz", "0 0 0\n1 0 1\n0 1 0\n");
  const std::map<std::string, std::string> arguments = {
      {"render", "gen:cornell:100 --size 8x8 -o a.png "},
      {"triangulate", "p.xyz -o a.ply "},
      {"verify", "a.ply --points p.xyz "},
      {"compose", "p.exr -o a.png "},
      {"generate points", "uniform -o a.ply "},
      {"generate outline", "lake -o a.poly "},
      {"generate scene", "terrain -n 100 -o a.glb "},
      {"compare compose", "gen:cornell:100 --quick --size 8x8 -o a.html "},
      {"compare partition", "gen:cornell:100 --quick --size 8x8 -o a.html "},
      {"compare schedule", "gen:cornell:100 --quick --size 8x8 -o a.html "},
      {"compare triangulate", "p.xyz --quick -o a.html "},
      {"similar", "gen:cornell --to gen:cornell "},
      {"replay", "p.json "}};
  int choosing = 0;
  for (const Completed& completed : completed_options(folder)) {
    const auto found = arguments.find(completed.command);
    const bool is_file = completed.option == "--output" || completed.option == "--stats";
    if (found == arguments.end() || is_file) continue;
    std::string command = "delray " + completed.command + " " + found->second;
    if (completed.option == "--size") command = "delray " + completed.command + " gen:cornell ";
    command += completed.option + " no-such-value";
    SCOPED_TRACE(command);
    const Ran ran = run(command, folder.path());
    const bool told = ran.err.find(" is not one of ") != std::string::npos ||
                      ran.err.find(" not in {") != std::string::npos;
    EXPECT_EQ(told, !completed.names.empty()) << ran.err;
    EXPECT_TRUE(!told || ran.exit_code == 2) << ran.exit_code;
    for (const std::string& name : completed.names)
      EXPECT_NE(ran.err.find(name), std::string::npos) << name << "\n" << ran.err;
    choosing += told ? 1 : 0;
  }
  EXPECT_GE(choosing, 40);
}

TEST(Completion, OtherShellsCanReadTheirs) {
  const Folder folder;
  int read = 0;
  for (const std::string shell : {"zsh", "fish"}) {
    const Ran ran = run("delray completion " + shell + " > c." + shell, folder.path());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_NE(folder.read("c." + shell).find("partition"), std::string::npos);
    if (!is_installed(shell)) continue;
    ++read;
    const Ran checked = run(shell + " -n c." + shell, folder.path());
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
  }
  if (read < 2) GTEST_SKIP() << "zsh and fish are not both installed: not read by them";
}

TEST(Completion, RefusesOtherShells) {
  const Folder folder;
  EXPECT_EQ(run("delray completion csh", folder.path()).exit_code, 2);
}

TEST(Manual, TellsNamesOnce) {
  const Folder folder;
  const Ran ran = run("delray manual", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  std::istringstream page(ran.out);
  int entries = 0;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("\\fB\\-\\-engine")) continue;
    ++entries;
    std::getline(page, line);
    EXPECT_EQ(line.find("raytrace"), line.rfind("raytrace")) << line;
    EXPECT_NE(line.find("raytrace"), std::string::npos) << line;
  }
  EXPECT_GE(entries, 1);
}

TEST(Manual, TellsOfEveryCommandAndReadsWithoutComplaint) {
  const Folder folder;
  const Ran ran = run("delray manual", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  for (const char* part :
       {".TH DELRAY 1", ".SS delray compare compose", "\\-\\-partition", "sort\\-first",
        ".SH EXIT STATUS", "\\fIFILE\\fR", "[1 to 64]", "delray render"})
    EXPECT_NE(ran.out.find(part), std::string::npos) << part;
  if (!is_installed("groff")) GTEST_SKIP() << "groff is not installed: not read by it";
  const Ran read = run("delray manual | groff -man -Tutf8 -ww -z", folder.path());
  EXPECT_EQ(read.exit_code, 0);
  EXPECT_EQ(read.err, "");
}

}  // namespace
}  // namespace delray::tests
