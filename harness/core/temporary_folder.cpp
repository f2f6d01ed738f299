#include "harness/core/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace attest {

namespace fs = std::filesystem;

Result<TemporaryFolder> TemporaryFolder::make(std::string_view purpose) {
  std::error_code failed;
  const fs::path parent = fs::temp_directory_path(failed);
  if (failed) return fail("the folder for temporary files (TMPDIR): " + failed.message());
  std::string name = (parent / fmt::format("attest-{}-XXXXXX", purpose)).string();
  if (::mkdtemp(name.data()) == nullptr) {
    return fail_at(parent.string(), "a temporary folder cannot be made here: " +
                                        std::generic_category().message(errno));
  }
  return TemporaryFolder(name);
}

TemporaryFolder::TemporaryFolder(TemporaryFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})) {}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

}  // namespace attest
