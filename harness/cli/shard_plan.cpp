#include "harness/cli/shard_plan.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <kainjow/mustache.hpp>
#include <unistd.h>

#include "harness/cli/new_folder.hpp"
#include "harness/core/embed.hpp"
#include "harness/core/file.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/report/text.hpp"

ATTEST_EMBED(shard_script, ATTEST_SHARD_SCRIPT);
ATTEST_EMBED(merge_script, ATTEST_MERGE_SCRIPT);
ATTEST_EMBED(slurm_shards, ATTEST_SLURM_SHARDS);
ATTEST_EMBED(slurm_merge, ATTEST_SLURM_MERGE);
ATTEST_EMBED(slurm_submit, ATTEST_SLURM_SUBMIT);
ATTEST_EMBED(parallel_run, ATTEST_PARALLEL_RUN);
ATTEST_EMBED(parallel_jobs, ATTEST_PARALLEL_JOBS);
ATTEST_EMBED(github_workflow, ATTEST_GITHUB_WORKFLOW);
ATTEST_EMBED(github_set_up, ATTEST_GITHUB_SET_UP);
ATTEST_EMBED(gitlab_pipeline, ATTEST_GITLAB_PIPELINE);
ATTEST_EMBED(install_script, ATTEST_INSTALL_SCRIPT);

