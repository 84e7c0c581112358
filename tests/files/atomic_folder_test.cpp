#include "files/atomic_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <optional>

#include "files/error.h"
#include "tests/support/temporary_folder.h"

namespace delray::files {
namespace {

namespace fs = std::filesystem;

AtomicFolder::Options options(Unfinished unfinished = Unfinished::removed) {
  return {"index", [](std::string_view name) { return name.starts_with("part"); }, unfinished};
}

void put(const AtomicFolder& folder, const std::string& name) {
  const int file = folder.create(name);
  EXPECT_EQ(::write(file, "x", 1), 1);
  ::close(file);
}

Cause cause_of(const fs::path& path) {
  try {
    AtomicFolder folder(path, options());
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
    return error.cause();
  }
  ADD_FAILURE() << path;
  return Cause::memory;
}

TEST(AtomicFolder, AppearsWholeOrNotAtAll) {
  const tests::TemporaryFolder base;
  for (const std::string name : {"new", "slash/"}) {
    {
      AtomicFolder folder(base / name, options());
      put(folder, "part1");
      EXPECT_FALSE(fs::exists(base / name));
    }
    EXPECT_EQ(base.entries(), 0U);
  }
  AtomicFolder folder(base / "new/", options());
  put(folder, "part1");
  put(folder, "index");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"index", "part1"}));
  folder.commit();
  EXPECT_EQ(base.entries(), 1U);
  EXPECT_TRUE(fs::is_regular_file(base / "new/part1"));
}

TEST(AtomicFolder, ReplacesItsKindOnly) {
  const tests::TemporaryFolder base;
  fs::create_directory(base / "old");
  {
    AtomicFolder folder(base / "old", options());  // an empty one
    put(folder, "index");
    put(folder, "part1");
    folder.commit();
  }
  {
    AtomicFolder folder(base / "old", options());
    put(folder, "index");
    put(folder, "part2");
    EXPECT_TRUE(fs::exists(base / "old/part1"));
    folder.commit();
  }
  EXPECT_EQ(base.entries(), 1U);
  EXPECT_FALSE(fs::exists(base / "old/part1"));
  EXPECT_TRUE(fs::exists(base / "old/part2"));

  base.write("old/thesis", "years of work");
  EXPECT_EQ(cause_of(base / "old"), Cause::device);
  fs::remove(base / "old/thesis");
  fs::remove(base / "old/index");
  EXPECT_EQ(cause_of(base / "old"), Cause::device);  // names of parts alone say nothing
  EXPECT_TRUE(fs::exists(base / "old/part2"));
  base.write("file", "");
  EXPECT_EQ(cause_of(base / "file"), Cause::device);
  EXPECT_EQ(cause_of(base / "nowhere/new"), Cause::device);
}

// What came in while it was filled stays as well.
TEST(AtomicFolder, LooksAgainBeforeItReplaces) {
  const tests::TemporaryFolder base;
  AtomicFolder folder(base / "new", options());
  put(folder, "index");
  fs::create_directory(base / "new");
  base.write("new/thesis", "years of work");
  EXPECT_THROW(folder.commit(), FileError);
  EXPECT_TRUE(fs::exists(base / "new/thesis"));
}

TEST(AtomicFolder, IsFilledByOneAtATime) {
  const tests::TemporaryFolder base;
  std::optional<AtomicFolder> first(std::in_place, base / "new", options());
  EXPECT_EQ(cause_of(base / "new"), Cause::device);
  first.reset();
  AtomicFolder second(base / "new", options());
}

TEST(AtomicFolder, IsResumedOrBegunAnew) {
  const tests::TemporaryFolder base;
  for (const Unfinished unfinished : {Unfinished::resumed, Unfinished::removed}) {
    {
      AtomicFolder folder(base / "new", options());
      put(folder, "part1");
      folder.keep();
    }
    EXPECT_EQ(base.entries(), 1U);
    AtomicFolder folder(base / "new", options(unfinished));
    EXPECT_EQ(folder.names().size(), unfinished == Unfinished::resumed ? 1U : 0U);
  }
  EXPECT_EQ(base.entries(), 0U);
}

TEST(AtomicFolder, LeavesWhatOthersPutWhereItWouldBeMade) {
  const tests::TemporaryFolder base;
  fs::create_directory(base / ".new.delray-part");
  base.write(".new.delray-part/thesis.txt", "years of work");
  EXPECT_EQ(cause_of(base / "new"), Cause::device);
  EXPECT_TRUE(fs::exists(base / ".new.delray-part" / "thesis.txt"));
  fs::rename(base / ".new.delray-part" / "thesis.txt", base / ".new.delray-part" / "log");
  AtomicFolder::Options with_log = options();
  with_log.is_temporary = [](std::string_view name) { return name == "log"; };
  EXPECT_TRUE(AtomicFolder(base / "new", with_log).names().empty());
}

TEST(AtomicFolder, WritesThroughNoLinks) {
  const tests::TemporaryFolder base;
  fs::create_directory(base / "elsewhere");
  fs::create_directory_symlink("elsewhere", base / ".new.delray-part");
  EXPECT_EQ(cause_of(base / "new"), Cause::device);
  fs::remove(base / ".new.delray-part");
  AtomicFolder folder(base / "new", options());
  base.write("victim", "as it was");
  fs::create_symlink(base / "victim", folder.temporary() / "part1");
  EXPECT_THROW(folder.create("part1"), FileError);
  EXPECT_THROW(folder.append("part1"), FileError);
  EXPECT_EQ(fs::file_size(base / "victim"), 9U);
  // The user's own links to folders are followed.
  fs::create_directory_symlink("elsewhere", base / "link");
  AtomicFolder linked(base / "link", options());
  put(linked, "index");
  linked.commit();
  EXPECT_TRUE(fs::is_symlink(base / "link"));
  EXPECT_TRUE(fs::exists(base / "elsewhere/index"));
}

}  // namespace
}  // namespace delray::files
