// Which cases, at which rates.
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/result.hpp"

namespace attest {

// Part I of N, I from 1: cases I, I+N, I+2N, ... of those that are selected otherwise.
struct Shard {
  std::size_t index = 1;
  std::size_t count = 1;

  static Result<Shard> parse(const std::string& text);  // "2/4"
};

// Empty lists select everything.
struct Selection {
  // Shell patterns (* ? [..]); one must match the id `<profile>/<group>/<name>@<configuration>`, or
  // that id without the configuration, or with its rate only, or one of these without profile, or
  // the name alone.
  std::vector<std::string> filters;
  std::vector<std::string> excludes;  // patterns as above, of what is left out
  std::vector<std::string> groups;
  std::vector<std::string> profiles;
  std::vector<Rate> rates;
  std::vector<std::string> vehicles;  // these two select flights only
  std::vector<std::string> plants;
  Shard shard;
};

struct SelectedCase {
  Case the_case;
  std::vector<RunConfiguration>
      configurations;  // in the order of Case::configurations(), not empty
};

// `--group attitude,rates` for each list that is not empty.
std::vector<std::string> as_options(
    std::initializer_list<std::pair<const char*, const std::vector<std::string>&>> lists);

// Reads the case files below `folder` that can match and keeps what is selected, in the order of
// their ids. Errors: a malformed case file, an unknown group, profile, rate, vehicle or plant,
// a filter or an exclusion that matches nothing, nothing selected; each says what there is.
Result<std::vector<SelectedCase>> select_cases(const std::filesystem::path& folder,
                                               const Selection& selection);

}  // namespace attest
