// A folder of cases that hunts begin with, and to which they add. Each case is an input on which
// the reference meets something that it does not meet on the others, or a finding.
//
// The folder is `cases` of a suite: <profile>/hunt/<module>_<hash>.toml. The hash is that of the
// inputs, so the same inputs are one file. Of a module in a profile it has at most
// `most_of_corpus` cases. Then no case is added; a hunt removes no file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/diagnosis/hunt_inputs.hpp"

namespace attest {

inline constexpr std::size_t most_of_corpus = 200;

class HuntCorpus {
 public:
  // Reads the cases of the folder, which need not exist, in the order of their paths. Cases of
  // other subjects, flights and cases of a stricter level are counted and skipped. Errors: a file
  // in the folder of a profile that is not a case; a file that cannot be read.
  static Result<HuntCorpus> open(const std::filesystem::path& folder,
                                 std::span<const ModuleUnderTest> subjects, Level level);

  const std::vector<HuntInputs>& inputs() const { return inputs_; }

  // Writes the case next to its name, and then renames it. Errors: the file cannot be written.
  Result<void> add(const std::string& profile, const std::string& toml);

  // Of the cases in the folder at open(), those that are used, and why others are not.
  std::size_t used() const { return used_; }
  const std::map<std::string, std::size_t>& skipped() const { return skipped_; }
  // By add().
  std::size_t added() const { return added_; }
  std::size_t left_out() const { return left_out_; }

 private:
  Result<void> read(const std::filesystem::path& file, std::span<const ModuleUnderTest> subjects,
                    Level level);

  std::filesystem::path folder_;
  std::vector<HuntInputs> inputs_;
  std::map<std::pair<std::string, Module>, std::size_t> cases_;  // in the folder
  std::map<std::string, std::size_t> skipped_;
  std::size_t used_ = 0, added_ = 0, left_out_ = 0;
};

}  // namespace attest
