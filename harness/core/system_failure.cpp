#include "harness/core/system_failure.hpp"

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/core/suggestion.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

// Names the limit that caused the error, because the system's message does not.
std::string_view limit_of(int error) {
  if (error == EFBIG) return " (`ulimit -f` limits the size of files)";
  if (error == EMFILE) return " (`ulimit -n` limits how many are open)";
  return "";
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// Of at most so many files, because a folder may have millions.
std::vector<std::string> names_in(const fs::path& folder) {
  constexpr std::size_t most = 1000;
  std::vector<std::string> names;
  std::error_code failed;
  fs::directory_iterator entry(folder, failed);
  for (const fs::directory_iterator end; !failed && entry != end && names.size() < most;
       entry.increment(failed)) {
    names.push_back(entry->path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

std::string hint_for_missing(const fs::path& path) {
  std::error_code failed;
  const fs::path folder = folder_of(path);
  if (!fs::is_directory(folder, failed)) {
    const std::string first = path.begin()->string();
    const bool is_of_suite = first == "golden" || first == "cases";
    return fmt::format("; there is no folder {}{}", folder.string(),
                       is_of_suite ? "; an installation has its suite packed: `attest list "
                                     "--extract DIR` makes DIR/" +
                                         path.string()
                                   : "");
  }
  const std::string meant = suggestion(path.filename().string(), names_in(folder));
  if (!meant.empty() || path.is_absolute()) return meant;
  return fmt::format("; the path begins in {}", fs::current_path(failed).string());
}

tl::unexpected<Error> with_hint(tl::unexpected<Error> failure, const std::string& hint) {
  failure.value().message += hint;
  return failure;
}

}  // namespace

tl::unexpected<Error> system_failure(const fs::path& path, std::string_view what) {
  const int error = errno;
  const std::string reason = std::generic_category().message(error);
  return fail_at(path.string(), fmt::format("{}: {}{}", what, reason, limit_of(error)));
}

tl::unexpected<Error> cannot_open(const fs::path& path) {
  const bool is_missing = errno == ENOENT;
  auto failure = system_failure(path, "cannot open the file");
  return is_missing ? with_hint(std::move(failure), hint_for_missing(path)) : failure;
}

tl::unexpected<Error> cannot_create(const fs::path& path) {
  const bool is_missing = errno == ENOENT;
  auto failure = system_failure(path, "cannot create the file");
  const fs::path folder = folder_of(path);
  std::error_code failed;
  if (!is_missing || fs::is_directory(folder, failed)) return failure;
  return with_hint(std::move(failure), fmt::format("; make the folder {} first", folder.string()));
}

}  // namespace attest
