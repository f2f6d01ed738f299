#include "tests/controller/elementary/kept.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace attest::elementary {
namespace {

constexpr const char* folder = ATTEST_SOURCE_DIR "/tests/controller/elementary/";

std::ifstream opened(const char* name) {
  std::ifstream file(std::string(folder) + name);
  if (file) return file;
  fmt::print(stderr, "{}{}: cannot be read\n", folder, name);
  std::exit(2);
}

// std::from_chars does not read "0x".
float number_in(const std::string& text, std::size_t line) {
  char* end = nullptr;
  const float value = std::strtof(text.c_str(), &end);
  if (!text.empty() && *end == '\0') return value;
  fmt::print(stderr, "{}hard_cases.txt:{}: `{}` is not a number\n", folder, line, text);
  std::exit(2);
}

}  // namespace

std::vector<HardCase> hard_cases() {
  std::ifstream file = opened("hard_cases.txt");
  std::vector<HardCase> cases;
  std::string text;
  for (std::size_t line = 1; std::getline(file, text); ++line) {
    if (text.empty() || text.starts_with('#')) continue;
    std::istringstream words(text);
    std::string name, y, x;
    words >> name >> y;
    const Function* const f = function_named(name);
    if (f == nullptr) {
      fmt::print(stderr, "{}hard_cases.txt:{}: no function `{}`\n", folder, line, name);
      std::exit(2);
    }
    if (f->two_arguments) words >> x;
    cases.push_back({f, {number_in(y, line), f->two_arguments ? number_in(x, line) : 0}});
  }
  return cases;
}

std::string line_of(const HardCase& hard) {
  std::string line = fmt::format("{} {:a}", hard.f->name, hard.at.y);
  if (hard.f->two_arguments) line += fmt::format(" {:a}", hard.at.x);
  return line;
}

std::string row_of(const Function& f, std::string_view share, const Swept& swept) {
  return fmt::format("| {} | {} | {} | {} | {:016x} |", f.name, share, swept.arguments,
                     swept.differences, swept.hash);
}

std::string share_of(std::uint64_t every) {
  return every == 1 ? "all" : fmt::format("every {}th", every);
}

bool is_kept(std::string_view row) {
  std::stringstream text;
  text << opened("RESULTS.md").rdbuf();
  return text.str().find(row) != std::string::npos;
}

}  // namespace attest::elementary
