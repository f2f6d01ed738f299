// The commands: for each its options with their defaults, and the function that does its work and
// returns the exit code.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/compare/log_agreement.hpp"
#include "harness/core/result.hpp"
#include "harness/host/port_process.hpp"
#include "harness/measure/vector_times.hpp"

namespace attest::cli {

enum Exit : int {
  exit_ok = 0,
  exit_failed = 1,        // a vector or check failed, or the user refused `bless`
  exit_usage = 2,         // wrong usage, no result, or the environment: files, ports, goldens
  exit_interrupted = 130  // Ctrl-C or SIGTERM; the number that shells give after Ctrl-C
};

// The options of all commands.
struct Globals {
  std::string suite;   // folder with cases/ and golden/; empty: find_suite() searches for it
  bool quiet = false;  // print only failures and errors
  // The barrier of all ports (HostOptions::barrier). The command line completes it.
  std::shared_ptr<BarrierOptions> barrier = std::make_shared<BarrierOptions>();
};

// Prints "attest: error: <file:line: message>" on stderr, and returns exit_usage. If the command
// was interrupted, prints that and returns exit_interrupted.
int report_error(const Error& error);

// Errors: those of LoopRate::parse().
Result<std::vector<LoopRate>> parse_rates(const std::vector<std::string>& texts);

// --filter, --exclude, --group, --profile, --rate, --vehicle, --plant, --shard and --rerun-failed,
// as text until they are used.
struct SelectionOptions {
  std::vector<std::string> filters, excludes, groups, profiles, rates, vehicles, plants;
  std::string shard = "1/1";
  std::string rerun_failed;  // a JSON report: only vectors that failed in it; empty: no report

  bool selects_all() const {
    return filters.empty() && excludes.empty() && groups.empty() && profiles.empty() &&
           rates.empty() && vehicles.empty() && plants.empty() && shard == "1/1" &&
           rerun_failed.empty();
  }

  // The given options as text, except --profile and --shard: "--group tpa --rate 250".
  std::string narrowing() const;

