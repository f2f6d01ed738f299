// Selects vectors: the cases and their run configurations.
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/casefile/parse.hpp"
#include "harness/core/result.hpp"

namespace attest {

// Part I of N, I from 1, of the cases that the other options select. Parts take about equally long.
struct Shard {
  std::size_t index = 1;
  std::size_t count = 1;

  std::string to_string() const;  // "2/4"
  friend bool operator==(const Shard&, const Shard&) = default;

  static Result<Shard> parse(const std::string& text);  // "2/4"
};

// Empty lists select everything.
struct Selection {
  // Shell patterns (* ? [..]). A vector is selected if a pattern matches one of:
  // - its id `<profile>/<group>/<name>@<configuration>`
  // - that id without the configuration, or with the rate only
  // - one of these without the profile
  // - the name alone
  std::vector<std::string> filters;
  std::vector<std::string> excludes;  // patterns as above; vectors that match are left out
  std::vector<std::string> groups;
  std::vector<std::string> profiles;
  std::vector<LoopRate> rates;
  std::vector<std::string> vehicles;  // if this or `plants` is not empty, only flights are selected
  std::vector<std::string> plants;
  Shard shard;
};

struct SelectedCase {
  Case the_case;
  std::vector<RunConfiguration>
      configurations;  // in the order of Case::configurations(), not empty
};

// Keeps the vectors with these ids (Case::id_at), in the same order. Other cases are removed.
std::vector<SelectedCase> keep_vectors(std::vector<SelectedCase> cases,
                                       const std::set<std::string>& ids);

// `--group attitude,rates` for each list that is not empty.
std::vector<std::string> as_options(
    std::initializer_list<std::pair<const char*, const std::vector<std::string>&>> lists);

// Reads the case files below `folders` that can match and keeps the selected ones, in the order of
// their ids. Errors: those of find_case_files(); a malformed case file; an unknown group, profile,
// rate, vehicle or plant, with the known ones; a filter or an exclusion that matches no vector; an
// empty selection or shard; two files with the same case id.
Result<std::vector<SelectedCase>> select_cases(const CaseFolders& folders,
                                               const Selection& selection);

}  // namespace attest
