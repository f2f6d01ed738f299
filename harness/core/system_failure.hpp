// Errors of system calls on files. Each names the reason of the system, and what to do about it.
// REQUIRES, for all: a system call has just failed and set errno.
#pragma once

#include <filesystem>
#include <string_view>

#include "harness/core/result.hpp"

namespace attest {

// "a.csv: cannot write the file: No space left on device"
tl::unexpected<Error> system_failure(const std::filesystem::path& path, std::string_view what);

// Of a file to be read. If it does not exist: a file next to it with nearly the same name, the
// folder that does not exist either, or the folder in which a relative path begins.
tl::unexpected<Error> cannot_open(const std::filesystem::path& path);

// Of a file to be made. Names the folder if that does not exist.
tl::unexpected<Error> cannot_create(const std::filesystem::path& path);

}  // namespace attest
