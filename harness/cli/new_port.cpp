#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/cli/new_folder.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/file.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/process/program.hpp"

namespace attest::cli {
namespace {

struct NewPortOptions {
  std::string folder, language;
};

namespace fs = std::filesystem;

struct Language {
  std::string_view name;   // also the folder of its starter
  std::string_view title;  // for "a port in TITLE"
  const char* toolchain;   // the program that its `check` needs
  bool has_headers;        // it includes the ABI headers
  std::string_view group;  // of cases, for an example of `check`
  bool has_c = false;      // it has the C starters in folders of their own, to choose from
};

// Their sources, and what a program on a board consists of.
constexpr std::array starters_for_board{"c", "c_cascade", "c_law", "c_program", "cortex_m"};

constexpr std::array languages{
    Language{"c", "C, of PX4 v1.5.5 and v1.3.4", "cc", true, "attitude"},
    Language{"c_cascade", "C, with both units of PX4 v1.14 to v1.18", "cc", true, "attitude"},
    Language{"c_law", "C, with the attitude law and the rate law alone", "cc", true, "rate_law"},
    Language{"cortex_m", "C for a Cortex-M or RISC-V, run in an emulator", "arm-none-eabi-gcc",
             true, "attitude", true},
    Language{"cpp", "C++, of PX4 v1.5.5 and v1.3.4", "c++", true, "attitude"},
    Language{"octave", "Octave, with the attitude law and the rate law alone", "octave-cli", false,
             "rate_law"},
    Language{"python", "Python, of PX4 v1.5.5 and v1.3.4", "python3", false, "attitude"},
    Language{"python_cascade", "Python, with both units of PX4 v1.14 to v1.18", "python3", false,
             "attitude"},
    Language{"python_law", "Python, with the attitude law and the rate law alone", "python3", false,
             "rate_law"},
    Language{"rust", "Rust, of PX4 v1.5.5 and v1.3.4", "cargo", false, "attitude"},
    Language{"serial_board", "C for a board on a serial line", "python3", true, "attitude", true},
    Language{"simulink", "C generated from a Simulink model", "cc", true, "attitude"},
};

Result<Language> language_named(const std::string& name) {
  std::vector<std::string> names;
  for (const Language& language : languages) {
    if (language.name == name) return language;
    names.emplace_back(language.name);
  }
  return fail(fmt::format("no starter in `{}`{}; there are {}", name, suggestion(name, names),
                          fmt::join(names, ", ")));
}

// The folders from which a new port is copied: in the source tree, or in an installation.
struct Parts {
  fs::path starters, headers, ci;
};

Result<Parts> find_parts() {
  const auto data = data_folder();
  if (!data) return fail("the data of this attest is missing: share/attest of its installation");
  const bool is_installed = is_installation(*data);
  return Parts{*data / (is_installed ? "starters" : "controller/starters"),
               *data / (is_installed ? "include" : "controller"),
               *data / (is_installed ? "ci" : "ci/examples")};
}

// What a build, a run or the CI job leaves in the folder of a port.
constexpr std::string_view ignored_by_git =
    "build/\ntarget/\n__pycache__/\n*.so\n*.o\n*.elf\n/board\n/reports/\n";

// Files and folders that a build leaves in a starter's folder.
bool is_build_result(const fs::path& path) {
  const std::string name = path.filename().string();
  return name == "build" || name == "target" || name == "__pycache__" || path.extension() == ".so";
}

// Throws fs::filesystem_error.
void copy_starter(const fs::path& from, const fs::path& to) {
  fs::create_directories(to);
  for (const auto& entry : fs::directory_iterator(from)) {
    if (is_build_result(entry.path())) continue;
    fs::copy(entry.path(), to / entry.path().filename(), fs::copy_options::recursive);
  }
}

// The sources in C of another starter. Throws fs::filesystem_error.
void copy_sources(const fs::path& from, const fs::path& to) {
  fs::create_directories(to);
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path extension = entry.path().extension();
    if (extension == ".c" || extension == ".h" || extension == ".ld") {
      fs::copy_file(entry.path(), to / entry.path().filename());
    }
  }
}

// Throws fs::filesystem_error.
void lay_out(const Parts& parts, const Language& language, const fs::path& folder) {
  copy_starter(parts.starters / language.name, folder);
  if (language.has_c) {
    for (const std::string_view starter : starters_for_board) {
      if (starter == language.name) continue;
      copy_sources(parts.starters / starter, folder / starter);
    }
  }
  if (language.has_headers) {
    fs::create_directories(folder / "include");
    for (const char* header : {"attest_unit.h", "attest_actuation.h", "attest_cascade.h",
                               "attest_law.h", "attest_math.h"}) {
      fs::copy_file(parts.headers / header, folder / "include" / header);
    }
  }
  const fs::path github = folder / ".github";
  fs::create_directories(github / "workflows");
  fs::create_directories(github / "actions" / "attest");
  fs::copy_file(parts.ci / "github-actions.yml", github / "workflows" / "attest.yml");
  fs::copy_file(parts.ci / "github-action.yml", github / "actions" / "attest" / "action.yml");
  fs::copy_file(parts.ci / "gitlab-ci.yml", folder / ".gitlab-ci.yml");
  fs::copy_file(parts.ci / "install-attest", folder / "install-attest");
}

// For who does not name one.
std::string languages_text() {
  std::string text = "name a new folder and the port to start from: attest new-port mine --lang c";
  for (const Language& language : languages) {
    text += fmt::format("\n  {:<15} {}", language.name, language.title);
  }
  return text;
}

Result<Language> make_port(const NewPortOptions& options, const std::string& suite) {
  if (options.folder.empty() || options.language.empty()) return fail(languages_text());
  if (auto apart = check_output_folder(options.folder, suite); !apart) {
    return tl::unexpected(apart.error());
  }
  auto language = language_named(options.language);
  if (!language) return language;
  const auto parts = find_parts();
  if (!parts) return tl::unexpected(parts.error());
  const auto made = make_new_folder(options.folder, [&](const fs::path& folder) -> Result<void> {
    lay_out(*parts, *language, folder);
    return write_file(folder / ".gitignore", ignored_by_git);
  });
  if (!made) return tl::unexpected(made.error());
  return language;
}

int new_port_command(const NewPortOptions& options, const Globals& globals) {
  const auto language = make_port(options, globals.suite);
  if (!language) return report_error(language.error());
  if (!find_program(language->toolchain)) {
    fmt::print(stderr, "attest: note: {} is not installed; {}/packages.txt names its package\n",
               language->toolchain, options.folder);
  }
  if (globals.quiet) return exit_ok;
  fmt::print(
      "{0} has a complete port in {1}. Replace its law by yours; README.md says where.\n"
      "  {0}/check                   builds it and runs the whole suite\n"
      "  {0}/check --group {2}  builds it and runs one group: all options of `attest run`\n"
      "  .github/ and .gitlab-ci.yml there run check in CI; add the package from which you "
      "installed attest ({0}/install-attest says how)\n",
      options.folder, language->title, language->group);
  return exit_ok;
}

}  // namespace

void add_new_port(const CommandLine& line) {
  auto options = std::make_shared<NewPortOptions>();
  const Command command =
      line.add("new-port", "Make a folder with a complete port to start from, and with CI jobs");
  command.option("folder", options->folder, "The new folder").type("DIR");
  command
      .option("--lang", options->language,
              "Port to start from: `c`, `cpp`, `python`, `rust` or `simulink` for v1.5.5 and "
              "v1.3.4; `c_cascade` or `python_cascade` for v1.14 to v1.18; `c_law`, "
              "`python_law` or `octave` for the two laws of v1.14 to v1.17 alone, and the rate law "
              "of v1.18; `cortex_m` or "
              "`serial_board` for those in C on an emulated or a real board")
      .type("LANG");
  command.examples(
      {{"attest new-port mine --lang c", "a port in C; mine/check builds and runs it"},
       {"attest new-port mine --lang c_cascade", "a port in C of v1.14 to v1.18"},
       {"attest new-port mine --lang c_law", "the two laws alone: two functions in C"},
       {"attest new-port mine --lang simulink", "a wrapper for C code that Simulink generated"}});
  command.runs(options, new_port_command);
}

}  // namespace attest::cli
