#include "harness/cli/own_suite.hpp"

#include <system_error>

#include "harness/casefile/parse.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/file.hpp"
#include "harness/core/suite_files.hpp"

namespace attest::cli {

namespace fs = std::filesystem;

Result<void> make_own_suite(const fs::path& root, const fs::path& case_folder) {
  std::error_code failed;
  const bool is_suite = is_suite_folder(root / "cases") || is_suite_file(root / base_file);
  fs::create_directories(case_folder, failed);
  if (failed) return fail_at(case_folder.string(), "cannot be made: " + failed.message());
  return is_suite ? Result<void>() : write_file(root / base_file, "released\n");
}

Result<void> write_new_case(const fs::path& file, std::string_view toml) {
  std::error_code failed;
  if (fs::exists(fs::symlink_status(file, failed))) {
    return fail_at(file.string(),
                   "exists, and is not overwritten; name another folder, or remove it with its "
                   "golden");
  }
  if (auto written = write_file(file, toml); !written) return written;
  const auto parsed = parse_case(file);
  if (parsed) return {};
  fs::remove(file, failed);
  return tl::unexpected(parsed.error());
}

}  // namespace attest::cli
