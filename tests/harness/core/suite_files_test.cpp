#include "harness/core/suite_files.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <minizip/zip.h>

#include "harness/core/file.hpp"
#include "harness/core/rereadable_file.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

using Files = std::vector<std::pair<std::string, std::string>>;  // name, bytes

void pack(const Files& files, const fs::path& path) {
  const zipFile archive = zipOpen64(path.c_str(), APPEND_STATUS_CREATE);
  for (const auto& [name, bytes] : files) {
    const zip_fileinfo info{};
    zipOpenNewFileInZip(archive, name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED,
                        Z_DEFAULT_COMPRESSION);
    zipWriteInFileInZip(archive, bytes.data(), static_cast<unsigned>(bytes.size()));
    zipCloseFileInZip(archive);
  }
  zipClose(archive, nullptr);
}

// The same files in a folder and in an archive, not in the order of their names.
class SuiteFiles : public testing::TestWithParam<const char*> {
 protected:
  SuiteFiles() {
    for (const auto& [name, bytes] : files_) {
      const fs::path file = directory_.path() / "folder" / name;
      fs::create_directories(file.parent_path());
      write_file(file, bytes);
    }
    pack(files_, directory_.path() / "archive.zip");
  }

  const Files files_{{"cases/law/b.toml", "b = 1\n"},
                     {"cases/law-2/a.toml", "a = 1\n"},
                     {"cases/README.md", std::string(100'000, 'r')},
                     {"cases/EMPTY", ""}};
  const TemporaryDirectory directory_;
  const fs::path root_ = directory_.path() / GetParam();
};
INSTANTIATE_TEST_SUITE_P(In, SuiteFiles, testing::Values("folder", "archive.zip"));

TEST_P(SuiteFiles, AreFoundInTheOrderOfTheirBytes) {
  const fs::path cases = root_ / "cases";
  EXPECT_THAT(*suite_files_below(cases), ElementsAre(cases / "EMPTY", cases / "README.md",
                                                     cases / "law-2/a.toml", cases / "law/b.toml"));
  EXPECT_EQ(*suite_files_below(root_), *suite_files_below(cases));
  EXPECT_THAT(*suite_folders_in(cases), ElementsAre(cases / "law", cases / "law-2"));
  EXPECT_THAT(*suite_folders_in(root_), ElementsAre(cases));
  const fs::path missing = root_ / "golden";
  const std::string why = missing.string() + ": cannot be read: No such file or directory";
  EXPECT_EQ(suite_files_below(missing).error().to_string(), why);
  EXPECT_EQ(suite_folders_in(missing).error().to_string(), why);
}

TEST_P(SuiteFiles, AreReadAndCopied) {
  ASSERT_TRUE(copy_suite_files(root_, directory_.path() / "copy"));
  for (const auto& [name, bytes] : files_) {
    EXPECT_EQ(read_suite_file(root_ / name), bytes) << name;
    EXPECT_EQ(read_file(directory_.path() / "copy" / name), bytes) << name;
    const auto again = RereadableFile::open(root_ / name);
    EXPECT_EQ(read_file(again->path()), bytes) << name;
  }
  EXPECT_EQ(read_suite_file(root_ / "cases/law/../law//./b.toml"), "b = 1\n");
  EXPECT_FALSE(read_suite_file(root_ / "cases"));
  EXPECT_EQ(
      read_suite_file(root_ / "cases/c.toml").error().to_string(),
      (root_ / "cases/c.toml").string() + ": cannot open the file: No such file or directory");
}

// A descriptor that stays open could be inherited by a port.
TEST_P(SuiteFiles, StayOpenOnlyOnRequest) {
  const auto descriptors = [] {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
  };
  const auto before = descriptors();
  const fs::path file = root_ / "cases/law/b.toml";
  EXPECT_TRUE(read_suite_file(file));
  EXPECT_EQ(descriptors(), before);
  {
    const auto open = keep_suite_open(root_);
    EXPECT_EQ(read_suite_file(file), "b = 1\n");
    EXPECT_EQ(read_suite_file(root_ / "cases/law-2/a.toml"), "a = 1\n");
    EXPECT_EQ(descriptors(), before + (archive_of(root_).empty() ? 0 : 1));
  }
  EXPECT_EQ(descriptors(), before);
  EXPECT_TRUE(read_suite_file(file));
}

TEST_P(SuiteFiles, AreOtherThanFolders) {
  EXPECT_TRUE(is_suite_folder(root_));
  EXPECT_TRUE(is_suite_folder(root_ / "cases"));
  EXPECT_TRUE(is_suite_folder(root_ / "cases/law/"));
  EXPECT_FALSE(is_suite_folder(root_ / "cases/la"));
  EXPECT_FALSE(is_suite_file(root_ / "cases"));
  EXPECT_TRUE(is_suite_file(root_ / "cases/law/b.toml"));
  EXPECT_FALSE(is_suite_folder(root_ / "cases/law/b.toml"));
  EXPECT_FALSE(is_suite_file(root_ / "cases/law/c.toml"));
  EXPECT_FALSE(is_suite_folder(root_ / "golden"));
}

TEST(SuiteArchive, IsAPartOfAPath) {
  const TemporaryDirectory directory;
  fs::create_directories(directory.path() / "folder.zip");
  pack({{"a", "1"}}, directory.path() / "folder.zip/b.zip");
  const fs::path archive = directory.path() / "folder.zip/b.zip";
  EXPECT_EQ(archive_of(archive), archive);
  EXPECT_EQ(archive_of(archive / "a"), archive);
  EXPECT_EQ(archive_of(archive.string() + "/"), archive);
  EXPECT_EQ(archive_of(archive.string() + "ped/a"), "");
  EXPECT_EQ(archive_of(directory.path() / "folder.zip/a"), "");
  EXPECT_EQ(read_suite_file(archive / "a"), "1");
  // A path that leads out of the archive leads to no file, as on disk.
  write_file(directory.path() / "folder.zip/out", "outside");
  EXPECT_FALSE(read_suite_file(archive / "../out"));
  EXPECT_FALSE(read_suite_file(archive / "x/../../out"));
  EXPECT_FALSE(is_suite_folder(archive / ".."));
}

// What the archive with these bytes gives for its file `a`.
class Damaged : public testing::Test {
 protected:
  Damaged() {
    pack({{"a", std::string(5000, 'a') + "b"}}, path_);
    bytes_ = *read_file(path_);
  }

  std::string error() const {
    const auto read = read_suite_file(path_ / "a");
    return read ? "none" : read.error().to_string();
  }

  const TemporaryDirectory directory_;
  const fs::path path_ = directory_.path() / "suite.zip";
  std::string bytes_;  // of the archive
  const std::string remedy_ =
      "; restore the archive, or install attest anew; --suite DIR names a suite in a folder";
};

TEST_F(Damaged, FileIsNamed) {
  std::string bytes = bytes_;
  bytes.at(40) = static_cast<char>(bytes.at(40) ^ 0x10);  // in the compressed bytes
  write_file(path_, bytes);
  EXPECT_EQ(error(), (path_ / "a").string() + ": is damaged in its archive" + remedy_);
}

TEST_F(Damaged, ChecksumIsCompared) {
  pack({{"a", "the content"}}, path_);
  std::string bytes = *read_file(path_);
  const std::size_t checksum = bytes.rfind("PK\1\2") + 16;  // of the directory
  bytes.at(checksum) = static_cast<char>(bytes.at(checksum) ^ 1);
  write_file(path_, bytes);
  EXPECT_EQ(error(), (path_ / "a").string() + ": is damaged in its archive" + remedy_);
}

TEST_F(Damaged, ArchiveIsNamed) {
  for (const std::string& bytes : {std::string(), std::string("text"), bytes_.substr(0, 50),
                                   bytes_.substr(0, bytes_.size() - 10)}) {
    const fs::path path = directory_.path() / std::to_string(bytes.size()) / "suite.zip";
    fs::create_directories(path.parent_path());
    write_file(path, bytes);
    EXPECT_THAT(read_suite_file(path / "a").error().to_string(), HasSubstr(remedy_));
    EXPECT_FALSE(is_suite_folder(path));
    EXPECT_FALSE(suite_files_below(path));
  }
}

TEST_F(Damaged, NamesThatLeadOutsideAreRefused) {
  int count = 0;
  for (const char* name : {"../a", "cases/../../a", "/etc/a", "./a"}) {
    const fs::path path = directory_.path() / fmt::format("{}.zip", ++count);
    pack({{"a", "1"}, {name, "2"}}, path);
    EXPECT_EQ(
        read_suite_file(path / "a").error().to_string(),
        fmt::format("{}: has a file outside of its folder: `{}`{}", path.string(), name, remedy_));
    EXPECT_FALSE(copy_suite_files(path, directory_.path() / "copy"));
  }
  pack({{"a", "1"}, {"a", "2"}}, path_);
  EXPECT_EQ(error(), path_.string() + ": has two files `a`" + remedy_);
}

// A place that, with the bytes from there on, is larger than 64 bits.
TEST_F(Damaged, PlacesOutsideOfTheArchiveAreRefused) {
  std::string bytes = bytes_;
  // The locator of ZIP64: signature, number of the disk, place of the directory's end, disks.
  const std::string locator =
      std::string("PK\6\7", 4) + std::string(4, '\0') + std::string(8, '\xff') + "\1";
  bytes.insert(bytes.rfind("PK\5\6"), locator + std::string(3, '\0'));
  write_file(path_, bytes);
  EXPECT_THAT(error(), HasSubstr(remedy_));
}

TEST_F(Damaged, ChangedArchiveIsNotReadOn) {
  ASSERT_EQ(error(), "none");
  pack({{"a", "of another archive"}}, path_);
  const std::string changed =
      path_.string() + ": changed during the run; run again while no program writes to it";
  EXPECT_EQ(error(), changed);
  const auto open = keep_suite_open(path_);
  EXPECT_EQ(error(), changed);
  EXPECT_EQ(error(), changed);
}

}  // namespace
}  // namespace attest
