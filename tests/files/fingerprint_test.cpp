// Fingerprints tell files apart.
#include "files/fingerprint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/support/temporary_folder.h"

namespace delray::files {
namespace {

std::string difference(const Fingerprint& a, const Fingerprint& b) {
  std::string text = a.bytes == b.bytes ? "" : "size";
  for (std::size_t i = 0; i < std::min(a.parts.size(), b.parts.size()); ++i) {
    if (a.parts[i].hash != b.parts[i].hash) text += " " + std::to_string(a.parts[i].begin);
  }
  return text;
}

TEST(Fingerprint, TellsFilesApartThatDifferAtTheirEndsOrInSize) {
  const tests::TemporaryFolder folder;
  for (const std::size_t size : {std::size_t{0}, std::size_t{10}, std::size_t{1} << 20,
                                 (std::size_t{1} << 20) + 1, std::size_t{5000000}}) {
    std::string content(size, 'a');
    const Fingerprint whole = fingerprint(folder.write("a", content));
    EXPECT_EQ(whole.bytes, size);
    EXPECT_EQ(whole.parts.size(), size > std::size_t{1} << 20 ? 16U : 1U);
    EXPECT_EQ(difference(whole, fingerprint(folder / "a")), "");
    EXPECT_EQ(difference(whole, fingerprint(folder.write("c", content + "a"))).substr(0, 4),
              "size");
    if (size == 0) continue;
    content.front() = 'b';
    EXPECT_EQ(difference(whole, fingerprint(folder.write("d", content))), " 0");
    content.front() = 'a';
    content.back() = 'b';
    EXPECT_NE(difference(whole, fingerprint(folder.write("e", content))), "");
  }
}

TEST(Fingerprint, HasNothingOfWhatIsNoFile) {
  EXPECT_TRUE(fingerprint("/dev/zero").parts.empty());
  EXPECT_TRUE(fingerprint("/no/such/file").parts.empty());
  EXPECT_TRUE(fingerprint("/tmp").parts.empty());
}

}  // namespace
}  // namespace delray::files
