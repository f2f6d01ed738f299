// Reads the specification of a port on a command line: its kind and its files. Opens the port.
#include <algorithm>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "harness/port/builtin.hpp"
#include "harness/port/fault_port.hpp"
#include "harness/port/port.hpp"
#include "harness/port/port_files.hpp"
#include "harness/port/program_port.hpp"
#include "harness/port/shared_library.hpp"
#include "harness/process/program.hpp"

namespace attest {
namespace {

// The text after the prefix; empty if the specification has another prefix.
std::optional<std::string> after(std::string_view prefix, const std::string& specification) {
  if (!specification.starts_with(prefix)) return std::nullopt;
  return specification.substr(prefix.size());
}

std::vector<std::string> files_of_program(const std::string& command) {
  const auto words = words_of(command);
  if (!words) return {};
  std::vector<std::string> files;
  if (auto program = find_program(words->front())) files.push_back(*std::move(program));
  for (std::size_t i = 1; i < words->size(); ++i) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file((*words)[i], ignored)) files.push_back((*words)[i]);
  }
  return files;
}

std::vector<std::string> files_below(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, ignored)) {
    if (entry.is_regular_file(ignored)) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::optional<std::string> recorded_folder(const std::string& specification) {
  return after("recorded:", specification);
}

std::vector<std::string> files_of(const std::string& specification) {
  if (auto library = after("lib:", specification)) return {*std::move(library)};
  if (const auto command = after("proc:", specification)) return files_of_program(*command);
  if (const auto folder = recorded_folder(specification)) return files_below(*folder);
  return {};
}

bool is_program(const std::string& specification) { return specification.starts_with("proc:"); }

Result<std::unique_ptr<Port>> open_port(const std::string& specification, const PortFiles* files) {
  if (files != nullptr) {
    if (auto same = files->check(PortFiles::Untouched::skipped); !same) {
      return tl::unexpected(same.error());
    }
  }
  if (specification == "builtin") return open_builtin();
  if (const auto fault = after("fault:", specification)) return open_fault(*fault);
  if (const auto library = after("lib:", specification)) return open_shared_library(*library);
  if (const auto command = after("proc:", specification)) return open_program(*command);
  std::error_code unreadable;
  if (std::filesystem::is_regular_file(specification, unreadable)) {
    return fail(
        fmt::format("unknown port `{0}`: a file; a shared library is `lib:{0}`, a program "
                    "`proc:{0}`",
                    specification));
  }
  return fail(fmt::format("unknown port `{}`; use one of {}", specification, callable_port_kinds));
}

}  // namespace attest
