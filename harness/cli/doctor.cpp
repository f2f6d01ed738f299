#include <cfenv>
#include <limits>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "controller/elementary/fixed_arguments.hpp"
#include "controller/mc_att_control/profile.hpp"
#include "harness/casefile/select.hpp"
#include "harness/cli/examination.hpp"
#include "harness/cli/run_plan.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/version.hpp"
#include "harness/golden/golden.hpp"
#include "harness/host/port_process.hpp"
#include "harness/process/child.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/recorded_check.hpp"

namespace attest::cli {
namespace {

struct DoctorOptions {
  HostOptions host;
  bool verbose = false;
};

void examine_arithmetic(Examination& examination) {
  // volatile: this machine must compute the product now, not the compiler.
  volatile float tiny = std::numeric_limits<float>::denorm_min();
  volatile float product = tiny * 1.0f;
  if (product != 0 && std::fegetround() == FE_TONEAREST) {
    return examination.good("arithmetic", "binary32, round to nearest, denormals kept");
  }
  examination.bad("arithmetic",
                  "denormals become 0, or numbers are not rounded to nearest, so no verdict is "
                  "valid. A library that attest loads has changed the floating-point mode: unset "
                  "LD_PRELOAD, and build attest without -ffast-math");
}

// Of this build, because a compiler may have made other code of them than that which was tested.
void examine_functions(Examination& examination) {
  std::vector<std::string_view> all, wrong;
  for (const elementary::FixedFunction& function : elementary::fixed_functions) {
    all.push_back(function.name);
    if (!elementary::is_correct(function)) wrong.push_back(function.name);
  }
  if (wrong.empty()) {
    return examination.good("functions",
                            fmt::format("{}: correctly rounded at {} fixed arguments each",
                                        fmt::join(all, ", "), elementary::fixed_pairs));
  }
  examination.bad(
      "functions",
      fmt::format("{}: not correctly rounded, so no verdict of this attest is valid. It "
                  "was compiled wrongly, or its file is damaged: install it anew, or "
                  "build it with another compiler and without -ffast-math",
                  fmt::join(wrong, ", ")));
}

void examine_cases(const SuiteFolder& suite, Examination& examination) {
  const auto cases = select_cases(suite.case_folders(), {});
  if (!cases) return examination.bad("cases", cases.error().to_string());
  std::size_t vectors = 0;
  std::size_t of_reference = 0;
  std::vector<std::string> stale;
  GoldenKeys keys_of_cases;
  const Goldens goldens(suite.golden());
  const bool may_lack_goldens = judged_by_reference(suite, goldens.reference());
  for (const auto& [the_case, configurations] : *cases) {
    vectors += configurations.size();
    keys_of_cases[the_case.profile].insert(key_of(the_case));
    if (may_lack_goldens && !goldens.has(the_case)) {
      ++of_reference;
      continue;
    }
    if (const auto golden = goldens.open(the_case); !golden) {
      stale.push_back(golden.error().to_string());
    }
  }
  examination.good("cases", fmt::format("{} cases, {} vectors, in {}", cases->size(), vectors,
                                        suite.cases().string()));
  for (const auto& [profile, keys] : keys_of_cases) {
    for (const std::string& key : goldens.without_case(profile, keys)) {
      stale.push_back(
          fmt::format("{} has no case; `attest bless` removes it", id_of(profile, key)));
    }
  }
  if (!stale.empty()) {
    return examination.bad("golden", fmt::format("{} missing, stale or without a case; first: {}",
                                                 stale.size(), stale[0]));
  }
  if (of_reference == 0) return examination.good("golden", "one for each case, all current");
  const std::string lack =
      fmt::format("the reference alone judges {} without a golden", counted(of_reference, "case"));
  examination.partly_good("golden", "all current; " + lack, lack);
}

// A group without a recording is not an error, but limits the weight of its verdicts.
void examine_coverage(const SuiteFolder& suite, bool verbose, Examination& examination) {
  const auto covered = covered_groups(suite.recorded());
  if (!covered) return examination.bad("recordings", covered.error().to_string());
  const std::vector<std::string> groups = suite.groups();
  std::vector<std::string> uncovered;
  for (const std::string& group : groups) {
    if (!covered->contains(group)) uncovered.push_back(group);
  }
  const std::string which = fmt::format(" ({})", fmt::join(uncovered, ", "));
  examination.good(
      "recordings",
      uncovered.empty()
          ? std::string("cover every group")
          : fmt::format("cover {} of {} groups of cases; the goldens of the others{} rely on the "
                        "description of the law",
                        groups.size() - uncovered.size(), groups.size(), verbose ? which : ""));
}

void examine_reference(const SuiteFolder& suite, Examination& examination) {
  const auto check = check_recorded(suite.recorded());
  if (!check) return examination.bad("reference", check.error().to_string());
  const std::string finding = fmt::format("agrees with {} of {} traces recorded from the firmware",
                                          check->conforming, check->traces);
  if (check->conforming == check->traces) return examination.good("reference", finding);
  examination.bad(
      "reference",
      fmt::format("{}, so no verdict of this attest is valid: install it anew, or build "
                  "it without -ffast-math and -ffp-contract=fast; first: {}",
                  finding, check->first_difference));
}

// The limits of a port's process.
void examine_limits(const DoctorOptions& options, Examination& examination) {
  const std::string memory = memory_is_limited() ? fmt::format("{} GiB of memory", max_memory_gib)
                                                 : "memory without limit (sanitizers)";
  examination.good("limits",
                   fmt::format("of a port's process: {:g} s per answer, {}, {} MiB per file; "
                               "all processes that it started end with it",
                               options.host.timeout_s, memory, max_file_mib));
  const auto missing = missing_parts(barrier_parts());
  if (missing.empty()) {
    return examination.good("barrier",
                            "a port cannot open the suite, nor signal or read attest's processes");
  }
  const std::string lack =
      fmt::format("this kernel has no barrier for {} (Landlock: files Linux 5.13, signals 6.12)",
                  fmt::join(missing, ", "));
  examination.partly_good("barrier", "a port cannot read attest's processes, but " + lack,
                          lack + ", so run only ports that you trust");
}

void examine_machine(const DoctorOptions& options, Examination& examination) {
  examination.begin("the machine");
  examination.good("attest", fmt::format("{}, built by {}", version, compiler()));
  examination.good("machine", fmt::format("{} processors", std::thread::hardware_concurrency()));
  examine_arithmetic(examination);
  examine_functions(examination);
  examine_limits(options, examination);
}

int doctor_command(const DoctorOptions& options, const Globals& globals) {
  Examination examination(globals, options.verbose);
  examine_machine(options, examination);
  examination.begin("the suite");
  if (const auto suite = find_suite(globals.suite)) {
    examine_cases(*suite, examination);
    examine_coverage(*suite, options.verbose, examination);
    examination.begin("the reference");
    examine_reference(*suite, examination);
  } else {
    examination.bad("suite", suite.error().to_string());
  }
  examine_port(options.host, examination);
  return examination.conclude();
}

}  // namespace

void add_doctor(const CommandLine& line) {
  auto options = std::make_shared<DoctorOptions>();
  const Command command = line.add(
      "doctor", "Check the machine, the suite, the reference and a port, and say what works here");
  add_port(command, options->host);
  add_port_argument(command, options->host);
  add_timeout(command, options->host.timeout_s);
  add_verbose(command, options->verbose);
  command.examples({{"attest doctor --port lib:./libmine.so",
                     "the machine, the suite, the reference and your port"}});
  command.runs(options, doctor_command);
}

}  // namespace attest::cli
