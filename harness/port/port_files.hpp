// The files that a port consists of, and the hash of their bytes.
//
// The hash in a report must be that of the code that was judged, but a port is loaded many times in
// a run, and a build may replace it meanwhile. Therefore the files are hashed once, compared before
// each load, and compared again at the end of the run. If attest loaded a single descriptor
// (/proc/self/fd/N, or a sealed copy in memory) instead, a replaced file would not matter. But then
// a library would not find the files next to it ($ORIGIN, dladdr), and a program starts through its
// path anyway. A file that is replaced and put back between two loads was never judged, so it is no
// error. An attacker who replaces a file between a comparison and the load that follows is not
// noticed (docs/verdicts.md).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/stat.h>

#include "harness/core/result.hpp"

namespace attest {

class PortFiles {
 public:
  // Of the port (files_of()) and of the files that it names itself (Hello::files), without those of
  // them that the port has anyway. Errors: a file cannot be read, is not a regular file, or is
  // larger than 1 GiB.
  static Result<PortFiles> read(const std::string& specification,
                                const std::vector<std::string>& named = {});

  // SHA-256 of the file; of several files, that of the list of their hashes. Empty: the port has no
  // file.
  std::string sha256() const;

  // Errors: a file has other bytes than when it was read. `untouched`: whether files are skipped
  // whose inode, size and times are still the same.
  enum class Untouched { skipped, hashed };
  Result<void> check(Untouched untouched) const;

 private:
  struct File {
    std::filesystem::path path;
    std::string sha256;
    struct stat status {};  // before it was hashed
  };
  static Result<File> read_file(const std::filesystem::path& path);

  std::vector<File> files_;
};

}  // namespace attest
