#include "harness/golden/shared_golden.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace attest {
namespace {

constexpr std::string_view profiles_column = "profiles";

struct SharedTrace {
  std::vector<std::string_view> profiles;
  std::string_view rows;  // without the column `profiles`
};

// Removes the first line from `text`, and returns it with its line end.
std::string_view next_line(std::string_view& text) {
  const std::string_view line = text.substr(0, std::min(text.find('\n'), text.size() - 1) + 1);
  text.remove_prefix(line.size());
  return line;
}

struct Row {
  std::string_view profiles, rest;
};

// A line without a comma, which only an edit can make, is a part of the trace above it.
Row cut(std::string_view line) {
  const std::size_t comma = line.find(',');
  if (comma == std::string_view::npos) return {"", line};
  return {line.substr(0, comma), line.substr(comma + 1)};
}

bool names(std::string_view profiles, std::string_view profile) {
  const auto in_spaces = [](std::string_view text) { return fmt::format(" {} ", text); };
  return in_spaces(profiles).find(in_spaces(profile)) != std::string::npos;
}

// Cuts the rows of a golden into traces. `golden` begins after the header.
std::vector<std::string_view> traces_of(std::string_view golden) {
  std::vector<std::string_view> traces;
  while (!golden.empty()) {
    const char* const begin = golden.data();
    next_line(golden);
    while (golden.starts_with(',')) next_line(golden);
    traces.emplace_back(begin, static_cast<std::size_t>(golden.data() - begin));
  }
  return traces;
}

// Traces that are already there are looked for after the previous trace of the golden only, so that
// the golden keeps its order.
void add_profile(std::string_view profile, std::string_view golden,
                 std::vector<SharedTrace>& traces) {
  auto at = traces.begin();
  for (const std::string_view rows : traces_of(golden)) {
    const auto same =
        std::find_if(at, traces.end(), [&](const SharedTrace& one) { return one.rows == rows; });
    at = same == traces.end() ? traces.insert(at, {{}, rows}) : same;
    at->profiles.push_back(profile);
    ++at;
  }
}

}  // namespace

std::string golden_of_profile(std::string_view file, std::string_view profile) {
  const Row header = cut(next_line(file));
  if (header.profiles != profiles_column) return {};
  std::string golden(header.rest);
  bool is_of_profile = false;
  while (!file.empty()) {
    const Row row = cut(next_line(file));
    if (!row.profiles.empty()) is_of_profile = names(row.profiles, profile);
    if (is_of_profile) golden += row.rest;
  }
  return golden;
}

GoldensByProfile goldens_in(std::string_view file) {
  GoldensByProfile goldens;
  std::string_view rows = file;
  next_line(rows);
  while (!rows.empty()) {
    std::istringstream profiles{std::string(cut(next_line(rows)).profiles)};
    for (std::string name; profiles >> name;) goldens.try_emplace(name);
  }
  for (auto& [profile, golden] : goldens) golden = golden_of_profile(file, profile);
  return goldens;
}

bool have_same_columns(std::string_view golden, std::string_view other) {
  return next_line(golden) == next_line(other);
}

std::string joined(const GoldensByProfile& goldens) {
  std::vector<SharedTrace> traces;
  std::string text;
  for (const auto& [profile, golden] : goldens) {
    std::string_view rows = golden;
    const std::string_view header = next_line(rows);
    if (text.empty()) text = fmt::format("{},{}", profiles_column, header);
    add_profile(profile, rows, traces);
  }
  for (SharedTrace& trace : traces) {
    text += fmt::format("{},{}", fmt::join(trace.profiles, " "), next_line(trace.rows));
    while (!trace.rows.empty()) text.append(",").append(next_line(trace.rows));
  }
  return text;
}

bool can_share(std::string_view profile) {
  return profile.find_first_of(" ,\"\t\r\n\v\f") == std::string_view::npos;
}

}  // namespace attest
