#include "harness/core/rereadable_file.hpp"

#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/core/file.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

TEST(RereadableFile, APipeCanBeReadTwice) {
  const TemporaryDirectory folder;
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string text(200'000, 'x');  // more than a pipe holds
  std::thread writer([&] { EXPECT_TRUE(write_file(pipe, text)); });
  const auto file = RereadableFile::open(pipe);
  writer.join();
  ASSERT_TRUE(file) << file.error().to_string();
  EXPECT_TRUE(file->is_copy());
  for (int twice = 0; twice < 2; ++twice) EXPECT_EQ(*read_file(file->path()), text);
}

TEST(RereadableFile, APipeWithoutAWriterIsAnError) {
  const TemporaryDirectory folder;
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto file = RereadableFile::open(pipe, std::chrono::milliseconds(20));
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().to_string(),
            pipe.string() + ": cannot read the pipe: no program writes to it, or it is empty");
}

TEST(RereadableFile, AWriterMayBeSlow) {
  const TemporaryDirectory folder;
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int writer = ::open(pipe.c_str(), O_RDWR | O_CLOEXEC);  // does not wait for a reader
  std::thread slow([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_EQ(::write(writer, "text", 4), 4);
    ::close(writer);
  });
  const auto file = RereadableFile::open(pipe, std::chrono::milliseconds(1));
  slow.join();
  ASSERT_TRUE(file) << file.error().to_string();
  EXPECT_EQ(*read_file(file->path()), "text");
}

TEST(RereadableFile, ARegularFileIsItself) {
  const TemporaryDirectory folder;
  const auto path = folder.write("a.csv", "text");
  const auto file = RereadableFile::open(path);
  ASSERT_TRUE(file);
  EXPECT_FALSE(file->is_copy());
  EXPECT_EQ(file->path(), path);
}

TEST(RereadableFile, AMissingFileIsLeftToItsReader) {
  const auto file = RereadableFile::open("nowhere.csv");
  ASSERT_TRUE(file);
  EXPECT_EQ(file->path(), "nowhere.csv");
}

}  // namespace
}  // namespace attest
