#include "harness/core/file.hpp"

#include <array>
#include <cstring>
#include <fstream>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;

std::vector<std::string> names_in(const fs::path& directory) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

TEST(ReadFile, GivesEveryByte) {
  const TemporaryDirectory directory;
  std::string bytes(200000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 31);
  EXPECT_EQ(read_file(directory.write("a", bytes)), bytes);
  EXPECT_EQ(read_file(directory.write("empty", "")), "");
}

TEST(ReadFile, SaysWhyItCannot) {
  const TemporaryDirectory directory;
  const std::string missing = (directory.path() / "missing").string();
  EXPECT_EQ(read_file(missing).error().to_string(),
            missing + ": cannot open the file: No such file or directory");
  directory.write("flight.csv", "");
  EXPECT_EQ(read_file(directory.path() / "fligth.csv").error().message,
            "cannot open the file: No such file or directory; did you mean `flight.csv`?");
  EXPECT_EQ(read_file(directory.path() / "missing/a.csv").error().message,
            "cannot open the file: No such file or directory; there is no folder " + missing);
  EXPECT_EQ(read_file("missing.csv").error().message,
            "cannot open the file: No such file or directory; the path begins in " +
                fs::current_path().string());
  EXPECT_EQ(read_file(directory.path()).error().to_string(),
            directory.path().string() + ": not a regular file but a directory; name a file");
}

