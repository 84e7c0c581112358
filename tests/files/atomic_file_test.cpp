// Files appear whole or not at all, and keep permissions and links.
#include "files/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <thread>
#include <vector>

#include "files/error.h"
#include "files/read_file.h"
#include "tests/support/device.h"

namespace delray::files {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(testing::TempDir()) /
        ("delray_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  auto entries() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }
  fs::path folder_;
};

TEST_F(AtomicFileTest, AppearsOnCommitOnly) {
  const fs::path path = folder_ / "a.txt";
  {
    AtomicFile file(path);
    EXPECT_EQ(file.temporary().extension(), ".txt");
    std::ofstream(file.temporary()) << "x";
    EXPECT_FALSE(fs::exists(path));
    file.commit();
  }
  EXPECT_EQ(read_file(path), "x");
  EXPECT_EQ(entries(), 1);
}

TEST_F(AtomicFileTest, LeavesNothingWithoutCommit) {
  write_file(folder_ / "a.txt", "old");
  {
    AtomicFile file(folder_ / "a.txt");
    std::ofstream(file.temporary()) << "half";
  }
  EXPECT_EQ(read_file(folder_ / "a.txt"), "old");
  EXPECT_EQ(entries(), 1);
}

TEST_F(AtomicFileTest, MissingFolderIsADeviceError) {
  try {
    write_file(folder_ / "no" / "a.txt", "x");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.cause(), Cause::device);
    EXPECT_NE(std::string(error.what()).find("a.txt"), std::string::npos);
  }
}

TEST_F(AtomicFileTest, KeepsThePermissionsOfWhatItReplaces) {
  const auto mode = [](const fs::path& path) { return fs::status(path).permissions(); };
  const mode_t old_mask = ::umask(0027);
  write_file(folder_ / "new", "x");
  EXPECT_EQ(mode(folder_ / "new"), fs::perms(0640));
  for (const int kept : {0600, 0666, 0755}) {
    fs::permissions(folder_ / "new", fs::perms(kept));
    write_file(folder_ / "new", "y");
    EXPECT_EQ(mode(folder_ / "new"), fs::perms(kept));
  }
  ::umask(old_mask);
}

TEST_F(AtomicFileTest, ReplacesWhatTheUsersLinkLeadsTo) {
  fs::create_directories(folder_ / "there");
  write_file(folder_ / "there" / "a.txt", "old");
  fs::create_symlink("there/a.txt", folder_ / "link.txt");
  fs::create_symlink(folder_ / "link.txt", folder_ / "second.txt");
  fs::create_symlink("there/../there/new.txt", folder_ / "dangling.txt");
  write_file(folder_ / "second.txt", "new");
  write_file(folder_ / "dangling.txt", "made");
  for (const char* link : {"link.txt", "second.txt", "dangling.txt"}) {
    EXPECT_TRUE(fs::is_symlink(folder_ / link)) << link;
  }
  EXPECT_EQ(read_file(folder_ / "there" / "a.txt"), "new");
  EXPECT_EQ(read_file(folder_ / "there" / "new.txt"), "made");
}

TEST_F(AtomicFileTest, WritesIntoPipes) {
  const fs::path pipe = folder_ / "pipe.txt";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const bool by_name : {false, true}) {
    std::string got;
    std::thread reader([&] { std::getline(std::ifstream(pipe), got, '\0'); });
    AtomicFile file(pipe);
    if (by_name) {
      EXPECT_EQ(file.temporary().extension(), ".txt");
      std::ofstream(file.temporary()) << "through";
    } else {
      file.write("thr");
      file.write("ough");
    }
    file.commit();
    reader.join();
    EXPECT_EQ(got, "through");
  }
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(entries(), 1);
}

// With devices of its own: a program that replaced the machine's would do harm.
TEST_F(AtomicFileTest, WritesIntoDevices) {
  const fs::path null = folder_ / "null", full = folder_ / "full";
  if (!tests::make_device(null, tests::kNull) || !tests::make_device(full, tests::kFull)) {
    GTEST_SKIP() << "only root can make devices, and not everywhere";
  }
  EXPECT_NO_THROW(write_file(null, "x"));
  EXPECT_TRUE(fs::is_character_file(null));
  fs::create_symlink("full", folder_ / "link");
  EXPECT_NO_THROW(check_writable(folder_ / "link"));
  EXPECT_THROW(write_file(folder_ / "link", "x"), FileError);
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_TRUE(fs::is_character_file(full));
  EXPECT_EQ(entries(), 3);
}

TEST_F(AtomicFileTest, LeavesNothingOnAFullDisk) {
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  ::getrlimit(RLIMIT_FSIZE, &old_limit);
  const rlimit limit{1000, old_limit.rlim_max};
  write_file(folder_ / "a.txt", "old");
  ::setrlimit(RLIMIT_FSIZE, &limit);
  EXPECT_THROW(write_file(folder_ / "a.txt", std::string(100000, 'x')), FileError);
  ::setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(read_file(folder_ / "a.txt"), "old");
  EXPECT_EQ(entries(), 1);
}

TEST_F(AtomicFileTest, NamesOfTemporaryFilesCannotBeForeseen) {
  const AtomicFile first(folder_ / "a.txt"), second(folder_ / "a.txt");
  ASSERT_EQ(entries(), 2);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    names.push_back(entry.path().filename().string());
    EXPECT_EQ(names.back().find(std::to_string(::getpid())), std::string::npos);
  }
  int different = 0;
  for (std::size_t i = 0; i < names[0].size(); ++i) different += names[0][i] != names[1][i];
  EXPECT_GE(different, 6);  // of 16 random digits; fewer are less likely than 1 in 10^11
}

TEST_F(AtomicFileTest, NoticesThatTheTemporaryFileIsAnother) {
  AtomicFile file(folder_ / "a.txt");
  const fs::path name = file.temporary();
  fs::remove(name);
  fs::create_symlink("elsewhere.txt", name);
  EXPECT_THROW(file.commit(), FileError);
  EXPECT_FALSE(fs::exists(folder_ / "a.txt"));
}

TEST_F(AtomicFileTest, TakesNamesOfAnyLength) {
  for (const std::string& name : {std::string(255, 'a'), "a." + std::string(253, 'b')}) {
    write_file(folder_ / name, "x");
    EXPECT_EQ(read_file(folder_ / name), "x");
  }
}

TEST_F(AtomicFileTest, ReadingAFolderOrNothingIsBadInput) {
  for (const fs::path& path : {folder_, folder_ / "missing"}) {
    try {
      read_file(path);
      FAIL() << path;
    } catch (const FileError& error) {
      EXPECT_EQ(error.cause(), Cause::input);
      EXPECT_EQ(error.file(), path.string());
    }
  }
}

TEST_F(AtomicFileTest, ReadStartReadsNoMore) {
  write_file(folder_ / "a.txt", "abcdef");
  EXPECT_EQ(read_start(folder_ / "a.txt", 3), "abc");
  EXPECT_EQ(read_start(folder_ / "a.txt", 100), "abcdef");
}

}  // namespace
}  // namespace delray::files
