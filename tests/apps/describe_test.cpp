// delray completion and delray manual: made of the help texts, in the shells themselves.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <sstream>

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

TEST(Manual, TellsOfEveryCommandAndReadsWithoutComplaint) {
  const Folder folder;
  const Ran ran = run("delray manual", folder.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  for (const char* part : {".TH DELRAY 1", ".SS delray compare compose", "\\-\\-partition",
                           "sort\\-first", ".SH EXIT STATUS", "delray render"})
    EXPECT_NE(ran.out.find(part), std::string::npos) << part;
  if (!is_installed("groff")) GTEST_SKIP() << "groff is not installed: not read by it";
  const Ran read = run("delray manual | groff -man -Tutf8 -ww -z", folder.path());
  EXPECT_EQ(read.exit_code, 0);
  EXPECT_EQ(read.err, "");
}

}  // namespace
}  // namespace delray::tests
