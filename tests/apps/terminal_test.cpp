// What the program shows on a terminal, which script(1) makes, and what it writes to a file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

bool has_script() { return std::system("script --version >/dev/null 2>&1") == 0; }

// `arguments` of delray on a terminal of so many columns; both streams, as the terminal gets them.
Ran run_on_terminal(const std::string& arguments, int columns, const Folder& folder) {
  return run("script --return --quiet --command 'stty cols " + std::to_string(columns) + "; " +
                 DELRAY_PROGRAM + " " + arguments + "' typescript",
             folder.path());
}

std::size_t longest_line(const std::string& text) {
  std::istringstream lines(text);
  std::size_t longest = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    longest = std::max(longest, line.size());
  }
  return longest;
}

// What stays on the terminal: of each line what follows the last time that it was cleared.
std::string visible(const std::string& text) {
  const std::string clear = "\r\x1b[K";
  std::istringstream lines(text);
  std::string stays;
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    const std::size_t cleared = line.rfind(clear);
    stays += cleared == std::string::npos ? line : line.substr(cleared + clear.size());
    stays += '\n';
  }
  return stays;
}

TEST(Terminal, ListsHaveHeadingsThereAlone) {
  if (!has_script()) GTEST_SKIP() << "script(1) is not installed";
  const Folder folder;
  for (const std::string arguments :
       {"render --list", "compose --list", "info --list", "triangulate --list",
        "compare schedule --list", "generate scene --list"}) {
    const Ran shown = run_on_terminal(arguments, 72, folder);
    ASSERT_EQ(shown.exit_code, 0) << shown.out;
    EXPECT_NE(shown.out.find(":\r\n  "), std::string::npos) << shown.out;
    EXPECT_EQ(shown.out.find('\t'), std::string::npos) << shown.out;
    EXPECT_LE(longest_line(shown.out), 72U) << shown.out;
    const Ran plain = run("delray " + arguments, folder.path());
    EXPECT_EQ(plain.out.find(":\n"), std::string::npos) << plain.out;
    EXPECT_EQ(std::count(plain.out.begin(), plain.out.end(), '\n'),
              std::count(plain.out.begin(), plain.out.end(), '\t'));
  }
  const Ran render = run_on_terminal("render --list", 72, folder);
  for (const std::string option :
       {"--strategy", "--partition", "--compose", "--codec", "--integrator", "--data", "--schedule",
        "--color-by", "--tone"}) {
    EXPECT_NE(render.out.find("(" + option + "):"), std::string::npos) << option;
  }
  const Ran triangulate = run_on_terminal("triangulate --list", 72, folder);
  for (const std::string option :
       {"--method", "--location", "--split", "--order", "--deadlocks", "--locks", "--unlock"}) {
    EXPECT_NE(triangulate.out.find("(" + option + "):"), std::string::npos) << option;
  }
}

TEST(Terminal, TablesFit) {
  if (!has_script()) GTEST_SKIP() << "script(1) is not installed";
  const Folder folder;
  const std::string compare =
      "compare partition gen:terrain:1000 --size 32x32 --quick --partition mahd --regions 1 "
      "--ranks 2";
  const Ran narrow = run_on_terminal(compare + " -q", 70, folder);
  ASSERT_EQ(narrow.exit_code, 0) << narrow.out;
  EXPECT_LE(longest_line(narrow.out), 70U) << narrow.out;
  const Ran wide = run("delray " + compare + " -q", folder.path());
  EXPECT_GT(longest_line(wide.out), 100U) << wide.out;
  EXPECT_EQ(std::count(wide.out.begin(), wide.out.end(), '\n'), 2) << wide.out;
  std::istringstream headings(wide.out.substr(0, wide.out.find('\n')));
  for (std::string word; headings >> word;)
    EXPECT_NE(narrow.out.find(word), std::string::npos) << word;
}

// Sampling takes longer than the second after which a bar appears.
TEST(Terminal, BarsShareNoLineWithText) {
  if (!has_script()) GTEST_SKIP() << "script(1) is not installed";
  const Folder folder;
  const Ran ran = run_on_terminal(
      "render gen:cornell -o a.png --size 64x64 --engine raytrace --integrator path --time 3 "
      "--stats -",
      80, folder);
  ASSERT_EQ(ran.exit_code, 0) << ran.out;
  ASSERT_NE(ran.out.find("render: ["), std::string::npos) << ran.out;
  EXPECT_EQ(visible(ran.out).find("render: ["), std::string::npos) << visible(ran.out);
  EXPECT_NE(visible(ran.out).find("\n  \"schema\""), std::string::npos) << visible(ran.out);
}

TEST(Terminal, InfoListsTheFormatsThatAreRead) {
  const Folder folder;
  const Ran listed = run("delray info --list", folder.path());
  ASSERT_EQ(listed.exit_code, 0) << listed.err;
  for (const std::string format :
       {"OBJ\t", "glTF\t", "STL\t", "LAS\t", "XYZ\t", "VTU\t", ".png", ".exr", "NODE+ELE\t"}) {
    EXPECT_NE(listed.out.find(format), std::string::npos) << format << "\n" << listed.out;
  }
  EXPECT_EQ(run("delray info", folder.path()).out, listed.out);
  const Ran help = run("delray info --help", folder.path());
  for (const std::string format : {"OBJ", "glTF", "STL", "LAS", "VTU", ".exr"})
    EXPECT_NE(help.out.find(format), std::string::npos) << format << "\n" << help.out;
}

}  // namespace
}  // namespace delray::tests
