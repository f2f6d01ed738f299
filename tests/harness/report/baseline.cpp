#include "tests/harness/report/baseline.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

namespace attest {
namespace {

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string_view line_at(std::string_view text, std::size_t position) {
  const std::size_t before = text.substr(0, position).rfind('\n');
  const std::size_t begin = before == text.npos ? 0 : before + 1;
  return text.substr(begin, text.find('\n', begin) - begin);
}

std::string first_difference(std::string_view want, std::string_view got) {
  const auto [w, g] = std::mismatch(want.begin(), want.end(), got.begin(), got.end());
  const auto at = static_cast<std::size_t>(w - want.begin());
  const auto line = 1 + std::count(want.begin(), w, '\n');
  return fmt::format("line {}\n  baseline: {}\n  now:      {}", line, line_at(want, at),
                     line_at(got, at));
}

}  // namespace

std::string baseline_complaint(const std::filesystem::path& folder, const std::string& name,
                               const std::string& text, bool accept) {
  const std::filesystem::path path = folder / name;
  const std::string want = read(path);
  if (std::filesystem::exists(path) && want == text) return {};
  const std::string difference = first_difference(want, text);
  if (!accept) {
    return fmt::format(
        "{} is not what the report says now: {}\nset ATTEST_ACCEPT_BASELINES=1 to "
        "write {}.new next to it",
        path.string(), difference, name);
  }
  std::ofstream(path.string() + ".new", std::ios::binary) << text;
  return fmt::format(
      "{} is not what the report says now: {}\nread the change and take it over:\n"
      "  diff -u {} {}.new\n  mv {}.new {}",
      path.string(), difference, path.string(), path.string(), path.string(), path.string());
}

testing::AssertionResult is_baseline(const std::string& name, const std::string& text) {
  const std::filesystem::path folder =
      std::filesystem::path(ATTEST_SOURCE_DIR) / "tests" / "baselines";
  const char* accept = std::getenv("ATTEST_ACCEPT_BASELINES");
  const bool accepts = accept != nullptr && std::string_view(accept) == "1";
  const std::string complaint = baseline_complaint(folder, name, text, accepts);
  return complaint.empty() ? testing::AssertionSuccess() : testing::AssertionFailure() << complaint;
}

}  // namespace attest
