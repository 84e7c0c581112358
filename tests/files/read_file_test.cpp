// Files and streams are read whole, within the memory allowed.
#include "files/read_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <thread>

#include "files/error.h"
#include "files/format.h"
#include "tests/support/temporary_folder.h"

namespace delray::files {
namespace {

constexpr std::uint64_t kFileMebibyte = std::uint64_t{1} << 20;

Cause cause_of(const std::filesystem::path& path, const MemoryBudget& memory) {
  try {
    read_file(path, memory);
  } catch (const FileError& error) {
    return error.cause();
  }
  ADD_FAILURE() << path << " was read";
  return Cause::device;
}

// A pipe with a writer that fills it with `content` once, when somebody reads.
class FilledPipe {
 public:
  FilledPipe(const std::filesystem::path& path, const std::string& content) {
    ::mkfifo(path.c_str(), 0600);
    writer_ = std::jthread([path, content] { std::ofstream(path, std::ios::binary) << content; });
  }

 private:
  std::jthread writer_;
};

TEST(ReadFile, ReadsFilesWhole) {
  const tests::TemporaryFolder folder;
  std::string content;
  for (int i = 0; i < 700'000; ++i) content += std::to_string(i);
  const auto path = folder.write("a", content);
  EXPECT_EQ(read_file(path), content);
  EXPECT_EQ(read_start(path, 10), content.substr(0, 10));
  EXPECT_EQ(read_start(path, 3 * kFileMebibyte), content.substr(0, 3 * kFileMebibyte));
  EXPECT_EQ(read_file(folder.write("empty", "")), "");
  EXPECT_FALSE(is_stream(path));
  EXPECT_FALSE(is_stream(folder / "none"));
}

TEST(ReadFile, LooksAtTheStartOfAStreamBeforeReadingIt) {
  const tests::TemporaryFolder folder;
  std::string content = "# a comment\n";
  while (content.size() < 3 * kFileMebibyte) content += "v 1 2 3\n";
  content += "f 1 2 3\n";
  const FilledPipe pipe(folder / "p", content);
  EXPECT_TRUE(is_stream(folder / "p"));
  EXPECT_EQ(read_start(folder / "p", 11), "# a comment");
  EXPECT_EQ(read_start(folder / "p", 5), "# a c");
  const FileKind kind = identify(folder / "p");
  EXPECT_EQ(kind.format, Format::obj);
  EXPECT_TRUE(kind.has_faces);
  EXPECT_EQ(read_file(folder / "p"), content);
}

TEST(ReadFile, EndlessStreamsAreBadInput) {
  EXPECT_TRUE(is_stream("/dev/zero"));
  EXPECT_EQ(cause_of("/dev/zero", MemoryBudget(resident_set() + 50 * kFileMebibyte)), Cause::input);
  EXPECT_EQ(read_start("/dev/zero", 4), std::string(4, '\0'));
}

TEST(ReadFile, LargeFilesAreRefusedUnread) {
  const tests::TemporaryFolder folder;
  const auto path = folder.write("sparse", "x");
  std::filesystem::resize_file(path, std::uint64_t{1} << 40);
  const std::uint64_t before = resident_set();
  EXPECT_EQ(cause_of(path, MemoryBudget(before + 50 * kFileMebibyte)), Cause::memory);
  EXPECT_LT(resident_set(), before + 10 * kFileMebibyte);
}

}  // namespace
}  // namespace delray::files
