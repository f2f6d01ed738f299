#include "harness/diagnosis/hunt_corpus.hpp"

#include <algorithm>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

#include "harness/casefile/parse.hpp"
#include "harness/core/file.hpp"
#include "harness/diagnosis/hunt_start.hpp"
#include "harness/diagnosis/hunt_trial.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

// Not those directly in `folder`, which are about the suite, nor hidden files, which an editor or a
// killed process may have left.
bool is_of_corpus(const fs::path& file, const fs::path& folder) {
  return file.parent_path() != folder && !file.filename().string().starts_with('.');
}

// Of a case with several rates, the one that is nearest to the usual 250 Hz.
Rate rate_of(const Case& the_case) {
  const auto distance = [](const LoopRate& rate) { return distance_of(rate.motor_unit, 250); };
  return std::ranges::min(the_case.rates, {}, distance).motor_unit;
}

}  // namespace

Result<HuntCorpus> HuntCorpus::open(const fs::path& folder,
                                    std::span<const ModuleUnderTest> subjects, Level level) {
  HuntCorpus corpus;
  corpus.folder_ = folder;
  std::error_code failed;
  if (!fs::exists(folder, failed)) return corpus;
  const auto files = files_below(folder);
  if (!files) return tl::unexpected(files.error());
  for (const fs::path& file : *files) {
    if (!is_of_corpus(file, folder)) continue;
    if (auto read = corpus.read(file, subjects, level); !read) return tl::unexpected(read.error());
  }
  return corpus;
}

Result<void> HuntCorpus::read(const fs::path& file, std::span<const ModuleUnderTest> subjects,
                              Level level) {
  if (file.extension() != ".toml") {
    return fail_at(file.string(),
                   "is not a case, and a corpus has only cases; remove it, or name another folder");
  }
  const auto parsed = parse_case(file);
  if (!parsed) {
    return fail(
        fmt::format("{}\nthe corpus has this file, which is not a case of this attest; "
                    "correct or remove it, or name another folder",
                    parsed.error().to_string()));
  }
  ++cases_[{parsed->profile, parsed->module}];
  const bool is_hunted = contains(subjects, parsed->profile, parsed->module);
  const bool is_exact = parsed->exact_only && level != Level::exact;
  if (parsed->flight || !is_hunted || is_exact) {
    ++skipped_[parsed->flight ? "a flight"
               : is_exact     ? "for the level exact only"
                              : "of a profile or module that is not hunted"];
    return {};
  }
  ++used_;
  std::ranges::move(trials_of_case(*parsed, rate_of(*parsed)), std::back_inserter(inputs_));
  return {};
}

Result<void> HuntCorpus::add(const std::string& profile, const std::string& toml) {
  const fs::path group = folder_ / profile / hunt_group;
  const auto parsed = parse_case_text(toml, group / "case.toml");
  if (!parsed) return tl::unexpected(parsed.error());
  constexpr std::size_t digits = 16;
  const fs::path file =
      group / fmt::format("{}_{}.toml", name_of(parsed->module), parsed->sha256.substr(0, digits));
  std::error_code failed;
  if (fs::exists(file, failed)) return {};
  std::size_t& cases = cases_[{profile, parsed->module}];
  if (cases >= most_of_corpus) {
    ++left_out_;
    return {};
  }
  fs::create_directories(group, failed);
  if (failed) return fail_at(group.string(), "cannot be made: " + failed.message());
  ++cases;
  ++added_;
  return write_file(file, toml, AtomicFile::Special::replaced);
}

}  // namespace attest
