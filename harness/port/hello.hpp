// The handshake with a port that is a program: one line of JSON each way (PROTOCOL.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/rate.hpp"
#include "harness/core/result.hpp"
#include "harness/port/cost.hpp"
#include "harness/port/lacks.hpp"
#include "harness/trace/module.hpp"

namespace attest {

inline constexpr int protocol_version = 1;

enum class FrameForm { binary, text, shared };

// The program's answer to the handshake.
struct Hello {
  std::string name, version;
  std::vector<std::string> profiles;
  FrameForm frames = FrameForm::binary;
  ModuleSet modules;  // with the controller if one of the profiles has it
  bool has_batch = false;
  bool byte_after_line = false;  // its reader returns a line when the byte after it has arrived
  std::vector<std::string> unsupported_groups;
  Lacks lacks;
  std::optional<int> fraction_bits;
  std::optional<Rate> fixed_step;
  std::vector<std::string> files;   // further files of the program, which the port's hash covers
  std::optional<CostCounter> cost;  // its answers have the cost of each step
};

// What is wrong with Hello::files: too many names, or a name that is empty, too long or no text;
// empty if nothing is wrong.
std::string wrong_in_files(const std::vector<std::string>& names);

// The line that attest writes first, with its line feed.
std::string greeting();

// Parses the answer. Errors: no JSON object; a member that is missing, unknown or has a value that
// is not allowed; another version of the protocol.
Result<Hello> parse_hello(std::string_view line);

}  // namespace attest
