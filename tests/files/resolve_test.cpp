// Files that files name lie in the folder or below.
#include "files/resolve.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "files/error.h"
#include "tests/support/temporary_folder.h"

namespace delray::files {
namespace {

namespace fs = std::filesystem;

// scene/a.png, scene/deep/b.png, beside/c.png, scene-2/d.png, and links.
class Resolve : public testing::Test {
 protected:
  Resolve() {
    for (const char* name : {"scene", "scene/deep", "beside", "scene-2"}) {
      fs::create_directory(folder_ / name);
    }
    for (const char* name : {"scene/a.png", "scene/deep/b.png", "beside/c.png", "scene-2/d.png"}) {
      folder_.write(name, "x");
    }
    fs::create_symlink("../beside/c.png", folder_ / "scene/out.png");
    fs::create_symlink("../beside", folder_ / "scene/out");
    fs::create_symlink("deep/b.png", folder_ / "scene/in.png");
    ::mkfifo((folder_ / "scene/pipe.png").c_str(), 0600);
  }
  fs::path found(const std::string& name, Outside outside = Outside::refused) const {
    return resolve(folder_ / "scene", name, outside);
  }
  fs::path whole(const char* name) const { return fs::canonical(folder_ / name); }

  const tests::TemporaryFolder folder_;
};

TEST_F(Resolve, FindsFilesInTheFolderAndBelow) {
  EXPECT_EQ(found("a.png"), whole("scene/a.png"));
  EXPECT_EQ(found("./deep/../a.png"), whole("scene/a.png"));
  EXPECT_EQ(found("deep\\b.png"), whole("scene/deep/b.png"));
  EXPECT_EQ(found("in.png"), whole("scene/deep/b.png"));
  EXPECT_EQ(found("../scene/a.png"), whole("scene/a.png"));
  EXPECT_EQ(found(whole("scene/a.png").string()), whole("scene/a.png"));
}

TEST_F(Resolve, RefusesWhatLiesOutside) {
  for (const char* name : {"../beside/c.png", "..\\beside\\c.png", "deep/../../beside/c.png",
                           "out.png", "out/c.png", "../scene-2/d.png", "/etc/passwd"}) {
    try {
      found(name);
      FAIL() << name;
    } catch (const FileError& error) {
      EXPECT_EQ(error.cause(), Cause::input);
      EXPECT_EQ(error.file(), name);
      EXPECT_NE(std::string(error.what()).find("--allow-outside"), std::string::npos)
          << error.what();
    }
  }
  EXPECT_EQ(found("out.png", Outside::allowed), whole("beside/c.png"));
  EXPECT_EQ(found("../scene-2/d.png", Outside::allowed), whole("scene-2/d.png"));
}

TEST_F(Resolve, RefusesWhatIsNoFile) {
  for (const Outside outside : {Outside::refused, Outside::allowed}) {
    for (const std::string& name :
         {std::string("deep"), std::string("pipe.png"), std::string("."), std::string("none.png"),
          std::string(), std::string("a.png\0b", 7), std::string("/dev/zero")}) {
      EXPECT_THROW(found(name, outside), FileError) << name;
    }
  }
}

TEST_F(Resolve, FindsNothingBesideWhatIsNotThere) {
  const fs::path here = fs::current_path();
  fs::current_path(folder_ / "scene");
  EXPECT_THROW(resolve("/nowhere/at/all", "a.png", Outside::refused), FileError);
  EXPECT_EQ(resolve("", "a.png", Outside::refused), whole("scene/a.png"));
  fs::current_path(here);
}

// what() of an exception would end at the zero byte.
TEST_F(Resolve, WhatIsNoNameIsToldWithItsReason) {
  for (const std::string& name : {std::string("\0.png", 5), std::string()}) {
    try {
      found(name);
      ADD_FAILURE() << name.size();
    } catch (const FileError& error) {
      const std::string expected = name.empty() ? "''" : "\\x00.png";
      EXPECT_EQ(std::string(error.what()), expected + ": is not the name of a file");
    }
  }
}

}  // namespace
}  // namespace delray::files
