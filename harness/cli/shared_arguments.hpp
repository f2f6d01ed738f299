// Options that several commands have.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/cli/command.hpp"

namespace attest::cli {

// The headings of --help.
namespace option_group {
inline constexpr const char* selection = "Selection";
inline constexpr const char* strictness = "Strictness";
inline constexpr const char* reports = "Reports (for a file, `-` is stdout)";
inline constexpr const char* logs = "Logs of flights";
inline constexpr const char* execution = "Execution";
}  // namespace option_group

// Whether a word of the command line is a port, or the file of one. A case file is none, even if it
// is executable, as all files of some file systems are.
bool is_port(const std::string& given);

enum class Selects : std::uint8_t { all_vectors, open_loop };
// --filter and related. Without --vehicle and --plant, which select flights, for `open_loop`.
void add_selection(Command command, SelectionOptions& options,
                   Selects selects = Selects::all_vectors);
Option add_rates(Command command, std::vector<std::string>& rates, const char* what);
// The case, with --profile. `name` is that of the option or argument.
Option add_case(Command command, CaseChoice& choice, const char* name = "--case",
                const char* what = "The flight: the name or id of a case, or a case file");
void add_plant(Command command, std::string& vehicle, std::string& plant,
               const char* usual_vehicle = "the lead vehicle of the case",
               const char* usual_plant = "the first plant of the case");
// `callable` refuses a recorded port, which has outputs but no functions; only `run` can judge it.
enum class Ports { callable, any };
void add_port(Command command, HostOptions& host, Ports accepted = Ports::callable);
// The port as an argument without a name. REQUIRES: add_port() was called.
void add_port_argument(Command command, HostOptions& host);
// The name of a profile: "v1.5.5" and "v1.5" become "px4-v1.5.5", if no other profile begins so.
std::string full_profile_name(const std::string& given);
// The same for the profile at the beginning of an id or pattern: "v1.18/rates/*".
std::string full_case_name(const std::string& given);
// Errors: one of the names is not that of a profile.
Result<void> check_profiles(const std::vector<std::string>& names);

// --param NAME=VALUE, several times. `what` describes the option.
Option add_parameters(Command command, std::vector<std::string>& parameters, const char* what);
// --assume: assumptions that replace the topics that a flight log lacks.
void add_assumed(Command command, std::vector<std::string>& assumed);
void add_timeout(Command command, double& timeout_s);
// --html: the file of a page; `what` describes the page.
void add_page(Command command, std::string& file, const char* what);
// --json and --junit: files of reports.
void add_json_and_junit(Command command, std::string& json, const char* what, std::string& junit);
// `usual` describes the default, which is one per CPU.
Option add_jobs(Command command, int& jobs, const char* what,
                const char* usual = "one for each CPU");

// The reports of `run` and `merge`.
void add_reports(Command command, ReportOptions& options);

// Parses the texts of --param, and sorts them by name, as in a manifest. Errors: not NAME=VALUE; a
// parameter that no case can have.
Result<std::vector<ParameterChange>> parse_parameters(const std::vector<std::string>& texts,
                                                      const std::vector<SelectedCase>& cases);

}  // namespace attest::cli
