// Runs when attest is installed: packs the suite in the folder ROOT into the archive ARCHIVE, which
// has the same bytes for the same files. (`cmake -E tar` would add the times and owners of files.)
#include <cstdlib>

#include <fmt/format.h>
#include <minizip/zip.h>

#include "harness/core/suite_files.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

// A run reads all cases and provenances, so that they are not compressed: they are 5% of the bytes.
int method_of(const std::string& name) { return name.ends_with(".toml") ? 0 : Z_DEFLATED; }

Result<void> add(zipFile archive, const std::string& name, const std::string& bytes) {
  zip_fileinfo info{};
  info.tmz_date.tm_mday = 1;
  info.tmz_date.tm_year = 1980;  // the earliest that the format has
  const bool added =
      zipOpenNewFileInZip(archive, name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr,
                          method_of(name), Z_DEFAULT_COMPRESSION) == ZIP_OK &&
      zipWriteInFileInZip(archive, bytes.data(), static_cast<unsigned>(bytes.size())) == ZIP_OK &&
      zipCloseFileInZip(archive) == ZIP_OK;
  if (added) return {};
  return fail_at(name, "cannot be added to the archive");
}

Result<void> add_folder(zipFile archive, const fs::path& root, const char* folder) {
  const auto files = suite_files_below(root / folder);
  if (!files) return tl::unexpected(files.error());
  for (const fs::path& file : *files) {
    const auto bytes = read_suite_file(file);
    if (!bytes) return tl::unexpected(bytes.error());
    auto added = add(archive, file.lexically_relative(root).generic_string(), *bytes);
    if (!added) return added;
  }
  return {};
}

Result<void> pack(const fs::path& root, const char* path) {
  const zipFile archive = zipOpen64(path, APPEND_STATUS_CREATE);
  if (archive == nullptr) return fail_at(path, "cannot be made");
  for (const char* folder : {"cases", "golden", "models"}) {
    if (auto added = add_folder(archive, root, folder); !added) return added;
  }
  if (zipClose(archive, nullptr) != ZIP_OK) return fail_at(path, "cannot be written");
  return {};
}

}  // namespace
}  // namespace attest

int main(int count, char** arguments) {
  if (count != 3) return EXIT_FAILURE;
  const auto packed = attest::pack(arguments[1], arguments[2]);
  if (packed) return EXIT_SUCCESS;
  fmt::print(stderr, "{}\n", packed.error().to_string());
  return EXIT_FAILURE;
}