namespace attest::cli {
namespace {

namespace fs = std::filesystem;
using kainjow::mustache::data;

struct PlannedFile {
  const char* name;
  std::string_view content;  // a template
  bool is_program;
};

using Quote = std::string (*)(std::string_view);

struct Kind {
  const char* name;
  Quote word;  // quotes a word of a command in its files
  std::vector<PlannedFile> files;
  bool shares_folder;       // all machines have the files of this machine
  std::size_t most_shards;  // in a job array or a matrix
  const char* next;         // what the user does; {0} is the folder
};

// A word of the shell. GitHub would evaluate `${{ ... }}` in it, so `${{` is escaped.
std::string github_word(std::string_view text) {
  constexpr std::string_view begin = "${{";
  std::string out = shell_word(text);
  for (std::size_t at = out.find(begin); at != std::string::npos; at = out.find(begin, at)) {
    constexpr std::string_view as_value = "${{ '${{' }}";
    out.replace(at, begin.size(), as_value);
    at += as_value.size();
  }
  return out;
}

std::vector<Kind> kinds() {
  const PlannedFile shard{"shard", ATTEST_EMBEDDED(shard_script), true};
  const PlannedFile merge{"merge", ATTEST_EMBEDDED(merge_script), true};
  const PlannedFile install{"install-attest", ATTEST_EMBEDDED(install_script), true};
  return {
      {"slurm",
       shell_word,
       {shard,
        merge,
        {"shards.sbatch", ATTEST_EMBEDDED(slurm_shards), false},
        {"merge.sbatch", ATTEST_EMBEDDED(slurm_merge), false},
        {"submit", ATTEST_EMBEDDED(slurm_submit), true}},
       true,
       4'000'000,  // the largest index that Slurm can allow (MaxArraySize); often 1000
       "{0}/submit submits them to Slurm, and a merge that writes {0}/results"},
      {"parallel",
       shell_word,
       {shard,
        merge,
        {"jobs.txt", ATTEST_EMBEDDED(parallel_jobs), false},
        {"run", ATTEST_EMBEDDED(parallel_run), true}},
       true,
       10'000'000,
       "{0}/run flies them with GNU parallel, then merges them to {0}/results"},
      {"github",
       github_word,
       {{"sweep.yml", ATTEST_EMBEDDED(github_workflow), false}, install},
       false,
       256,  // docs.github.com, "Usage limits": jobs of a matrix
       "put {0}/sweep.yml into .github/workflows, and {0}/install-attest into the top folder"},
      {"gitlab",
       shell_word,
       {{"sweep.yml", ATTEST_EMBEDDED(gitlab_pipeline), false}, install},
       false,
       200,  // docs.gitlab.com, "CI/CD YAML syntax reference": parallel
       "include {0}/sweep.yml in .gitlab-ci.yml, and put {0}/install-attest into the top folder"},
  };
}

Result<Kind> kind_named(const std::string& name) {
  std::vector<std::string> names;
  for (Kind& kind : kinds()) {
    if (kind.name == name) return std::move(kind);
    names.emplace_back(kind.name);
  }
  return fail(fmt::format("--plan {}: no such plan{}; there are {}", name, suggestion(name, names),
                          fmt::join(names, ", ")));
}

// The quoted words, each with a space behind it: "--suite mine ".
std::string words(const std::vector<std::string>& all, Quote quote) {
  std::string text;
  for (const std::string& one : all) text += quote(one) + " ";
  return text;
}

// The words of the command `attest SUITE sweep SWEEP`. `report` has the options of the merge.
struct Command {
  std::vector<std::string> suite, sweep, report;
};

Command command_of(const PreparedSweep& sweep, const SweepOptions& options,
                   const Globals& globals) {
  Command command;
  const char* const from_environment = std::getenv("ATTEST_SUITE");
  const std::string suite = !globals.suite.empty() ? globals.suite
                            : from_environment     ? from_environment
                                                   : "";
  if (!suite.empty()) command.suite = {"--suite", suite};
  command.sweep = {options.file};
  const auto add = [](std::vector<std::string>& to, const char* option, const std::string& value) {
    to.insert(to.end(), {option, value});
  };
  if (!options.vehicle.empty()) add(command.sweep, "--vehicle", options.vehicle);
  if (!options.plant.empty()) add(command.sweep, "--plant", options.plant);
  if (options.samples != 0) add(command.sweep, "--samples", fmt::to_string(options.samples));
  if (sweep.flights.with_port) add(command.sweep, "--port", options.host.port);
  if (options.host.timeout_s != default_timeout_s) {
    add(command.sweep, "--timeout", fmt::to_string(options.host.timeout_s));
  }
  if (options.keep_worst != 0) {
    add(command.report, "--keep-worst", fmt::to_string(options.keep_worst));
  }
  if (!options.html.empty()) add(command.report, "--html", options.html);
  return command;
}

Result<void> check_names(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const auto is_control = [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; };
    if (std::none_of(name.begin(), name.end(), is_control)) continue;
    return fail(
        fmt::format("`{}` has a control character, which the files of a plan cannot hold", name));
  }
  return {};
}

// A machine of a CI service has the repository as its working folder, and no other file of this
// machine.
Result<void> check_relative(const std::string& path) {
  const fs::path normal = fs::path(path).lexically_normal();
  if (!normal.is_absolute() && *normal.begin() != "..") return {};
  return fail_at(path,
                 "is a path that a machine of CI does not have; run this command in the top folder "
                 "of the repository, with a relative path");
}

std::vector<std::string> indices_up_to(std::size_t count) {
  std::vector<std::string> indices;
  for (std::size_t i = 1; i <= count; ++i) indices.push_back(fmt::to_string(i));
  return indices;
}

// Absolute paths for the scripts.
struct Places {
  std::string folder, work_folder, attest;
};

Places places_of(const std::string& out) {
  std::error_code failed;
  fs::path folder = fs::absolute(out, failed).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  return {folder.string(), fs::current_path(failed).string(),
          fs::read_symlink("/proc/self/exe", failed).string()};
}

data values_of(const Kind& kind, const PreparedSweep& sweep, const SweepOptions& options,
               const Command& command, const Places& places) {
  const std::vector<std::string> indices = indices_up_to(options.shards);
  data each_shard(data::type::list);
  for (const std::string& index : indices) each_shard.push_back(data("index", index));
  data values;
  values.set("folder", places.folder);
  values.set("work_folder", places.work_folder);
  values.set("attest", places.attest);
  values.set("shards", fmt::to_string(options.shards));
  values.set("jobs", fmt::to_string(options.jobs));
  values.set("percent_of_cpus", fmt::to_string(std::max(1, 100 / options.jobs)));
  values.set("suite", words(command.suite, kind.word));
  values.set("sweep", words(command.sweep, kind.word));
  values.set("report", words(command.report, kind.word));
  values.set("with_port", sweep.flights.with_port);
  values.set("indices", fmt::format("{}", fmt::join(indices, ", ")));
  values.set("each_shard", each_shard);
  std::string set_up(ATTEST_EMBEDDED(github_set_up));
  set_up.pop_back();  // its last line break, because the line of the tag has one
  values.set("set_up", kainjow::mustache::partial([set_up] { return set_up; }));
  return values;
}

std::string filled(std::string_view content, const data& values, Quote quote) {
  kainjow::mustache::mustache page{std::string(content)};
  page.set_custom_escape([quote](const std::string& text) { return quote(text); });
  return page.render(values);
}

// To flush each file alone would take seconds for a thousand shards, so all are flushed together at
// the end.
Result<void> make_shard_folders(const PreparedSweep& sweep, std::size_t count,
                                const fs::path& folder) {
  SweepIdentity identity = sweep.identity;
  for (std::size_t index = 1; index <= count; ++index) {
    identity.shard = Shard{index, count}.to_string();
    const fs::path of_shard = folder / "shards" / fmt::to_string(index);
    fs::create_directories(of_shard);
    std::ofstream file(of_shard / identity_file);
    if (!(file << identity_text(identity)).flush()) {
      return fail_at((of_shard / identity_file).string(), "cannot be written");
    }
  }
  const int top = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool is_flushed = top >= 0 && ::syncfs(top) == 0;
  if (top >= 0) ::close(top);
  return is_flushed ? Result<void>() : fail_at(folder.string(), "cannot be written");
}

Result<void> check(const Kind& kind, const PreparedSweep& sweep, const SweepOptions& options,
                   const Command& command, const Places& places) {
  if (options.shards > sweep.samples()) {
    return fail(
        fmt::format("--shards {}: the sweep has only {} samples", options.shards, sweep.samples()));
  }
  if (options.shards > kind.most_shards) {
    return fail(fmt::format("--shards {}: {} takes at most {}", options.shards, kind.name,
                            kind.most_shards));
  }
  std::vector<std::string> names = {places.folder, places.work_folder, places.attest};
  names.insert(names.end(), command.suite.begin(), command.suite.end());
  names.insert(names.end(), command.sweep.begin(), command.sweep.end());
  names.insert(names.end(), command.report.begin(), command.report.end());
  if (auto checked = check_names(names); !checked) return checked;
  if (kind.shares_folder) return {};
  if (!options.html.empty()) {
    return fail_at(options.html,
                   "a CI service keeps only the folder of the results; leave it out, and make "
                   "it from that folder");
  }
  if (!command.suite.empty()) {
    if (auto checked = check_relative(command.suite.back()); !checked) return checked;
  }
  return check_relative(options.file);
}

}  // namespace