TEST(ReadFile, RefusesWhatMayHaveNoEnd) {
  const TemporaryDirectory directory;
  const std::string pipe = (directory.path() / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(read_file(pipe).error().to_string(),
            pipe + ": not a regular file but a pipe; write its content to a file first");
  EXPECT_EQ(read_file("/dev/zero").error().to_string(),
            "/dev/zero: not a regular file but a device");
  EXPECT_FALSE(sha256_of_file(pipe));
}

TEST(ReadFile, RefusesWhatIsTooLarge) {
  const TemporaryDirectory directory;
  const fs::path path = directory.write("sparse", "");
  fs::resize_file(path, std::uintmax_t{10} << 30);
  EXPECT_EQ(read_file(path).error().to_string(),
            path.string() + ": is larger than 64 MiB, the most that such a file may have");
  EXPECT_EQ(read_file(directory.write("four", "1234"), 4), "1234");
  EXPECT_FALSE(read_file(directory.write("five", "12345"), 4));
}

TEST(Sha256, IsThatOfTheStandard) {
  // FIPS 180-2, appendix B, and the empty message.
  const TemporaryDirectory directory;
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of_file(directory.write("million", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(sha256_of_file(directory.path() / "missing").error().message,
            "cannot open the file: No such file or directory");
}

TEST(AtomicFile, IsThereOnlyAfterCommit) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "a.csv";
  auto file = AtomicFile::open(path);
  ASSERT_TRUE(file) << file.error().to_string();
  EXPECT_EQ(file->path(), path);
  ASSERT_TRUE(file->write("one\n"));
  ASSERT_TRUE(file->write("two\n"));
  EXPECT_FALSE(fs::exists(path));
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(read_file(path), "one\ntwo\n");
  EXPECT_EQ(names_in(directory.path()), std::vector<std::string>{"a.csv"});
}

TEST(AtomicFile, LeavesNothingBehindWithoutCommit) {
  const TemporaryDirectory directory;
  {
    auto file = AtomicFile::open(directory.path() / "a.csv");
    ASSERT_TRUE(file->write("half"));
  }
  EXPECT_THAT(names_in(directory.path()), IsEmpty());
}

TEST(AtomicFile, LeavesNothingBehindWhenTheProcessIsKilled) {
  const TemporaryDirectory directory;
  const int nameless = ::open(directory.path().c_str(), O_WRONLY | O_TMPFILE, 0600);
  if (nameless < 0) GTEST_SKIP() << "this file system has no files without a name";
  ::close(nameless);
  const pid_t child = ::fork();
  if (child == 0) {
    auto file = AtomicFile::open(directory.path() / "a.csv");
    ::_exit(file && file->write("half") ? 0 : 1);  // runs no destructor, like a kill
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_THAT(names_in(directory.path()), IsEmpty());
}

// A temporary name would be left by a kill before rename().
TEST(AtomicFile, ANewFileHasNoOtherNameBefore) {
  const TemporaryDirectory directory;
  const int events = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  ASSERT_GE(::inotify_add_watch(events, directory.path().c_str(), IN_CREATE | IN_MOVED_TO), 0);
  ASSERT_TRUE(write_file(directory.path() / "a.csv", "new"));
  alignas(inotify_event) std::array<char, 4096> bytes{};
  const ssize_t count = ::read(events, bytes.data(), bytes.size());
  ::close(events);
  inotify_event first;
  std::memcpy(&first, bytes.data(), sizeof first);
  EXPECT_EQ(count, static_cast<ssize_t>(sizeof first + first.len)) << "more than one event";
  EXPECT_STREQ(bytes.data() + sizeof first, "a.csv");
}

TEST(AtomicFile, KeepsTheOldFileUntilCommit) {
  const TemporaryDirectory directory;
  const fs::path path = directory.write("a.csv", "old");
  {
    auto file = AtomicFile::open(path);
    ASSERT_TRUE(file->write("new"));
  }
  EXPECT_EQ(read_file(path), "old");
  auto file = AtomicFile::open(path);
  ASSERT_TRUE(file->write("new"));
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(read_file(path), "new");
}

TEST(AtomicFile, MovesWithoutLosingItsTemporary) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "a.csv";
  auto first = AtomicFile::open(path);
  AtomicFile second = std::move(*first);
  first = fail("gone");
  ASSERT_TRUE(second.write("kept"));
  ASSERT_TRUE(second.commit());
  EXPECT_EQ(read_file(path), "kept");
}

TEST(AtomicFile, HasTheModeOfAnyNewFile) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "a.csv";
  const mode_t mask = ::umask(027);
  auto file = AtomicFile::open(path);
  ::umask(mask);
  ASSERT_TRUE(file->commit());
  struct stat status;
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST(AtomicFile, ReplacesWhatASymbolicLinkPointsTo) {
  const TemporaryDirectory directory;
  const fs::path path = directory.write("a.csv", "old");
  const fs::path link = directory.path() / "link.csv";
  fs::create_symlink(path, link);
  auto file = AtomicFile::open(link);
  ASSERT_TRUE(file->write("new"));
  ASSERT_TRUE(file->commit());
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_file(path), "new");
}

TEST(AtomicFile, WritesDirectlyToWhatIsNoOrdinaryFile) {
  auto null = AtomicFile::open("/dev/null");
  ASSERT_TRUE(null) << null.error().to_string();
  EXPECT_TRUE(null->write("anything"));
  EXPECT_TRUE(null->commit());
  EXPECT_FALSE(fs::is_regular_file("/dev/null"));

  const TemporaryDirectory directory;
  const fs::path pipe = directory.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string received;
  std::thread reader([&] { std::getline(std::ifstream(pipe), received); });
  auto file = AtomicFile::open(pipe);
  EXPECT_TRUE(file->write("through"));
  EXPECT_TRUE(file->commit());
  reader.join();
  EXPECT_EQ(received, "through");
}

TEST(AtomicFile, AppendsToAnOrdinaryFileBehindAFileDescriptor) {
  // The case of `attest sim --out /dev/stdout > file`: renaming would lose the other writers' text.
  const TemporaryDirectory directory;
  const fs::path path = directory.write("a.csv", "before\n");
  std::FILE* stream = std::fopen(path.c_str(), "a");
  ASSERT_NE(stream, nullptr);
  auto file = AtomicFile::open("/dev/fd/" + std::to_string(::fileno(stream)));
  ASSERT_TRUE(file) << file.error().to_string();
  EXPECT_TRUE(file->write("after\n"));
  EXPECT_TRUE(file->commit());
  std::fclose(stream);
  EXPECT_EQ(read_file(path), "before\nafter\n");
}

TEST(AtomicFile, OfAnEmptyPathIsNoFile) {
  auto file = AtomicFile::open("");
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->commit("text"));
}

// Puts a pipe or a link to `victim` at the path.
class Redirected : public testing::TestWithParam<bool> {
 protected:
  Redirected() { std::ofstream(victim_) << "kept"; }

