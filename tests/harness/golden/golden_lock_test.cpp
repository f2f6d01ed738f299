#include "harness/golden/golden_lock.hpp"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/core/file.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

namespace fs = std::filesystem;

class GoldenLockTest : public testing::Test {
 protected:
  fs::path root() const { return directory_.path() / "golden"; }
  fs::path folder() const { return root() / "profile" / "group"; }

  void put(const std::string& name, const std::string& text) const {
    fs::create_directories(folder());
    ASSERT_TRUE(write_file(folder() / name, text));
  }
  std::string text_of(const std::string& name) const {
    return read_file(folder() / name).value_or("there is no such file");
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(GoldenLockTest, IsHeldByOneAtATime) {
  {
    const auto first = GoldenLock::take(root());
    ASSERT_TRUE(first) << first.error().to_string();
    const auto second = GoldenLock::take(root());
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().file, (root() / ".bless.lock").string());
    EXPECT_THAT(second.error().message, HasSubstr("another `attest bless` holds this lock"));
  }
  EXPECT_TRUE(fs::is_empty(root()));
  EXPECT_TRUE(GoldenLock::take(root()));
}

TEST_F(GoldenLockTest, IsReleasedByTheDeathOfItsProcess) {
  const pid_t child = ::fork();
  if (child == 0) {
    const auto lock = GoldenLock::take(root());
    ::raise(SIGKILL);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_TRUE(fs::exists(root() / ".bless.lock"));
  EXPECT_TRUE(GoldenLock::take(root()));
  EXPECT_FALSE(fs::exists(root() / ".bless.lock"));
}

TEST_F(GoldenLockTest, WhatAKilledProcessHasLeftIsRemoved) {
  put("changed.csv", "blessed");
  put("changed.csv.new", "half");
  ASSERT_TRUE(GoldenLock::take(root()));
  EXPECT_EQ(text_of("changed.csv"), "blessed");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder()), {}), 1);
}

TEST_F(GoldenLockTest, WithoutItWhatIsInTheMakingStays) {
  const auto held = GoldenLock::take(root());
  put("changed.csv.new", "half");
  EXPECT_FALSE(GoldenLock::take(root()));
  EXPECT_EQ(text_of("changed.csv.new"), "half");
}

TEST_F(GoldenLockTest, ARootThatCannotBeMadeIsAnError) {
  ASSERT_TRUE(write_file(root(), "a file where the folder should be"));
  const auto lock = GoldenLock::take(root());
  ASSERT_FALSE(lock);
  EXPECT_EQ(lock.error().file, root().string());
}

}  // namespace
}  // namespace attest
