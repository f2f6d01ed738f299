// Puts the JSON reports of shards together.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/cli/conclude.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/released_suite.hpp"
#include "harness/cli/run_plan.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/core/version.hpp"
#include "harness/port/port.hpp"
#include "harness/report/read_report.hpp"
#include "harness/sweep/identity.hpp"

namespace attest::cli {
namespace {

struct MergeOptions {
  std::vector<std::string> files;  // JSON reports
  std::string port;                // for the diagnosis; empty: the port that the reports name
  int jobs = 1;
  double timeout_s = default_timeout_s;
  ReportOptions report;
};

struct Part {
  std::string file;
  ReadReport run;
};

// A property that must be the same in all parts: its name, and its value as text for an error
// message.
using Property = std::pair<const char*, std::function<std::string(const RunResult&)>>;

// "port.py" of "mine/port.py". The folder of an argument such as --gains=/a/b or runs/a stays: it
// need not be a file, whose bytes are in the hash of the port.
std::string_view without_folder(std::string_view word, bool is_first) {
  const std::string_view name = word.substr(word.find_last_of('/') + 1);
  const bool is_file = is_first || name.find('.') != std::string_view::npos;
  return is_file && word.find('=') == std::string_view::npos ? name : word;
}

// A port as each machine may have it in a folder of its own: "proc:python3 port.py" of
// "proc:python3 mine/port.py".
std::string without_folders(const std::string& port) {
  const std::string prefix(kind_of(port).prefix);
  std::string out = prefix;
  bool is_first = true;
  for (std::size_t begin = prefix.size(); begin < port.size();) {
    const std::size_t end = std::min(port.find_first_of(" \"'", begin), port.size());
    out += without_folder(std::string_view(port).substr(begin, end - begin), is_first);
    is_first = is_first && end == begin;
    if (end < port.size()) out += port[end];
    begin = end + 1;
  }
  return out;
}

// The port's declarations, except its name.
std::string declarations_of(const RunResult& run) {
  return fmt::format(
      "modules {}, {} fraction bits, fixed step {}, lacks {}",
      fmt::join(names_of(run.port_modules), " "), run.fraction_bits.value_or(0),
      run.fixed_step ? run.fixed_step->to_string() : "none",
      run.lacks.any() ? fmt::format("{}", fmt::join(run.lacks.words, ", ")) : "nothing");
}

std::string limits_of(const RunResult& run) {
  const Limits& limits = run.limits;
  if (!limits.own_process) return "--in-process";
  const auto missing = missing_parts(limits.barrier);
  return fmt::format("{} s, {} GiB, {} MiB a file{}{}", limits.timeout_s,
                     limits.memory_gib.value_or(0), limits.file_mib,
                     missing.empty() ? "" : ", no barrier for ", fmt::join(missing, ", "));
}

const std::vector<Property>& properties() {
  static const std::vector<Property> all = {
      {"version of attest", [](const RunResult& run) { return run.attest_version; }},
      {"suite", [](const RunResult& run) { return run.suite_sha256; }},
      {"version of the suite",
       [](const RunResult& run) { return run.cases_version + ", " + run.golden_version; }},
      {"reference of the suite", [](const RunResult& run) { return run.suite_reference; }},
      {"port", [](const RunResult& run) { return without_folders(run.port); }},
      {"hash of the port", [](const RunResult& run) { return run.port_sha256; }},
      {"list of files of the port",
       [](const RunResult& run) { return fmt::format("{}", fmt::join(run.port_files, ",")); }},
      {"name of the port",
       [](const RunResult& run) { return run.port_name + " " + run.port_version; }},
      {"declaration of the port", declarations_of},
      {"level", [](const RunResult& run) { return std::string(name_of(run.level)); }},
      {"selection", [](const RunResult& run) { return run.selection; }},
      {"recorded timing", [](const RunResult& run) { return run.timing; }},
      {"parameters", [](const RunResult& run) { return text_of(run.parameters, " "); }},
      {"number of shards", [](const RunResult& run) { return fmt::to_string(run.shard.count); }},
      {"limit of the port", limits_of},
  };
  return all;
}

Result<std::vector<Part>> read_parts(const std::vector<std::string>& files) {
  std::vector<Part> parts;
  for (const std::string& file : files) {
    std::error_code failed;
    if (std::filesystem::exists(std::filesystem::path(file) / identity_file, failed)) {
      return fail_at(file,
                     "is a folder of `attest sweep`; `attest sweep FILE --merge DIR... --out DIR` "
                     "joins the shards of a sweep");
    }
    auto run = read_report(file);
    if (!run) return tl::unexpected(run.error());
    parts.push_back({file, *std::move(run)});
  }
  return parts;
}

// Errors: parts that differ in a property, two reports of one shard, a missing shard.
Result<void> check_parts(const std::vector<Part>& parts) {
  const Part& first = parts.front();
  std::map<std::size_t, std::string> by_shard;
  for (const Part& part : parts) {
    for (const auto& [name, of] : properties()) {
      if (of(part.run) == of(first.run)) continue;
      return fail_at(part.file, fmt::format("the {} is `{}`, but in {} it is `{}`", name,
                                            of(part.run), first.file, of(first.run)));
    }
    const auto [other, is_new] = by_shard.emplace(part.run.shard.index, part.file);
    if (!is_new) {
      return fail_at(part.file, fmt::format("is shard {}, and so is {}", part.run.shard.to_string(),
                                            other->second));
    }
  }
  const std::size_t count = first.run.shard.count, missing = count - by_shard.size();
  if (missing == 0) return {};
  std::size_t index = 1;
  while (by_shard.contains(index)) ++index;
  return fail(fmt::format("missing: the report of shard {}{}", Shard{index, count}.to_string(),
                          missing == 1 ? "" : fmt::format(" and {} more", missing - 1)));
}

Result<void> check_suite(const SuiteFolder& suite, const RunResult& run) {
  const auto hash = suite.hash();
  if (!hash) return tl::unexpected(hash.error());
  if (hash->sha256 == run.suite_sha256) return {};
  return fail_at(suite.root.string(),
                 fmt::format("is suite {:.12}, but the reports are of {:.12}; name theirs with "
                             "--suite DIR",
                             hash->sha256, run.suite_sha256));
}

// Compares the reports with this attest and its suite, and returns the cases of the suite.
// REQUIRES: check_parts().
Result<std::vector<SelectedCase>> check_results(const SuiteFolder& suite,
                                                std::vector<Part>& parts) {
  const RunResult& first = parts.front().run;
  if (first.attest_version != version) {
    return fail(
        fmt::format("the reports are of attest {}, this is {}", first.attest_version, version));
  }
  if (auto checked = check_suite(suite, first); !checked) return tl::unexpected(checked.error());
  auto cases = select_cases(suite.case_folders(), {});
  if (!cases) return cases;
  for (Part& part : parts) {
    part.run.suite_is_released = part.run.suite_sha256 == released_suite_sha256();
    if (auto checked = check_against(*cases, part.run, part.file); !checked) {
      return tl::unexpected(checked.error());
    }
  }
  return cases;
}

// Puts the results in the order of the suite, which is that of a run without shards. Errors: two
// results of one vector. REQUIRES: the suite has all vectors.
Result<void> put_in_order(const std::vector<SelectedCase>& cases, RunResult& run) {
  std::map<std::string, std::size_t> place;
  for (const SelectedCase& selected : cases) {
    for (const RunConfiguration& configuration : selected.the_case.configurations()) {
      place.emplace(selected.the_case.id_at(configuration), place.size());
    }
  }
  std::set<std::string> known;
  for (const VectorResult& result : run.results) {
    if (!known.insert(result.id()).second) {
      return fail(fmt::format("{} is in two reports", result.id()));
    }
  }
  std::sort(run.results.begin(), run.results.end(),
            [&](const VectorResult& a, const VectorResult& b) {
              return place.at(a.id()) < place.at(b.id());
            });
  return {};
}

// Joins the parts. Members that are not joined here are the same in all parts. REQUIRES:
// check_parts().
RunResult merged(std::vector<Part> parts) {
  RunResult run = std::move(parts.front().run);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    RunResult& part = parts[i].run;
    std::move(part.results.begin(), part.results.end(), std::back_inserter(run.results));
    std::move(part.errors.begin(), part.errors.end(), std::back_inserter(run.errors));
    run.rates.insert(run.rates.end(), part.rates.begin(), part.rates.end());
    run.date = std::max(run.date, part.date);
    run.selected += part.selected;
    run.all_configurations = run.all_configurations && part.all_configurations;
    run.stopped_early = run.stopped_early || part.stopped_early;
    std::move(part.not_run.begin(), part.not_run.end(), std::back_inserter(run.not_run));
  }
  std::sort(run.rates.begin(), run.rates.end());
  run.rates.erase(std::unique(run.rates.begin(), run.rates.end()), run.rates.end());
  run.shard = {};
  return run;
}

// The port for the diagnosis. Empty: the port is missing or has another hash, and a note is
// printed.
std::optional<HostOptions> host_for(const MergeOptions& options, const Globals& globals,
                                    const RunResult& run) {
  HostOptions host;
  host.port = options.port.empty() ? run.port : options.port;
  host.timeout_s = options.timeout_s;
  host.stop = interrupted;
  host.barrier = globals.barrier;
  // The code of another port is not called.
  std::string why;
  if (auto files = PortFiles::read(host.port, run.port_files); !files) {
    why = files.error().to_string();
  } else if (files->sha256() != run.port_sha256) {
    why = "its files have other bytes";
  } else {
    host.files = std::make_shared<const PortFiles>(*std::move(files));
    const auto port = describe_port(host);
    if (port) {
      hold_to(*port, host);
      return host;
    }
    why = port.error().to_string();
  }
  fmt::print(stderr,
             "attest: note: no probable mistake is named, because {} is not the port of the "
             "reports: {}{}\n",
             host.port, why, options.port.empty() ? "; name the port with --port" : "");
  return std::nullopt;
}

int merge_command(const MergeOptions& options, const Globals& globals) {
  const auto begin = std::chrono::steady_clock::now();
  note_interrupts();
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  std::vector<std::string> outputs;
  for (const auto& [option, path] : options.report.files) outputs.push_back(path);
  const auto apart = check_outputs(outputs, {options.port, options.files}, globals.suite);
  if (!apart) return report_error(apart.error());
  auto parts = read_parts(options.files);
  if (!parts) return report_error(parts.error());
  if (auto checked = check_parts(*parts); !checked) return report_error(checked.error());
  const auto cases = check_results(*suite, *parts);
  if (!cases) return report_error(cases.error());
  RunResult run = merged(*std::move(parts));
  if (auto ordered = put_in_order(*cases, run); !ordered) return report_error(ordered.error());
  run.suite = vectors_by_group(*suite, run.suite_sha256);
  run.suite_folder = globals.suite;
  name_files(*cases, Goldens(suite->golden()), *suite, run);
  auto reports = open_reports(options.report);
  if (!reports) return report_error(reports.error());
  ReportOptions report = options.report;
  std::optional<HostOptions> host;
  if (report.diagnose && run.failed()) host = host_for(options, globals, run);
  report.diagnose = host.has_value();
  return conclude(run, {*cases, host.value_or(HostOptions{}), options.jobs, {}}, report,
                  *std::move(reports), begin, globals);
}

}  // namespace

void add_merge(const CommandLine& line) {
  auto options = std::make_shared<MergeOptions>();
  const Command command = line.add("merge", "Join the JSON reports of the shards of a run");
  command.option("reports", options->files, "The reports of all shards, in any order")
      .type("REPORT")
      .required();
  command
      .option("--port", options->port,
              "Port that the diagnosis runs; default: the port of the reports")
      .type("PORT");
  add_jobs(command, options->jobs, "Number of worker processes for the diagnosis");
  add_timeout(command, options->timeout_s);
  add_reports(command, options->report);
  command.examples({{"attest run --port lib:./libmine.so --shard 1/4 --json part1.json",
                     "run the first of four shards"},
                    {"attest merge part*.json --json attest.json --junit attest.junit.xml",
                     "join the reports of all shards"}});
  command.runs(options, merge_command);
}

}  // namespace attest::cli