  void redirect() const {
    fs::remove(path_);
    if (GetParam()) {
      ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
    } else {
      fs::create_symlink(victim_, path_);
    }
  }
  void expect_file_only() const {
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(path_)));
    EXPECT_EQ(*read_file(path_), "text");
    EXPECT_EQ(*read_file(victim_), "kept");
  }

  TemporaryDirectory directory_;
  fs::path path_ = directory_.path() / "report", victim_ = directory_.path() / "victim";
};

INSTANTIATE_TEST_SUITE_P(PipeOrLink, Redirected, testing::Bool());

TEST_P(Redirected, AfterOpenTheFileReplacesIt) {
  auto file = AtomicFile::open(path_);
  ASSERT_TRUE(file);
  redirect();
  EXPECT_TRUE(file->commit("text"));
  expect_file_only();
}

TEST_P(Redirected, BeforeOpenItIsReplacedIfWanted) {
  redirect();
  EXPECT_TRUE(write_file(path_, "text", AtomicFile::Special::replaced));
  expect_file_only();
}

TEST(AtomicFile, StaysInTheFolderThatItWasOpenedIn) {
  const TemporaryDirectory directory;
  const fs::path folder = directory.path() / "folder", moved = directory.path() / "moved";
  fs::create_directory(folder);
  auto file = AtomicFile::open(folder / "report");
  ASSERT_TRUE(file);
  fs::rename(folder, moved);
  fs::create_directory_symlink(directory.path(), folder);
  EXPECT_TRUE(file->commit("text"));
  EXPECT_EQ(*read_file(moved / "report"), "text");
  EXPECT_FALSE(fs::exists(directory.path() / "report"));
}

TEST(AtomicFile, SaysAtOnceWhyItCannot) {
  const TemporaryDirectory directory;
  const std::string here = directory.path().string();
  EXPECT_EQ(AtomicFile::open(here).error().to_string(), here + ": is a directory; name a file");
  EXPECT_EQ(AtomicFile::open(here + "/").error().to_string(),
            here + "/: not a file name; name a file");
  EXPECT_EQ(AtomicFile::open(here + "/no/a.csv").error().to_string(),
            here +
                "/no/a.csv: cannot create the file: No such file or directory; make the folder " +
                here + "/no first");
}

// Root may write everywhere, so such a test runs as another user.
class OrdinaryUser {
 public:
  explicit OrdinaryUser(const fs::path& directory) {
    constexpr uid_t nobody = 65534;
    if (::geteuid() != 0) return;
    is_root_ = ::chown(directory.c_str(), nobody, nobody) == 0 && ::seteuid(nobody) == 0;
  }
  ~OrdinaryUser() {
    if (is_root_ && ::seteuid(0) != 0) std::abort();
  }

 private:
  bool is_root_ = false;
};

TEST(AtomicFile, RefusesWhatItMayNotWrite) {
  const TemporaryDirectory directory;
  const fs::path path = directory.write("a.csv", "old");
  fs::permissions(path, fs::perms::owner_read);
  fs::permissions(directory.path(), fs::perms::owner_read | fs::perms::owner_exec);
  {
    const OrdinaryUser user(directory.path());
    EXPECT_EQ(AtomicFile::open(path).error().message, "cannot write the file: Permission denied");
    EXPECT_EQ(AtomicFile::open(directory.path() / "b.csv").error().message,
              "cannot create the file: Permission denied");
  }
  fs::permissions(directory.path(), fs::perms::owner_all);
}

TEST(AtomicFile, ReportsAFullDisk) {
  auto file = AtomicFile::open("/dev/full");
  ASSERT_TRUE(file) << file.error().to_string();
  EXPECT_EQ(file->write("more").error().to_string(),
            "/dev/full: cannot write the file: No space left on device");
}

TEST(AtomicFile, ReportsADirectoryThatIsGone) {
  const TemporaryDirectory directory;
  const fs::path folder = directory.path() / "folder";
  fs::create_directory(folder);
  auto file = AtomicFile::open(folder / "a.csv");
  fs::remove_all(folder);
  EXPECT_EQ(file->commit().error().to_string(),
            (folder / "a.csv").string() + ": cannot replace the file: No such file or directory");
}

}  // namespace
}  // namespace attest
