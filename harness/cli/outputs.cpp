#include "harness/cli/outputs.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <set>
#include <system_error>

#include <unistd.h>

#include "harness/port/port.hpp"

namespace attest::cli {
namespace {

namespace fs = std::filesystem;

// The path of a file, the same for each way to name it. The file need not exist.
fs::path identity(const fs::path& path) {
  if (path == "-") return identity("/dev/stdout");
  std::error_code failed;
  const fs::path absolute = fs::absolute(path, failed);
  const fs::path canonical = fs::weakly_canonical(absolute, failed);
  return failed ? absolute.lexically_normal() : canonical;
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

bool is_of_suite(const fs::path& path, const SuiteFolder& suite) {
  std::vector<fs::path> folders = suite.case_folders();
  folders.insert(folders.end(), {suite.golden(), suite.models()});
  return std::any_of(folders.begin(), folders.end(),
                     [&](const fs::path& folder) { return lies_in(path, identity(folder)); });
}

std::set<fs::path> identities_of(const Inputs& inputs) {
  std::set<fs::path> files;
  for (const std::string& file : files_of(inputs.port)) files.insert(identity(file));
  for (const std::string& file : inputs.files) {
    if (!file.empty()) files.insert(identity(file));
  }
  return files;
}

// `suite` is null if there is none.
Result<void> check_each(const std::vector<std::string>& outputs, const Inputs& inputs,
                        const SuiteFolder* suite) {
  const std::set<fs::path> read = identities_of(inputs);
  std::set<fs::path> written;
  for (const std::string& output : outputs) {
    if (output.empty()) continue;
    const fs::path file = identity(output);
    if (!written.insert(file).second) {
      return fail_at(output, "is asked for twice; each report needs a file of its own");
    }
    std::error_code ignored;
    if (read.contains(file)) {
      return fail_at(output, "is read by this command and would be overwritten; name another file");
    }
    if (suite != nullptr && is_of_suite(file, *suite) && fs::exists(file, ignored)) {
      return fail_at(output, "is a file of the suite and would be overwritten; name another file");
    }
  }
  return {};
}

}  // namespace

Result<void> check_outputs(const std::vector<std::string>& outputs, const Inputs& inputs,
                           const SuiteFolder& suite) {
  return check_each(outputs, inputs, &suite);
}

Result<void> check_outputs(const std::vector<std::string>& outputs, const Inputs& inputs,
                           const std::string& suite_folder) {
  const auto suite = find_suite(suite_folder);
  return check_each(outputs, inputs, suite ? &*suite : nullptr);
}

Result<void> check_output_folder(const std::string& folder, const SuiteFolder& suite) {
  if (!is_of_suite(identity(folder), suite)) return {};
  return fail_at(folder,
                 "is a folder of the suite, whose files would be overwritten; name another folder");
}

Result<void> prepare_trace_folder(const std::string& folder, const SuiteFolder& suite) {
  if (folder.empty()) return {};
  if (auto apart = check_output_folder(folder, suite); !apart) return apart;
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) return fail_at(folder, "cannot be made: " + failed.message());
  if (!fs::is_empty(folder, failed)) {
    return fail_at(folder,
                   "is not empty: traces of an earlier run could be mistaken for new ones; "
                   "name another folder, or remove it");
  }
  if (::access(folder.c_str(), W_OK) == 0) return {};
  return fail_at(folder, "cannot be written: " + std::generic_category().message(errno));
}

}  // namespace attest::cli
