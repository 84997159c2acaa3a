#include "io/files/digest.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_file.h"

namespace patrol::io::digest_test {
namespace {

TEST(Digest, OfAbcIsTheStandardsExample) {  // FIPS 180-2, appendix B.1
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

class FolderDigest : public ::testing::Test {
 protected:
  FolderDigest() {
    std::filesystem::create_directories(folder_ / "scenarios");
    test::write_bytes(folder_ / "a.xml", "a");
    test::write_bytes(folder_ / "scenarios/s.yaml", "s");
  }
  std::string digest() const { return sha256_of_folder(folder_.path(), "scenarios"); }

  test::TemporaryFolder folder_;
};

TEST_F(FolderDigest, ChangesWithAContentAndWithAName) {
  const std::string before = digest();
  test::write_bytes(folder_ / "a.xml", "b");
  const std::string other_content = digest();
  EXPECT_NE(before, other_content);
  std::filesystem::rename(folder_ / "a.xml", folder_ / "b.xml");
  EXPECT_NE(digest(), other_content);
}

TEST_F(FolderDigest, DoesNotSeeWhatIsLeftOutOrHidden) {
  const std::string before = digest();
  test::write_bytes(folder_ / "scenarios/s.yaml", "changed");
  test::write_bytes(folder_ / ".hidden", "h");
  EXPECT_EQ(digest(), before);
}

}  // namespace
}  // namespace patrol::io::digest_test
