// Common to all fuzz targets. A target reads its input like a file that a user gives to attest, and
// requires more than that nothing crashes: see the head of each target.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "harness/core/result.hpp"

namespace attest::fuzz {

// The bytes that libFuzzer gives to LLVMFuzzerTestOneInput.
inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// Prints `what` and aborts if it does not hold. libFuzzer then saves the input.
void require(bool holds, std::string_view what);

// The folder for the files of this process, below TMPDIR. ci/fuzz removes it.
const std::filesystem::path& folder();

// Writes a file below folder(), with the folders that it needs.
std::filesystem::path write(const std::filesystem::path& relative, std::string_view text);

// An error names the file. Its message has lines for people: none is empty, and no character moves
// the cursor of a terminal or changes its colours.
void require_readable(const Error& error, const std::filesystem::path& file);
void require_readable(std::string_view message);

}  // namespace attest::fuzz
