#include "harness/trace/provenance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

class ProvenanceFile : public testing::Test {
 protected:
  // The errors without the path: "2:1: ...", one a line.
  std::string error_of(std::string_view text) {
    const auto read = read_provenance(directory_.write("provenance.toml", text));
    if (read) return "";
    std::string shown = read.error().to_string();
    const std::string here = directory_.path().string() + "/provenance.toml:";
    std::size_t at = 0;
    while ((at = shown.find(here)) != std::string::npos) shown.erase(at, here.size());
    return shown;
  }

  TemporaryDirectory directory_;
};

TEST_F(ProvenanceFile, ReadsBackWhatWasWritten) {
  Provenance written;
  written.profile = "px4-v1.5.5";
  written.reference = "attest 0.1.0";
  written.compiler = "gcc 12.2.0";
  written.reason = "it's the \"first\"";
  written.mixers = {{"4x", "R: 4x 10000 10000 10000 0"}};
  written.sha256 = {{"250hz.csv", "4567"}};
  const auto read = read_provenance(directory_.write("provenance.toml", to_toml(written)));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->profile, written.profile);
  EXPECT_EQ(read->reference, written.reference);
  EXPECT_EQ(read->compiler, written.compiler);
  EXPECT_EQ(read->reason, written.reason);
  EXPECT_EQ(read->mixers, written.mixers);
  EXPECT_EQ(read->sha256, written.sha256);
}

TEST_F(ProvenanceFile, NeedsNothing) { EXPECT_EQ(error_of(""), ""); }

TEST_F(ProvenanceFile, NamesUnknownKeysAndMissingFiles) {
  EXPECT_EQ(error_of("compilr = 'gcc'\n"), "1:1: unknown key `compilr`; did you mean `compiler`?");
  const std::string missing = (directory_.path() / "missing.toml").string();
  EXPECT_EQ(read_provenance(missing).error().to_string(),
            missing + ": cannot open the file: No such file or directory");
}

}  // namespace
}  // namespace attest
