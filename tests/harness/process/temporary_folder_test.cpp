#include "harness/process/temporary_folder.hpp"

#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

namespace fs = std::filesystem;

TEST(TemporaryFolder, IsPrivateAndRemovedWithItsContent) {
  fs::path path;
  {
    const auto folder = TemporaryFolder::make("a-test");
    ASSERT_TRUE(folder);
    path = folder->path();
    EXPECT_THAT(path.filename().string(), testing::StartsWith("attest-a-test-"));
    EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_all);
    fs::create_directories(path / "a" / "b");
    std::ofstream(path / "a" / "b" / "c") << "content";
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(TemporaryFolder, StaysWhenItIsMoved) {
  auto folder = TemporaryFolder::make("a-test");
  ASSERT_TRUE(folder);
  const fs::path path = folder->path();
  {
    const TemporaryFolder moved = *std::move(folder);
    EXPECT_TRUE(fs::exists(path));
    EXPECT_EQ(moved.path(), path);
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(TemporaryFolder, AnErrorNamesTheFolder) {
  ::setenv("TMPDIR", "/proc/self", 1);
  const auto folder = TemporaryFolder::make("a-test");
  ::unsetenv("TMPDIR");
  ASSERT_FALSE(folder);
  EXPECT_THAT(folder.error().to_string(), testing::HasSubstr("/proc/self"));
}

}  // namespace
}  // namespace attest
