// Options that several commands have.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "harness/cli/command.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace attest::cli {

// The work of the chosen command; it returns the exit code.
using Action = std::function<int()>;

// The headings of --help.
namespace option_group {
inline constexpr const char* selection = "Selection";
inline constexpr const char* strictness = "Strictness";
inline constexpr const char* reports = "Reports (for a file, `-` is stdout)";
inline constexpr const char* logs = "Logs of flights";
inline constexpr const char* execution = "Execution";
}  // namespace option_group

// A command line, and its purpose.
struct Example {
  const char* line;
  const char* what;
};
void add_examples(CLI::App& command, std::initializer_list<Example> examples);

// "FLOAT": the type of an option's value, without the checks that CLI11 appends.
std::string value_name(const CLI::Option& option);

// Makes --help show the negation of a flag as `--no-stack`; CLI11 shows `--no-stack{false}`. Must
// be called before the commands are added: they copy the formatter that exists then.
void use_plain_flag_names(CLI::App& app);

enum class Selects : std::uint8_t { all_vectors, open_loop };
// --filter and related. Without --vehicle and --plant, which select flights, for `open_loop`.
void add_selection(CLI::App& command, SelectionOptions& options,
                   Selects selects = Selects::all_vectors);
CLI::Option* add_rates(CLI::App& command, std::vector<std::string>& rates, const char* what);
void add_plant(CLI::App& command, std::string& vehicle, std::string& plant,
               const char* usual_vehicle = "the lead vehicle of the case",
               const char* usual_plant = "the first plant of the case");
// `callable` refuses a recorded port, which has outputs but no functions; only `run` can judge it.
enum class Ports { callable, any };
void add_port(CLI::App& command, const Globals& globals, HostOptions& host,
              Ports accepted = Ports::callable);
// --assume: assumptions that replace the topics that a flight log lacks.
void add_assumed(CLI::App& command, std::vector<std::string>& assumed);
void add_timeout(CLI::App& command, double& timeout_s);
// --html: the file of a page; `what` describes the page.
void add_page(CLI::App& command, std::string& file, const char* what);
// `usual` describes the default, which is one per CPU.
void add_jobs(CLI::App& command, int& jobs, const char* what,
              const char* usual = "one for each CPU");

}  // namespace attest::cli
