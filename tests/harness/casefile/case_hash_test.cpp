// The hash of a case covers what the file says, and not how the file says it.
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

// A number, a flag or a text in a case file, or the first element of an array.
struct Value {
  fs::path file;
  std::string table, key, text;
  std::size_t begin;  // its place in the file
};

std::vector<Value> values_in(const fs::path& file) {
  static const std::regex value(R"re(("[^"]+"|[a-z_]+) = \[?("[^"]+"|[-+.\w]+))re");
  std::istringstream lines(*read_file(file));
  std::vector<Value> values;
  std::size_t begin = 0;
  for (std::string line, table; std::getline(lines, line); begin += line.size() + 1) {
    if (line.starts_with('[')) table = line;
    for (std::sregex_iterator it(line.begin(), line.end(), value), end; it != end; ++it) {
      values.push_back(
          {file, table, it->str(1), it->str(2), begin + static_cast<std::size_t>(it->position(2))});
    }
  }
  return values;
}

// Values that may be valid in the place of this one.
std::set<std::string> others_than(const Value& value, const std::set<std::string>& of_same_key) {
  std::set<std::string> others = of_same_key;
  others.insert({"true", "false", "\"another\"", "\"uniform\"", "\"ode\"", "\"hexa\""});
  if (!value.text.starts_with('"') && value.text != "true" && value.text != "false") {
    const double number = std::stod(value.text);
    for (const double other : {number + 1, number - 1, number + 0.01, number / 2, -number}) {
      if (other != number) others.insert(fmt::format("{}", other));
    }
  }
  others.erase(value.text);
  return others;
}

// The hash of the file with another value in this place; empty if that is no valid case.
std::optional<std::string> hash_with(const Value& value, const std::string& other) {
  std::string text = *read_file(value.file);
  text.replace(value.begin, value.text.size(), other);
  const auto parsed = parse_case_text(text, value.file);
  return parsed ? std::optional(parsed->sha256) : std::nullopt;
}

// Gives this value the first other one that is valid. Returns whether there is one.
bool check_hash_with_another(const Value& value, const std::set<std::string>& of_same_key) {
  const std::set<std::string> no_meaning{"why", "rates_why", "vehicles_why", "plants_why"};
  for (const std::string& other : others_than(value, of_same_key)) {
    const auto hash = hash_with(value, other);
    if (!hash) continue;
    EXPECT_EQ(*hash == *hash_with(value, value.text), no_meaning.contains(value.key))
        << value.file << ": " << value.key << " = " << other;
    return true;
  }
  return false;
}

// Each key of each table in the suite gets another value once.
TEST(CaseHash, CoversEveryKeyExceptReasons) {
  const auto files = find_case_files({fs::path(ATTEST_SOURCE_DIR) / "cases"});
  ASSERT_TRUE(files) << files.error().to_string();
  std::map<std::string, std::vector<Value>> by_path;
  std::map<std::string, std::set<std::string>> texts;
  for (const fs::path& file : *files) {
    for (Value& value : values_in(file)) {
      texts[value.key].insert(value.text);
      by_path[value.table + value.key].push_back(std::move(value));
    }
  }
  EXPECT_GT(by_path.size(), 400u);
  // With another value of these keys the rest of the file is not valid, or they have no other
  // value.
  const std::set<std::string> with_others{"schema",   "group", "module", "signal", "plants",
                                          "profiles", "since", "until",  "level"};
  for (const auto& [path, values] : by_path) {
    if (with_others.contains(values.front().key)) continue;
    constexpr std::size_t attempts = 8;
    bool is_checked = false;
    for (std::size_t i = 0; i < std::min(values.size(), attempts) && !is_checked; ++i) {
      is_checked = check_hash_with_another(values[i], texts[values[i].key]);
    }
    EXPECT_TRUE(is_checked) << path << ": no other value is valid";
  }
}

constexpr const char* rich =
    "rates_hz = [250, 500]\nrates_why = \"two\"\nlevel = \"exact\"\n"
    "[unit]\nseed = 16\njitter = 0.5\n"
    "[parameters]\nMC_ROLL_P = 5\nMC_PITCH_P = 6.5\n"
    "[control_state]\nroll_rate = { signal = \"step\", from = 0, to = 1.5, at_ticks = 5 }\n"
    "[tolerance]\nwhy = \"reason\"\n"
    "\"vehicle_rates_setpoint\" = { absolute = 0.5 }\n"
    "\"vehicle_rates_setpoint.roll\" = { absolute = 0.25 }\n";

TEST(CaseHash, IsTheSameForTheSameDataInOtherWords) {
  const std::string other =
      "# The same case.\nduration_ticks = 0xA\nwhy = '''other words'''\ngroup = \"\\u0074ests\"\n"
      "unit = {jitter=5e-1,seed=0x10}\nrates_why = \"another\"\nlevel = 'exact'\n"
      "control_state.roll_rate.signal = \"step\"\ncontrol_state.roll_rate.at_ticks = 5.0\n"
      "control_state.roll_rate.to = 15e-1\ncontrol_state.roll_rate.from = 0.0\n"
      "rates_hz = [ 250.0,\n  500, ]\nprofiles = [\"px4-v1.5.5\", \"px4-v1.3.4\"]\nschema = 0b1\n\n"
      "[tolerance.\"vehicle_rates_setpoint.roll\"]\nabsolute = 0.250\n"
      "[tolerance]\n\"vehicle_rates_setpoint\".absolute = 0.5\nwhy = \"another reason\"\n"
      "[parameters] # in another order\nMC_PITCH_P = 6.50\nMC_ROLL_P = 5.0\n";
  const auto parsed = CaseFiles().parse(other);
  ASSERT_TRUE(parsed) << parsed.error().to_string();
  EXPECT_EQ(parsed->sha256, case_of(rich).sha256);
  EXPECT_EQ(parsed->file_sha256, sha256(other));
  EXPECT_NE(parsed->file_sha256, case_of(rich).file_sha256);
}

TEST(CaseHash, IsTheSameForOtherProfiles) {
  const std::string list = "profiles = [\"px4-v1.5.5\"]";
  for (const char* profiles :
       {"profiles = [\"px4-v1.5.5\", \"px4-v1.3.4\"]", "since = \"px4-v1.3.4\"",
        "until = \"px4-v1.5.5\"", "since = \"px4-v1.5.5\"\nuntil = \"px4-v1.5.5\""}) {
    std::string text = CaseFiles::with(rich);
    text.replace(text.find(list), list.size(), profiles);
    const auto parsed = CaseFiles().parse(text);
    ASSERT_TRUE(parsed) << parsed.error().to_string();
    EXPECT_EQ(parsed->sha256, case_of(rich).sha256) << profiles;
  }
}

TEST(CaseHash, ChangesWhenAKeyGoesOrMoves) {
  std::set<std::string> hashes{case_of(rich).sha256};
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"[parameters]\nMC_ROLL_P = 5\nMC_PITCH_P = 6.5\n", ""},
           {"MC_PITCH_P = 6.5\n", ""},
           {"MC_ROLL_P = 5\nMC_PITCH_P = 6.5\n", "MC_PITCH_P = 5\nMC_ROLL_P = 6.5\n"},
           {"level = \"exact\"\n", ""},
           {"[250, 500]", "[250]"},
           {"[250, 500]", "[250, 500, 1000]"},
           {"roll_rate =", "pitch_rate ="},
           {"[control_state]", "[battery_status]\nscale = 1\n[control_state]"},
           {"from = 0", "from = -0.0"},
           {"from = 0", "from = nan"},
           {"from = 0", "from = inf"},
           {"from = 0", "from = -inf"},
           {"to = 1.5", "to = 1.5000000000000002"},
           {"seed = 16", "seed = 9007199254740993"},
           {"seed = 16", "seed = 9007199254740992"},
           {"\"vehicle_rates_setpoint.roll\"", "\"vehicle_rates_setpoint.yaw\""},
       }) {
    std::string text = rich;
    text.replace(text.find(from), from.size(), to);
    EXPECT_TRUE(hashes.insert(case_of(text).sha256).second) << from << " -> " << to;
  }
}

}  // namespace
}  // namespace attest
