#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/cli/outputs.hpp"
#include "harness/cli/prepare_sweep.hpp"
#include "harness/cli/shard_plan.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/file.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/report/progress.hpp"
#include "harness/report/sweep_document.hpp"
#include "harness/sweep/early_stop.hpp"
#include "harness/sweep/keep_flights.hpp"
#include "harness/sweep/merge_shards.hpp"
#include "harness/sweep/summary_json.hpp"

namespace attest::cli {
namespace {

namespace fs = std::filesystem;

SampleRow row_of(std::string_view line, const SampleColumns& columns, std::uint64_t index) {
  SampleRow row;
  line.remove_suffix(1);  // the line break
  read_row(line, columns, index, row);
  return row;
}

// Waits while another process of this machine makes the table. Empty: interrupted.
Result<std::optional<SampleTable>> open_table(const SampleColumns& columns, const fs::path& folder,
                                              const SampleRange& range, EarlyStop& early) {
  bool is_first = true;
  while (!interrupted()) {
    auto table = SampleTable::open(folder / sample_file, columns, range,
                                   [&](const SampleRow& row) { early.add(row); });
    if (!table || *table) return table;
    if (std::exchange(is_first, false)) {
      fmt::print(stderr, "attest: note: waiting for another `attest sweep` that flies for {}\n",
                 folder.string());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return std::nullopt;
}

// Flies the samples that the table lacks. Returns the index after the last sample of the table,
// also after an interrupt.
Result<std::uint64_t> fly_missing(const PreparedSweep& sweep, const fs::path& folder, bool quiet) {
  const SampleRange range = range_of(sweep.shard, sweep.samples());
  const SampleColumns columns = sweep.columns();
  EarlyStop early(sweep.sampler.sweep(), columns);
  auto opened = open_table(columns, folder, range, early);
  if (!opened) return tl::unexpected(opened.error());
  if (!*opened) return range.begin;
  SampleTable* const table = &**opened;
  if (const auto flown = table->next() - range.begin;
      flown > 0 && flown < range.size() && !early.is_decided() && !quiet) {
    fmt::print(stderr, "attest: note: continues after {} of {} samples\n", flown, range.size());
  }
  Progress progress(range.size(), Progress::on_stderr(quiet), table->next() - range.begin);
  const auto on_row = [&](const std::string& row) -> Result<void> {
    if (early.is_decided()) return {};  // a worker had begun this sample before the decision
    const std::uint64_t index = table->next();
    const std::string sample = fmt::format("sample {}", index);
    progress.add(row.find(fmt::format(",{}", outcome_diverged)) != std::string::npos, sample);
    if (auto appended = table->append(row); !appended) return appended;
    early.add(row_of(row, columns, index));
    return {};
  };
  FlightsOptions flights = sweep.flights;
  flights.stop = [&] { return sweep.flights.stop() || early.is_decided(); };
  const SampleRange missing{table->next(), early.is_decided() ? table->next() : range.end};
  // Workers may have begun a sample after the one that decided. If that sample cannot be flown, the
  // error is ignored, so that the result is the same for any number of jobs.
  const auto flown = fly_samples(sweep.sampler, missing, flights, on_row);
  if (!flown && !early.is_decided()) {
    return tl::unexpected(flown.error());
  }
  if (interrupted()) return table->next();
  if (auto same = check_port(flights.host); !same) return tl::unexpected(same.error());
  if (auto finished = table->finish(); !finished) return tl::unexpected(finished.error());
  return table->next();
}

std::vector<std::uint64_t> worst_samples_of(const SweepSummary& summary) {
  std::set<std::uint64_t> samples;
  for (const RequirementResult& one : summary.requirements) {
    samples.insert(one.worst.begin(), one.worst.end());
  }
  return {samples.begin(), samples.end()};
}

// Makes the reports, the kept flights and the text on stdout from the complete table of the folder.
Result<SweepSummary> report(const PreparedSweep& sweep, const SweepOptions& options,
                            const SuiteFolder& suite, std::uint64_t samples, bool quiet,
                            AtomicFile html) {
  const fs::path folder = options.out;
  const SampleColumns columns = sweep.columns();
  const auto data = read_samples(folder / sample_file, columns, {0, samples});
  if (!data) return tl::unexpected(data.error());
  SweepSummary summary = summarise(sweep.sampler.sweep(), columns, *data,
                                   static_cast<std::size_t>(options.keep_worst));
  const fs::path kept = folder / "worst";
  const std::vector<std::uint64_t> worst = worst_samples_of(summary);
  if (auto done = keep_flights(sweep.sampler, worst, suite.models(), kept); !done) {
    return tl::unexpected(done.error());
  }
  const auto written =
      write_file(folder / "report.json", summary_json(sweep.identity, columns, summary),
                 AtomicFile::Special::replaced);
  if (!written) return tl::unexpected(written.error());
  const fs::path shown = worst.empty() ? fs::path() : kept;
  const Document document =
      sweep_document({sweep.sampler, columns, *data, summary, sweep.identity, shown});
  if (!options.html.empty()) {
    if (auto done = html.commit(html_page(document)); !done) return tl::unexpected(done.error());
  }
  if (!quiet) fmt::print("{}", render_text(document, terminal_style(stdout)));
  return summary;
}

void print_interrupted(const PreparedSweep& sweep, const SweepOptions& options) {
  fmt::print(stderr,
             "attest: note: interrupted; {} has the samples that were flown, and the same command "
             "flies the others of {}\n",
             options.out, range_of(sweep.shard, sweep.samples()).size());
}

bool is_in(const fs::path& file, const fs::path& folder) {
  std::error_code failed;
  const fs::path inner = fs::weakly_canonical(file, failed);
  const fs::path outer = fs::weakly_canonical(folder, failed);
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

// Errors: `file` is in a folder of results, which it could overwrite.
Result<void> check_apart(const std::string& file, const SweepOptions& options) {
  std::vector<std::string> folders = options.merge;
  folders.push_back(options.out);
  for (const std::string& folder : folders) {
    if (file.empty() || !is_in(file, folder)) continue;
    return fail_at(file,
                   fmt::format("is in {}, a folder of results; give a file elsewhere", folder));
  }
  return {};
}

Result<void> check_options(const SweepOptions& options, const std::string& suite) {
  if (options.out.empty()) return fail("needs --out, the folder of the results");
  if (auto apart = check_output_folder(options.out, suite); !apart) return apart;
  if (auto apart = check_apart(options.html, options); !apart) return apart;
  return check_outputs({options.html}, {options.host.port, {options.file}}, suite);
}

// Errors: shards together with an option or key that needs all samples in one sweep.
Result<void> check_shard(const PreparedSweep& sweep, const SweepOptions& options) {
  const bool is_part = sweep.shard.count > 1;
  if (is_part && !options.html.empty()) {
    return fail_at(options.html, "needs all samples, so a shard cannot write it; use --merge");
  }
  const bool has_shards = is_part || !options.merge.empty() || !options.plan.empty();
  if (!sweep.sampler.sweep().stop_when_decided || !has_shards) return {};
  return fail_at(options.file,
                 "has `stop_when_decided`: whether a sample is flown depends on those before it, "
                 "so shards are not possible; remove the key");
}

int sweep_command(const SweepOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  if (auto checked = check_options(options, globals.suite); !checked) {
    return report_error(checked.error());
  }
  auto html = AtomicFile::open(options.html);  // before the port's code runs
  if (!html) return report_error(html.error());
  const auto sweep = prepare_sweep(options, *suite);
  if (!sweep) return report_error(sweep.error());
  if (auto checked = check_shard(*sweep, options); !checked) return report_error(checked.error());
  if (!options.plan.empty()) {
    const auto planned = plan_shards(*sweep, options, globals);
    if (!planned) return report_error(planned.error());
    if (!globals.quiet) fmt::print("{}\n", *planned);
    return exit_ok;
  }
  std::uint64_t samples = sweep->samples();
  if (!options.merge.empty()) {
    const auto merged = merge_shards({options.merge.begin(), options.merge.end()}, sweep->identity,
                                     sweep->columns(), sweep->samples(), options.out);
    if (!merged) return report_error(merged.error());
  } else {
    if (auto claimed = claim_folder(options.out, sweep->identity); !claimed) {
      return report_error(claimed.error());
    }
    note_interrupts();
    const auto flown = fly_missing(*sweep, options.out, globals.quiet);
    if (!flown) return report_error(flown.error());
    samples = *flown;
    if (interrupted()) {
      print_interrupted(*sweep, options);
      return exit_interrupted;
    }
  }
  if (sweep->shard.count > 1) {
    if (!globals.quiet) {
      fmt::print(
          "shard {}: {} samples in {}; `attest sweep {} --merge DIR... --out DIR` joins the "
          "shards\n",
          sweep->identity.shard, range_of(sweep->shard, sweep->samples()).size(), options.out,
          options.file);
    }
    return exit_ok;
  }
  const auto summary = report(*sweep, options, *suite, samples, globals.quiet, *std::move(html));
  if (!summary) return report_error(summary.error());
  return summary->passes() ? exit_ok : exit_failed;
}

void add_sweep_parts(Command command, SweepOptions& options) {
  command.option("--samples", options.samples, "Number of samples; default: that of the file")
      .positive()
      .type("N");
  const Option shard =
      command.option("--shard", options.shard, "Fly only part I of N of the samples")
          .type("I/N")
          .shows_default();
  command.option("--merge", options.merge, "Join the shards in these folders, and fly nothing")
      .type("DIR...")
      .excludes(shard);
  command
      .option("--keep-worst", options.keep_worst,
              "Keep this number of worst flights of each requirement, for `attest sim`")
      .range(0, 1000)
      .type("K")
      .shows_default()
      .group(option_group::reports);
}

void add_shard_plan(Command command, SweepOptions& options) {
  const Option plan =
      command
          .option("--plan", options.plan,
                  "Fly nothing, and write to --out the files with which many machines fly the "
                  "shards: `slurm`, `parallel` (GNU parallel), `github` or `gitlab`")
          .type("KIND")
          .group(option_group::execution);
  const Option shards = command.option("--shards", options.shards, "Number of shards of --plan")
                            .type("N")
                            .positive()
                            .needs(plan)
                            .group(option_group::execution);
  plan.needs(shards);
  for (const char* other : {"--shard", "--merge"}) plan.excludes(command.find(other));
}

}  // namespace

void add_sweep(const CommandLine& line) {
  auto options = std::make_shared<SweepOptions>();
  const Command command =
      line.add("sweep",
               "Fly a case many times with dispersed values, and estimate the probability "
               "that a flight holds each requirement");
  command
      .option(
          "file", options->file,
          "The sweep file, with case, dispersions, design and requirements; docs/sweeps.md has an "
          "example")
      .type("SWEEP.toml")
      .required();
  add_plant(command, options->vehicle, options->plant, "that of the file", "that of the file");
  add_port(command, options->host);
  command
      .option("--out", options->out,
              "Folder for the results; an interrupted sweep continues with the samples that "
              "are missing there")
      .type("DIR")
      .required()
      .group(option_group::reports);
  add_sweep_parts(command, *options);
  add_page(command, options->html,
           "a page with the requirements, distributions, sensitivities and worst flights");
  add_shard_plan(command, *options);
  add_timeout(command, options->host.timeout_s);
  const Option jobs =
      add_jobs(command, options->jobs,
               "Number of samples that fly at the same time, with --plan in each shard",
               "one for each CPU; with --plan, 1");
  command.examples(
      {{"attest sweep SWEEP.toml --out results --keep-worst 3 --html sweep.html",
        "fly the reference, keep the three worst flights of each requirement, and write a page"},
       {"attest sweep SWEEP.toml --port lib:./libmine.so --out results",
        "fly port and reference on the same samples, and test whether they differ"},
       {"attest sweep SWEEP.toml --shard 2/4 --out part2", "fly the second quarter of the samples"},
       {"attest sweep SWEEP.toml --merge part1 part2 part3 part4 --out results",
        "join the four shards"},
       {"attest sweep SWEEP.toml --plan slurm --shards 200 --out plan",
        "make a job array for a cluster; plan/submit submits it"}});
  command.runs([options, jobs, command] {
    if (!options->plan.empty() && !jobs.is_given()) options->jobs = 1;
    return sweep_command(*options, command.globals());
  });
}

}  // namespace attest::cli
