#include "files/atomic_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "files/error.h"
#include "files/read_file.h"

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

TEST_F(AtomicFileTest, TellsBeforehandWhereNothingCanBeWritten) {
  write_file(folder_ / "a.txt", "old");
  for (const fs::path& path : {folder_ / "a.txt", folder_ / "new.txt", fs::path(), fs::path("-")})
    EXPECT_NO_THROW(check_folder(path)) << path;
  EXPECT_EQ(read_file(folder_ / "a.txt"), "old");
  EXPECT_EQ(entries(), 1);
  for (const fs::path& path : {folder_ / "no" / "a.txt", folder_, folder_ / "a.txt" / "b.txt"}) {
    try {
      check_folder(path);
      ADD_FAILURE() << path;
    } catch (const FileError& error) {
      EXPECT_EQ(error.cause(), Cause::device) << path;
    }
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
