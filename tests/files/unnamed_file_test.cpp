#include "files/unnamed_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "files/error.h"
#include "tests/support/temporary_folder.h"

namespace delray::files {
namespace {

TEST(UnnamedFile, HoldsBytesAtAnyOffsetWithoutAName) {
  const tests::TemporaryFolder folder;
  const UnnamedFile file(folder / ".", "scratch");
  EXPECT_TRUE(std::filesystem::is_empty(folder / "."));
  const std::vector<std::byte> bytes(1000, std::byte{5});
  file.write(5000, bytes);
  file.write(0, bytes);
  std::vector<std::byte> found(1000);
  file.read(5000, found);
  EXPECT_EQ(found, bytes);
  file.read(1000, found);  // between them
  EXPECT_EQ(std::ranges::count(found, std::byte{0}), 1000);
  EXPECT_THROW(file.read(5500, found), FileError);
}

TEST(UnnamedFile, NamesTheFolderThatIsMissing) {
  try {
    UnnamedFile("/there/is/no/such/folder", "scratch file of a test");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.cause(), Cause::device);
    EXPECT_NE(std::string(error.what()).find("/there/is/no/such/folder: scratch file of a test"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace delray::files
