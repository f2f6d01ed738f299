#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/cli/command.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/shard_plan.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/cli/sweep_plan.hpp"
#include "harness/core/file.hpp"
#include "harness/report/progress.hpp"
#include "harness/report/sweep_summary_text.hpp"
#include "harness/sweep/keep_flights.hpp"
#include "harness/sweep/merge_shards.hpp"
#include "harness/sweep/summary_json.hpp"

namespace attest::cli {
namespace {

namespace fs = std::filesystem;

// Waits while another process of this machine makes the table. Empty: interrupted.
Result<std::optional<SampleTable>> open_table(const SweepPlan& plan, const fs::path& folder,
                                              const SampleRange& range) {
  bool is_first = true;
  while (!interrupted()) {
    auto table = SampleTable::open(folder / sample_file, plan.columns(), range);
    if (!table || *table) return table;
    if (std::exchange(is_first, false)) {
      fmt::print(stderr, "attest: note: waiting for another `attest sweep` that flies for {}\n",
                 folder.string());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return std::nullopt;
}

// Flies what is missing in the table.
Result<void> fly_missing(const SweepPlan& plan, const fs::path& folder, bool quiet) {
  const SampleRange range = range_of(plan.shard, plan.samples());
  auto opened = open_table(plan, folder, range);
  if (!opened) return tl::unexpected(opened.error());
  if (!*opened) return {};
  SampleTable* const table = &**opened;
  if (const auto flown = table->next() - range.begin; flown > 0 && flown < range.size() && !quiet) {
    fmt::print(stderr, "attest: note: continues after {} of {} samples\n", flown, range.size());
  }
  Progress progress(range.size(), Progress::on_stderr(quiet), table->next() - range.begin);
  const auto on_row = [&](const std::string& row) -> Result<void> {
    const std::string sample = fmt::format("sample {}", table->next());
    progress.add(row.find(fmt::format(",{}", outcome_diverged)) != std::string::npos, sample);
    return table->append(row);
  };
  if (auto flown = fly_samples(plan.sampler, {table->next(), range.end}, plan.flights, on_row);
      !flown) {
    return flown;
  }
  return interrupted() ? Result<void>() : table->finish();
}

std::vector<std::uint64_t> worst_samples_of(const SweepSummary& summary) {
  std::set<std::uint64_t> samples;
  for (const RequirementResult& one : summary.requirements) {
    samples.insert(one.worst.begin(), one.worst.end());
  }
  return {samples.begin(), samples.end()};
}

// From the complete table of a folder: report, kept flights, the text on stdout.
Result<SweepSummary> report(const SweepPlan& plan, const SweepOptions& options,
                            const SuiteFolder& suite, bool quiet) {
  const fs::path folder = options.out;
  const SampleColumns columns = plan.columns();
  const auto data = read_samples(folder / sample_file, columns, {0, plan.samples()});
  if (!data) return tl::unexpected(data.error());
  SweepSummary summary =
      summarise(plan.sampler.sweep(), columns, *data, static_cast<std::size_t>(options.keep_worst));
  const fs::path kept = folder / "worst";
  const std::vector<std::uint64_t> worst = worst_samples_of(summary);
  if (auto done = keep_flights(plan.sampler, worst, suite.models(), kept); !done) {
    return tl::unexpected(done.error());
  }
  const auto written =
      write_file(folder / "report.json", summary_json(plan.identity, columns, summary));
  if (!written) return tl::unexpected(written.error());
  if (!quiet) {
    fmt::print("{}", render_summary(plan.sampler, columns, summary, plan.identity.port,
                                    worst.empty() ? fs::path() : kept));
  }
  return summary;
}

void print_interrupted(const SweepPlan& plan, const SweepOptions& options) {
  fmt::print(stderr,
             "attest: note: interrupted; {} has the samples that were flown, and the same command "
             "flies the others of {}\n",
             options.out, range_of(plan.shard, plan.samples()).size());
}

Result<void> check_folders(const SweepOptions& options, const SuiteFolder& suite) {
  if (options.out.empty()) return fail("needs --out, the folder of the results");
  return check_output_folder(options.out, suite);
}

}  // namespace

int sweep_command(const SweepOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  if (auto checked = check_folders(options, *suite); !checked) return report_error(checked.error());
  const auto plan = plan_sweep(options, *suite);
  if (!plan) return report_error(plan.error());
  if (!options.plan.empty()) {
    const auto planned = plan_shards(*plan, options, globals);
    if (!planned) return report_error(planned.error());
    if (!globals.quiet) fmt::print("{}\n", *planned);
    return exit_ok;
  }
  if (!options.merge.empty()) {
    const auto merged = merge_shards({options.merge.begin(), options.merge.end()}, plan->identity,
                                     plan->columns(), plan->samples(), options.out);
    if (!merged) return report_error(merged.error());
  } else {
    if (auto claimed = claim_folder(options.out, plan->identity); !claimed) {
      return report_error(claimed.error());
    }
    note_interrupts();
    const auto flown = fly_missing(*plan, options.out, globals.quiet);
    if (!flown) return report_error(flown.error());
    if (interrupted()) {
      print_interrupted(*plan, options);
      return exit_interrupted;
    }
  }
  if (plan->shard.count > 1) {
    if (!globals.quiet) {
      fmt::print(
          "shard {}: {} samples in {}; `attest sweep {} --merge DIR... --out DIR` joins the "
          "shards\n",
          plan->identity.shard, range_of(plan->shard, plan->samples()).size(), options.out,
          options.file);
    }
    return exit_ok;
  }
  const auto summary = report(*plan, options, *suite, globals.quiet);
  if (!summary) return report_error(summary.error());
  return summary->passes() ? exit_ok : exit_failed;
}

}  // namespace attest::cli
