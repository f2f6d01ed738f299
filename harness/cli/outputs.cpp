#include "harness/cli/outputs.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "harness/cli/suite_folder.hpp"
#include "harness/core/file.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/port/port.hpp"

namespace attest::cli {
namespace {

namespace fs = std::filesystem;

// The path of a file, the same for each way to name it. The file need not exist.
fs::path identity(const fs::path& path) {
  if (path == "-") return identity("/dev/stdout");
  std::error_code failed;
  const fs::path absolute = fs::absolute(behind_links(path), failed);
  fs::path canonical = fs::weakly_canonical(absolute, failed);
  if (failed) canonical = absolute.lexically_normal();
  return canonical.has_filename() ? canonical : canonical.parent_path();  // "mine/"
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

bool is_suite(const fs::path& folder) {
  return is_suite_file(folder / base_file) ||
         (is_suite_folder(folder / "cases") && is_suite_folder(folder / "golden"));
}

// What a command may not write, with its name in messages.
struct Protected {
  fs::path path;
  const char* what;
};
constexpr const char* a_suite = "a suite";

// Other files in the folder of a suite are the user's own.
std::vector<Protected> parts_of(const fs::path& suite) {
  if (const fs::path archive = archive_of(suite); !archive.empty()) {
    return {{identity(archive), a_suite}};
  }
  std::vector<Protected> parts;
  for (const char* name : {"cases", "golden", "models", base_file}) {
    parts.push_back({identity(suite / name), a_suite});
  }
  return parts;
}

std::vector<Protected> own_data() {
  const auto data = data_folder();
  if (!data) return {};
  if (is_installation(*data)) return {{identity(*data), "the data of this attest"}};
  return parts_of(*data);
}

// `path`: an identity(). `given`: the suite of the command.
std::vector<Protected> protected_near(const fs::path& path, const std::string& given) {
  std::vector<Protected> all = own_data();
  const auto add = [&](const fs::path& suite) {
    const auto parts = parts_of(suite);
    all.insert(all.end(), parts.begin(), parts.end());
  };
  if (const auto suite = find_suite(given)) {
    add(suite->root);
    if (suite->base) add(*suite->base);
  }
  for (fs::path above = path; above.has_relative_path(); above = above.parent_path()) {
    if (is_suite(above)) add(above);
  }
  return all;
}

Result<void> check_apart(const std::string& name, const fs::path& path,
                         const std::vector<Protected>& all) {
  for (const Protected& one : all) {
    if (!lies_in(path, one.path)) continue;
    return fail_at(
        name, fmt::format("is in {}, which only `attest bless` changes; name another", one.what));
  }
  return {};
}

std::set<fs::path> identities_of(const Inputs& inputs) {
  std::set<fs::path> files;
  for (const std::string& file : files_of(inputs.port)) files.insert(identity(file));
  for (const std::string& file : inputs.files) {
    if (!file.empty()) files.insert(identity(file));
  }
  return files;
}

}  // namespace

Result<void> check_outputs(const std::vector<std::string>& outputs, const Inputs& inputs,
                           const std::string& suite) {
  const std::set<fs::path> read = identities_of(inputs);
  std::set<fs::path> written;
  for (const std::string& output : outputs) {
    if (output.empty()) continue;
    const fs::path file = identity(output);
    if (!written.insert(file).second) {
      return fail_at(output, "is asked for twice; each report needs a file of its own");
    }
    if (read.contains(file)) {
      return fail_at(output, "is read by this command and would be overwritten; name another file");
    }
    const auto apart = check_apart(output, file, protected_near(file, suite));
    if (!apart) return apart;
  }
  return {};
}

Result<void> check_output_folder(const std::string& folder, const std::string& suite) {
  const fs::path path = identity(folder);
  std::vector<Protected> all = protected_near(path, suite);
  if (is_suite(path)) all.push_back({path, a_suite});
  return check_apart(folder, path, all);
}

Result<void> check_own_suite(const std::string& suite) {
  if (auto changes = check_can_change(suite); !changes) return changes;
  return check_apart(suite, identity(fs::path(suite) / "cases"), own_data());
}

Result<void> prepare_trace_folder(const std::string& folder, const std::string& suite) {
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

std::string attitude_unit_file(const std::string& file) {
  if (file.empty() || file == "-") return {};
  std::filesystem::path path = file;
  const std::string extension = path.extension().string();
  return path.replace_extension(".attitude_unit" + extension).string();
}

}  // namespace attest::cli