  // The selected cases below `folders`. Errors: those of select_cases; text that is not a rate or a
  // shard; a --rerun-failed that is no report, or in which no selected vector failed.
  Result<std::vector<SelectedCase>> cases_in(const CaseFolders& folders) const;
};

// Each of the functions below, NAME_command(), prints its results on stdout and its errors on
// stderr.

// The results of `run` and `merge` for people and for other programs.
struct ReportOptions {
  std::map<std::string, std::string> files;  // file by ReportFormat::option; empty: no such report
  bool diagnose = true;                      // name the probable mistake if a vector fails
  bool verbose = false;                      // the summary has every failing case
  bool github = false;                       // annotations and a job summary for GitHub Actions
};

struct RunOptions {
  SelectionOptions select;
  HostOptions host;
  int jobs = 1;
  bool fail_fast = false;
  std::vector<std::string> parameters;  // NAME=VALUE
  std::string level = "numeric";
  ReportOptions report;
  std::string expected_failures;
  std::string timing;       // file; empty: the times of the cases
  std::string save_traces;  // folder; empty: not saved
};
int run_command(const RunOptions& options, const Globals& globals);

struct MergeOptions {
  std::vector<std::string> files;  // JSON reports
  std::string port;                // for the diagnosis; empty: the port that the reports name
  int jobs = 1;
  double timeout_s = default_timeout_s;
  ReportOptions report;
};
int merge_command(const MergeOptions& options, const Globals& globals);

struct ReplayOptions {
  std::vector<std::string> files;
  HostOptions host;
  std::string profile;
  std::string level = "numeric";
  std::string mixer;
  std::vector<std::string> parameters;
  std::vector<std::string> assumed;  // assumption_words() for what a flight log lacks
  LogLimits log_limits;
  std::string html, json;  // files; empty: not wanted
};
int replay_command(const ReplayOptions& options, const Globals& globals);

struct CompareOptions {
  std::string got, want;
  std::string level = "numeric";
  bool by_time = false;     // compare any signals, at equal times
  double others = 0;        // the tolerance of signals for which the level has none
  std::string shift = "0";  // us, or "auto"
  std::string html;
};
int compare_command(const CompareOptions& options, const Globals& globals);

struct PlotOptions {
  std::vector<std::string> files;
  std::vector<std::string> signals;  // shell patterns; empty: the outputs, or all if there are none
  std::string html;  // empty: the name of the first file, with .html, in the working folder
  bool list = false;
};
int plot_command(const PlotOptions& options, const Globals& globals);

struct SimOptions {
  std::string case_name;  // with `rate`; empty with `timing`
  std::string rate;
  std::string vehicle, plant;  // empty: the lead vehicle and the first plant of the case
  std::string timing;
  HostOptions host;
  std::string out, html;  // files; at least one
};
int sim_command(const SimOptions& options, const Globals& globals);

struct StressOptions {
  HostOptions host;
  std::vector<std::string> rates = {"250", "500", "1000", "2000", "4000", "8000"};
  double duration_s = 10;
  std::string case_name = "flight/hover";
  std::string vehicle, plant;  // empty: the lead vehicle and the first plant of the case
  int load = 0;
  std::string load_kind = "cpu";
  std::string policy = "fifo";
  int cpus = 2;
  double spin_us = 0;
  // Empty: the budget of the case.
  std::optional<double> misses_per_million, p99_latency_us, execution_us;
  std::string html, json, junit, record_timing;
  bool cyclictest = true;
};
int stress_command(const StressOptions& options, const Globals& globals);

struct RateSweepOptions {
  std::string case_name = "flight/tilt_step_30";
  std::vector<std::string> rates = {"50", "100", "250", "500", "1000"};
  std::vector<std::string> vehicles, plants;  // empty: all of the case
  HostOptions host;
  int jobs = 1;
  std::string csv, html;
};
int sweep_rate_command(const RateSweepOptions& options, const Globals& globals);

struct SweepOptions {
  std::string file;
  std::string vehicle, plant;  // empty: those of the file
  HostOptions host;            // with the port `builtin` only the reference flies
  int jobs = 1;
  std::uint64_t samples = 0;  // 0: those of the file
  std::string shard = "1/1";
  std::string out;                 // folder
  std::string html;                // file; empty: not written
  int keep_worst = 0;              // number of flights, of each requirement
  std::vector<std::string> merge;  // folders of shards to join; empty: fly
  std::string plan;                // the program that flies the shards; empty: fly here
  std::size_t shards = 0;          // their number, for `plan`
};
int sweep_command(const SweepOptions& options, const Globals& globals);

struct ScheduleOptions {
  std::string tasks;  // file
  std::string case_name = "flight/tilt_step_30";
  std::string vehicle, plant;
  HostOptions host;
  std::string record_timing;
};
int schedule_command(const ScheduleOptions& options, const Globals& globals);

struct TimeCommandOptions {
  SelectionOptions select;
  HostOptions host;
  TimeOptions measure;
  int allowed = 0;  // number of steps that may be over the budget
  bool instructions = false;
  std::string html, json;
};
int time_command(const TimeCommandOptions& options, const Globals& globals);

struct FaultOptions {
  std::vector<std::string> ids;       // empty: all
  std::vector<std::string> profiles;  // empty: all
  bool list = false;
  bool diagnose = false;
  std::optional<int> fraction_bits;
  std::string level;  // of all cases; empty: numeric, and exact for cases of that level only
  int jobs = 1;
};
int faults_command(const FaultOptions& options, const Globals& globals);

struct ListOptions {
  SelectionOptions select;
  bool groups = false, parameters = false, channels = false, modes = false, vehicles = false;
};
int list_command(const ListOptions& options, const Globals& globals);

struct VectorOptions {
  SelectionOptions select;
  std::string folder;
  std::string format = "csv";
  std::string fixed_step;  // a rate [Hz]; empty: no fixed step
  bool lint = false;
  // If not empty: the command makes a case from this log. The times are from the first step in the
  // log.
  std::string from_log;
  double from_s = 0;
  std::optional<double> to_s;        // empty: to the end
  std::vector<std::string> assumed;  // assumption_words()
};
int vectors_command(const VectorOptions& options, const Globals& globals);
int vectors_from_log_command(const VectorOptions& options, const Globals& globals);
int lint_command(const VectorOptions& options, const Globals& globals);

struct BlessOptions {
  SelectionOptions select;
  HostOptions host;
  std::string port;  // its outputs become the goldens; empty: those of attest's reference
  std::string reason;
  bool yes = false;
};
int bless_command(const BlessOptions& options, const Globals& globals);

struct RecordOptions {
  HostOptions host;
  std::string case_name, rate, out = "-";
};
int record_command(const RecordOptions& options, const Globals& globals);

struct NewPortOptions {
  std::string folder, language;
};
int new_port_command(const NewPortOptions& options, const Globals& globals);

struct DoctorOptions {
  HostOptions host;
};
int doctor_command(const DoctorOptions& options, const Globals& globals);

struct SmokeOptions {
  HostOptions host;
};
int smoke_command(const SmokeOptions& options, const Globals& globals);

}  // namespace attest::cli
