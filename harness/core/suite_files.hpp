// The files of a suite: what is in its folders `cases`, `golden` and `models`. All code that reads
// a suite calls these functions. For one thread.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "harness/core/result.hpp"

namespace attest {

// Errors: those of read_file(); those of Archive::read().
Result<std::string> read_suite_file(const std::filesystem::path& file);

// The files in the folder and in those below it, in the order of the bytes of their paths. Leaves
// out pipes, devices and links without a target. Errors: a folder cannot be read.
Result<std::vector<std::filesystem::path>> suite_files_below(const std::filesystem::path& folder);

// The folders in the folder, in the same order. Errors: it cannot be read.
Result<std::vector<std::filesystem::path>> suite_folders_in(const std::filesystem::path& folder);

// A pipe, a device and a link without a target are files, too: read_suite_file() says what is
// wrong.
bool is_suite_file(const std::filesystem::path& path);
bool is_suite_folder(const std::filesystem::path& path);

// For many files of the suite: while the result exists, its archive stays open. No process may be
// forked meanwhile. Null if it is a folder.
std::shared_ptr<const void> keep_suite_open(const std::filesystem::path& suite);

// The part of `path` that names an archive. Empty: the path leads to no archive.
std::filesystem::path archive_of(const std::filesystem::path& path);

// Copies the files below `folder` to the same places below `to`, which it makes. Errors: a file
// cannot be read or written.
Result<void> copy_suite_files(const std::filesystem::path& folder, const std::filesystem::path& to);

}  // namespace attest