Result<std::string> plan_shards(const PreparedSweep& sweep, const SweepOptions& options,
                                const Globals& globals) {
  const auto kind = kind_named(options.plan);
  if (!kind) return tl::unexpected(kind.error());
  const Command command = command_of(sweep, options, globals);
  const Places places = places_of(options.out);
  if (auto checked = check(*kind, sweep, options, command, places); !checked) {
    return tl::unexpected(checked.error());
  }
  const data values = values_of(*kind, sweep, options, command, places);
  const auto fill = [&](const fs::path& folder) -> Result<void> {
    for (const PlannedFile& file : kind->files) {
      const fs::path path = folder / file.name;
      if (auto done = write_file(path, filled(file.content, values, kind->word)); !done)
        return done;
      constexpr auto run = fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec;
      if (file.is_program) fs::permissions(path, run, fs::perm_options::add);
    }
    if (!kind->shares_folder) return {};
    fs::create_directories(folder / "logs");
    return make_shard_folders(sweep, options.shards, folder);
  };
  if (auto made = make_new_folder(options.out, fill); !made) return tl::unexpected(made.error());
  return fmt::format("{} samples in {} shards: {}", sweep.samples(), options.shards,
                     fmt::format(fmt::runtime(kind->next), shell_word(options.out)));
}

}  // namespace attest::cli
