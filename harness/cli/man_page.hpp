// The manual pages, made of the same declarations as --help.
#pragma once

#include <filesystem>
#include <string>

#include "harness/core/result.hpp"

namespace CLI {
class App;
}  // namespace CLI

namespace attest::cli {

// The page of the program and that of one of its commands, for man (roff, macros of man(7)).
std::string man_page(const CLI::App& app);
std::string man_page_of(const CLI::App& command);

// Writes attest.1, attest-run.1, ... into a folder, which is made if it does not exist. Errors: it
// cannot be written.
Result<void> write_man_pages(const CLI::App& app, const std::filesystem::path& folder);

}  // namespace attest::cli
