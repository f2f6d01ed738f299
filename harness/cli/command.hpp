// Declares the commands and their options. A command but `help` does not include CLI11, which takes
// longer to compile than all commands together: it uses the handles here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/cli/globals.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace attest::cli {

// The work of the chosen command; it returns the exit code.
using Action = std::function<int()>;

// An option that a command has. Copies are the same option.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option type(const char* name) const;   // of its value, for --help: "HZ"
  Option group(const char* name) const;  // its heading in --help
  Option description(const char* text) const;
  Option shows_default() const;                  // --help shows the value that it has now
  Option shows_default(const char* text) const;  // --help shows this text
  Option required() const;
  Option one_each_time() const;  // of a list: a value each time that it is given
  Option separated_by_commas() const;

  // An error if the value is another one, with a text that names the values that are right.
  Option range(double least, double most) const;
  Option range(int least, int most) const;
  Option at_least_zero() const;
  Option positive() const;
  Option whole() const;  // of a std::uint64_t: not negative
  Option one_of(const std::vector<std::string>& values) const;
  // `wrong` returns what is wrong with a value; empty: nothing.
  Option check(const std::function<std::string(const std::string&)>& wrong) const;

  // What was given becomes this, before it is checked.
  Option rewritten(const std::function<std::string(const std::string&)>& rewrite) const;

  Option needs(Option other) const;
  Option excludes(Option other) const;

  bool is_given() const;  // after parsing

 private:
  CLI::Option* option_;
};

// A command that is being declared. Copies are the same command.
class Command {
 public:
  Command(CLI::App& app, const Globals& globals, Action& action)
      : app_(&app), globals_(&globals), action_(&action) {}

  const Globals& globals() const { return *globals_; }

  // `value` outlives the command line. A name without hyphens is that of an argument. T:
  // std::string, double, a list of one of these, std::filesystem::path, int, std::uint64_t, an
  // optional int or double.
  template <typename T>
  Option option(const char* name, T& value, const std::string& what) const;
  // A name such as "--stack,!--no-stack" has its negation.
  Option flag(const char* name, bool& value, const std::string& what) const;
  // REQUIRES: the command has it.
  Option find(const char* name) const;

  // A command line, and its purpose.
  struct Example {
    const char* line;
    const char* what;
  };
  void examples(std::initializer_list<Example> examples) const;

  // What the command does. `options` has been read then.
  template <typename Options>
  void runs(std::shared_ptr<Options> options, int (*work)(const Options&, const Globals&)) const {
    runs([options, work, globals = globals_] { return work(*options, *globals); });
  }
  void runs(Action work) const;

 private:
  CLI::App* app_;
  const Globals* globals_;
  Action* action_;
};

struct CommandLine {
  CLI::App& app;
  const Globals& globals;
  Action& action;  // of the command that was chosen

  Command add(const char* name, const char* what) const;
};

// Each declares a command, in the file that has its options and its work.
void add_run(const CommandLine& line);
void add_hunt(const CommandLine& line);
void add_merge(const CommandLine& line);
void add_sim(const CommandLine& line);
void add_stress(const CommandLine& line);
void add_sweep(const CommandLine& line);
void add_sweep_rate(const CommandLine& line);
void add_schedule(const CommandLine& line);
void add_time(const CommandLine& line);
void add_replay(const CommandLine& line);
void add_record(const CommandLine& line);
void add_compare(const CommandLine& line);
void add_plot(const CommandLine& line);
void add_faults(const CommandLine& line);
void add_list(const CommandLine& line);
void add_vectors(const CommandLine& line);
void add_bless(const CommandLine& line);
void add_new_port(const CommandLine& line);
void add_doctor(const CommandLine& line);
void add_smoke(const CommandLine& line);

}  // namespace attest::cli
