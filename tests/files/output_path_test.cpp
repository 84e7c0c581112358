// Outputs never follow links that somebody else planted.
#include "files/output_path.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "files/atomic_file.h"
#include "files/error.h"
#include "tests/support/temporary_folder.h"

namespace delray::files {
namespace {

namespace fs = std::filesystem;
using tests::TemporaryFolder;

constexpr uid_t kSomebodyElse = 65534;

void expect_refused(const fs::path& path) {
  for (void (*refuse)(const fs::path&) : {+[](const fs::path& name) { check_writable(name); },
                                          +[](const fs::path& name) { write_file(name, "x"); }}) {
    try {
      refuse(path);
      ADD_FAILURE() << path;
    } catch (const FileError& error) {
      EXPECT_EQ(error.cause(), Cause::device) << path;
      EXPECT_EQ(error.file(), path.string());
    }
  }
}

TEST(OutputPath, TellsBeforehandWhereNothingCanBeWritten) {
  const TemporaryFolder folder;
  folder.write("a.txt", "old");
  for (const fs::path& path : {folder / "a.txt", folder / "new.txt", fs::path(), fs::path("-")})
    EXPECT_NO_THROW(check_writable(path)) << path;
  EXPECT_EQ(folder.entries(), 1U);
  for (const fs::path& path : {folder / "no" / "a.txt", folder.path(), folder / "a.txt" / "b.txt",
                               folder / "no/", folder / "."}) {
    expect_refused(path);
  }
}

TEST(OutputPath, DoesNotReplaceWhatIsWriteProtected) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everything";
  const TemporaryFolder folder;
  ::chmod(folder.write("a.txt", "old").c_str(), 0400);
  expect_refused(folder / "a.txt");
}

TEST(OutputPath, RefusesLinksInCircles) {
  const TemporaryFolder folder;
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  expect_refused(folder / "a");
}

TEST(OutputPath, FollowsNoLinkThatSomebodyElsePlanted) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can make links of somebody else";
  const TemporaryFolder folder;
  folder.write("victim", "old");
  fs::create_directories(folder / "open" / "folder");
  fs::create_symlink("../victim", folder / "open" / "link");
  fs::create_symlink("../../new", folder / "open" / "dangling");
  fs::create_symlink(folder.path(), folder / "open" / "way");
  for (const char* link : {"link", "dangling", "way"}) {
    ASSERT_EQ(::lchown((folder / "open" / link).c_str(), kSomebodyElse, kSomebodyElse), 0);
  }
  fs::create_symlink("open/link", folder / "mine");
  ASSERT_EQ(::mkfifo((folder / "open" / "pipe").c_str(), 0666), 0);
  ASSERT_EQ(::chown((folder / "open" / "pipe").c_str(), kSomebodyElse, kSomebodyElse), 0);
  const std::vector<fs::path> names = {folder / "open/link", folder / "open/dangling",
                                       folder / "mine", folder / "open/way/victim"};
  for (const mode_t mode : {01777, 0777}) {
    ASSERT_EQ(::chmod((folder / "open").c_str(), mode), 0);
    for (const fs::path& name : names) expect_refused(name);
    expect_refused(folder / "open/pipe");
  }
  EXPECT_FALSE(fs::exists(folder / "new"));
  ASSERT_EQ(::chmod((folder / "open").c_str(), 0775), 0);
  for (const fs::path& name : names) EXPECT_NO_THROW(check_writable(name)) << name;
  // A link of whom the folder belongs to is one that the administrator has made.
  ASSERT_EQ(::chmod((folder / "open").c_str(), 01777), 0);
  ASSERT_EQ(::chown((folder / "open").c_str(), kSomebodyElse, kSomebodyElse), 0);
  EXPECT_NO_THROW(check_writable(folder / "open/link"));
}

TEST(OutputPath, DoesNotTakeOverThePermissionsOfAFileThatSomebodyPlanted) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can make files of somebody else";
  const TemporaryFolder folder;
  ASSERT_EQ(::chmod(folder.path().c_str(), 0777), 0);
  const fs::path path = folder.write("a.txt", "planted");
  ASSERT_EQ(::chmod(path.c_str(), 0666), 0);
  ASSERT_EQ(::chown(path.c_str(), kSomebodyElse, kSomebodyElse), 0);
  const mode_t old_mask = ::umask(0077);
  write_file(path, "mine");
  ::umask(old_mask);
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, 0U);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST(OutputPath, KnowsTheStreamsOfThisProcess) {
  EXPECT_EQ(output_path("-").descriptor, 1);
  EXPECT_EQ(output_path("/dev/stdout").descriptor, 1);
  EXPECT_EQ(output_path("/dev/fd/2").descriptor, 2);
  EXPECT_EQ(output_path("/proc/self/fd/1").descriptor, 1);
  EXPECT_TRUE(output_path("/dev/stdout").in_place);
}

TEST(IsSameFile, SeesThroughNamesAndLinks) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("a", "x");
  fs::create_symlink("a", folder / "link");
  fs::create_hard_link(file, folder / "hard");
  for (const fs::path& same : {file, folder / "link", folder / "hard", folder / "." / "a"}) {
    EXPECT_TRUE(is_same_file({file}, {same})) << same;
  }
  folder.write("b", "x");
  for (const fs::path& other : {folder / "b", folder / "missing", fs::path("-")}) {
    EXPECT_FALSE(is_same_file({file}, {other})) << other;
  }
  EXPECT_TRUE(is_same_file({folder / "new"}, {folder / "." / "new"}));
  EXPECT_FALSE(is_same_file({folder / "new"}, {folder / "newer"}));
  EXPECT_FALSE(is_same_file({folder / "no" / "a"}, {folder / "none" / "a"}));
  EXPECT_FALSE(is_same_file({"/dev/null"}, {"/dev/null"}));  // which only looks
}

}  // namespace
}  // namespace delray::files
