// Errors of a case file outside its topics and signals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// Five valid lines with one of them replaced.
std::string with_line(int line, const std::string& replacement) {
  std::string text;
  const std::string lines[] = {"schema = 1", "profiles = [\"px4-v1.5.5\"]", "group = \"tests\"",
                               "why = \"a test\"", "duration_ticks = 10"};
  for (int i = 1; i <= 5; ++i) text += (i == line ? replacement : lines[i - 1]) + "\n";
  return text;
}

TEST(CaseErrors, SyntaxHasALine) {
  EXPECT_THAT(errors_of("[parameters\n"), HasSubstr("6:12: not valid TOML"));
  EXPECT_THAT(errors_of("why = \"twice\"\n"), HasSubstr("6:"));
}

TEST(CaseErrors, IdentityIsThePlaceOfTheFile) {
  EXPECT_EQ(errors_of_text(with_line(3, "group = \"test\"")),
            "3:1: is `test`, but the folder is `tests`");
}

TEST(CaseErrors, ListsOfProfiles) {
  const auto errors_with = [](const std::string& line) {
    return errors_of_text(with_line(2, line));
  };
  EXPECT_EQ(errors_with("profiles = [\"px4-v1.3.4\"]"),
            "2:1: leaves out `px4-v1.5.5`, the profile of the folder");
  EXPECT_EQ(errors_with("profiles = [\"px4-v1.5.5\", \"px4-v1.3.5\"]"),
            "2:1: `px4-v1.3.5` is no profile; did you mean `px4-v1.3.4`?");
  EXPECT_EQ(errors_with("profiles = [\"px4-v1.16.0\", \"px4-v1.5.5\"]"),
            "2:1: `px4-v1.16.0` is a profile of another law than the folder");
  EXPECT_EQ(errors_with("profiles = []"), "2:1: names no profile");
  EXPECT_EQ(errors_with("profiles = [\"px4-v1.5.5\", \"px4-v1.5.5\"]"),
            "2:1: names a profile twice");
}

TEST(CaseErrors, RangesOfProfiles) {
  const auto errors_with = [](const std::string& line) {
    return errors_of_text(with_line(2, line));
  };
  EXPECT_EQ(errors_with("since = \"px4-v1.3.4\"\nprofiles = [\"px4-v1.5.5\"]"),
            "3:1: `since` or `until` is given too; keep one");
  EXPECT_EQ(errors_with("until = \"px4-v1.5.5\"\nprofiles = []"),
            "3:1: `since` or `until` is given too; keep one");
  EXPECT_EQ(errors_with("since = \"px4-v1.3\""),
            "2:1: `px4-v1.3` is no profile; did you mean `px4-v1.3.4`?");
  EXPECT_EQ(errors_with("until = \"\""), "2:1: `` is no profile");
  EXPECT_EQ(errors_with("since = 1.3"), "2:1: `since` must be text, found a floating point number");
  EXPECT_EQ(errors_with("  until = \"px4-v1.16.0\""),
            "2:3: `px4-v1.16.0` is a profile of another law than the folder");
  EXPECT_EQ(errors_with("since = \"px4-v1.5.5\"\nuntil = \"px4-v1.3.4\""),
            "3:1: `px4-v1.3.4` is older than `since`, so there is no profile in the range");
  EXPECT_EQ(errors_with("until = \"px4-v1.3.4\""),
            "2:1: leaves out `px4-v1.5.5`, the profile of the folder");
}

std::string errors_in_folder(const std::string& profile, const std::string& line) {
  const auto parsed = parse_case_text(with_line(2, line), "cases/" + profile + "/tests/a.toml");
  return parsed ? "" : parsed.error().to_string();
}

TEST(CaseErrors, ARangeIsOfTheLawOfItsFolder) {
  EXPECT_EQ(
      errors_in_folder("px4-v1.3.4", "since = \"px4-v1.5.5\""),
      "cases/px4-v1.3.4/tests/a.toml:2:1: leaves out `px4-v1.3.4`, the profile of the folder");
  EXPECT_EQ(errors_in_folder("px4-v1.5.6", "since = \"px4-v1.5.5\""),
            "cases/px4-v1.5.6/tests/a.toml:2:1: the folder `px4-v1.5.6` is no profile that attest "
            "knows; did you mean `px4-v1.5.5`?; give `profiles`");
  EXPECT_EQ(errors_in_folder("our-law", "profiles = [\"px4-v1.5.5\", \"our-law\"]"), "");
}

TEST(CaseErrors, EachRequiredKeyIsMissedOnce) {
  for (const char* key : {"schema", "profiles", "group", "why", "duration_ticks"}) {
    SCOPED_TRACE(key);
    std::string text = CaseFiles::with("");
    const auto begin = text.find(key);
    text.erase(begin, text.find('\n', begin) - begin);
    const std::string errors = errors_of_text(text);
    EXPECT_THAT(errors, HasSubstr(key));
    EXPECT_THAT(errors, Not(HasSubstr("\n")));
  }
}

TEST(CaseErrors, WrongValuesOfTheHead) {
  EXPECT_EQ(errors_of_text(with_line(1, "schema = 2")), "1:1: must be 1");
  EXPECT_EQ(errors_of_text(with_line(4, "why = \"\"")), "4:1: must say why the case exists");
  EXPECT_THAT(errors_of_text(with_line(4, "why = 1")),
              HasSubstr("4:1: `why` must be text, found an integer"));
  EXPECT_EQ(errors_of("level = \"strict\"\n"), "6:1: must be exact");
}

TEST(CaseErrors, UnknownKeysHaveASuggestion) {
  EXPECT_EQ(errors_of("rates_hs = [250]\n"),
            "6:1: unknown key `rates_hs`; did you mean `rates_hz`?");
  EXPECT_THAT(errors_of("[batery_status]\nscale = 1\n"),
              HasSubstr("did you mean `battery_status`?"));
  EXPECT_EQ(errors_of("[unit]\njiter = 0.1\n"), "7:1: unknown key `jiter`; did you mean `jitter`?");
}

TEST(CaseErrors, AllAreSaidAtOnce) {
  const std::string errors = errors_of("level = \"strict\"\n[unit]\njitter = 2\n");
  EXPECT_THAT(errors, AllOf(HasSubstr("6:1: must be exact"), HasSubstr("8:1: is a fraction")));
}

TEST(CaseErrors, Durations) {
  const auto error_of = [](const std::string& line) { return errors_of_text(with_line(5, line)); };
  EXPECT_EQ(error_of("duration_ticks = 0"), "5:1: must be positive");
  EXPECT_EQ(error_of("duration_s = 0"), "5:1: must be positive");
  EXPECT_EQ(error_of("duration_ticks = 2.5"), "5:1: must be a whole number");
  EXPECT_THAT(error_of("duration_ticks = -1"), HasSubstr("must be a time from 0 up to 1000000"));
  EXPECT_THAT(error_of("duration_ticks = nan"), HasSubstr("must be a time from 0 up to 1000000"));
  EXPECT_THAT(error_of("duration_ticks = 1000001"), HasSubstr("must be a time from 0 up to"));
  EXPECT_EQ(error_of("duration_s = 126"), "5:1: is more than 1000000 ticks at 8000 Hz");
  EXPECT_EQ(error_of("duration_s = 125"), "");
  EXPECT_EQ(error_of("duration_ticks = 10\nduration_s = 1"),
            "6:1: `duration_ticks` is given too; keep one of them");
}

TEST(CaseErrors, Rates) {
  const std::string why = "rates_why = \"some\"\n";
  EXPECT_THAT(errors_of("rates_hz = [250]\n"), HasSubstr("missing key `rates_why`"));
  EXPECT_EQ(errors_of(why), "6:1: explains `rates_hz`, which is not there");
  EXPECT_EQ(errors_of(why + "rates_hz = []\n"), "7:1: names no rate");
  EXPECT_EQ(errors_of(why + "rates_hz = [250, 100, 250.0]\n"), "7:1: names a rate twice");
  EXPECT_THAT(errors_of(why + "rates_hz = [0]\n"), HasSubstr("7:1: `0` is not a rate"));
  EXPECT_THAT(errors_of(why + "rates_hz = [-250]\n"), HasSubstr("is not a rate"));
  EXPECT_THAT(errors_of(why + "rates_hz = [2e6]\n"), HasSubstr("too fast"));
  EXPECT_THAT(errors_of(why + "rates_hz = [333.33333333]\n"), HasSubstr("at most 9 digits"));
  EXPECT_THAT(errors_of(why + "rates_hz = \"250\"\n"), HasSubstr("must be an array of numbers"));
}

TEST(CaseErrors, UnitTiming) {
  for (const char* jitter : {"-0.1", "1", "nan"}) {
    EXPECT_THAT(errors_of(std::string("[unit]\njitter = ") + jitter + "\n"),
                HasSubstr("7:1: is a fraction of a period"));
  }
  EXPECT_EQ(errors_of("[unit]\nstart_s = -1\n"), "7:1: must be from 0 up to 8e9");
  EXPECT_EQ(errors_of("[unit]\nstart_s = 8.1e9\n"), "7:1: must be from 0 up to 8e9");
  EXPECT_THAT(errors_of("[unit]\nseed = 1.5\n"), HasSubstr("`seed` must be an integer"));
}

// A dropped tick that does not exist tests nothing.
TEST(CaseErrors, DroppedTicksAreTicksOfTheCase) {
  EXPECT_EQ(errors_of("[unit]\ndrop_ticks = [0, 9]\n"), "");
  EXPECT_EQ(errors_of("[unit]\ndrop_ticks = [10]\n"),
            "7:1: must be ticks of the case: from 0 to 9");
  EXPECT_EQ(errors_of("[unit]\ndrop_ticks = [-1]\n"),
            "7:1: must be ticks of the case: from 0 to 9");
  EXPECT_THAT(errors_of("[unit]\ndrop_ticks = [0,1,2,3,4,5,6,7,8,9]\n"),
              HasSubstr("leaves no tick at 50 Hz"));
}

// Otherwise a case of a few lines takes all memory.
TEST(CaseErrors, NothingHappensMoreOftenThanTheLongestCaseHasTicks) {
  const std::string topic = "[battery_status]\n";
  const std::string slow = "rates_why = \"slow\"\nrates_hz = [0.1]\n" + topic;
  const auto walk = [](const std::string& every) {
    return "scale = { signal = \"random_walk\", seed = 1, step = 0.1, min = -1, max = 1, " + every +
           " }\n";
  };
  EXPECT_EQ(errors_of(slow + walk("every_s = 1e-3")), "");
  EXPECT_THAT(errors_of(slow + walk("every_s = 1e-6")),
              HasSubstr("`battery_status` has a random walk with more than 1000000 steps"));
  EXPECT_THAT(errors_of(topic + walk("every_ticks = 1e-6")), HasSubstr("a random walk with more"));
  EXPECT_EQ(errors_of(slow + "rate_hz = 1000\n"), "");
  EXPECT_EQ(errors_of(slow + "rate_hz = 1e6\n"), "");
  EXPECT_THAT(errors_of(slow + "rate_hz = 1e6\njitter = 0.5\n"),
              HasSubstr("`battery_status` is published more than 1000000 times at 1/10 Hz"));
}

TEST(CaseErrors, OfTheUnitsTicks) {
  EXPECT_EQ(errors_of("[unit]\njitter_shape = 'wide'\n"), "7:1: must be uniform or heavy");
  EXPECT_EQ(errors_of("[unit]\ndrop_every = 1\n"),
            "7:1: must be 2 or more: of each group of this many ticks, the last is left out");
  EXPECT_EQ(errors_of("[unit]\nstall = { every_ticks = 4, for_ticks = 3, catches_up = true }\n"),
            "");
  EXPECT_THAT(errors_of("[unit]\nstall = { every_s = 0.01, for_ticks = 2 }\n"),
              HasSubstr("must end before the next one begins"));
  EXPECT_THAT(errors_of("[unit]\nstall = { every_s = 0.01, for_s = 0 }\n"),
              HasSubstr("must be positive"));
  EXPECT_THAT(errors_of("[unit]\nstall = { every_s = 0.01 }\n"), HasSubstr("for_s"));
}

// Timestamps are microseconds, and have to increase.
TEST(CaseErrors, JitterKeepsTicksApart) {
  EXPECT_EQ(errors_of("[unit]\njitter = 0.99\n"), "");
  EXPECT_EQ(errors_of("[unit]\njitter = 0.9999\n"),
            "7:1: leaves less than 1 us between ticks at 8000 Hz");
}

TEST(CaseErrors, AParameterExistsInEveryProfileOfTheFile) {
  std::string text = CaseFiles::with("[parameters]\nMC_TPA_BREAK = 0.5\n");
  EXPECT_EQ(errors_of_text(text), "");
  const std::string one = "[\"px4-v1.5.5\"]";
  text.replace(text.find(one), one.size(), "[\"px4-v1.5.5\", \"px4-v1.3.4\"]");
  EXPECT_THAT(errors_of_text(text), HasSubstr("unknown parameter `MC_TPA_BREAK`"));
  EXPECT_THAT(errors_of_text(text), HasSubstr("--profile px4-v1.3.4` shows those of px4-v1.3.4"));
}

TEST(CaseErrors, Instances) {
  EXPECT_EQ(errors_of("instances = \"together\"\n"), "");
  EXPECT_THAT(errors_of("instances = \"two\"\n"),
              HasSubstr("6:1: must be one of again, together, crossed, after_many, "
                        "among_many, other_profiles, two_threads"));
}

TEST(CaseErrors, Parameters) {
  EXPECT_THAT(errors_of("[parameters]\nMC_ROL_P = 1\n"),
              HasSubstr("7:1: unknown parameter `MC_ROL_P`; did you mean `MC_ROLL_P`?"));
  EXPECT_THAT(errors_of("[parameters]\nMC_ROLL_P = \"1\"\n"), HasSubstr("must be a number"));
  EXPECT_THAT(errors_of("parameters = 3\n"), HasSubstr("`parameters` must be a table"));
}

TEST(CaseErrors, Tolerances) {
  const std::string head = "[tolerance]\nwhy = \"x\"\n";
  EXPECT_THAT(errors_of("[tolerance]\nvehicle_rates_setpoint = { absolute = 1 }\n"),
              HasSubstr("6:2: missing key `why`"));
  EXPECT_THAT(errors_of(head + "vehicle_rate_setpoint = { absolute = 1 }\n"),
              HasSubstr("8:1: `vehicle_rate_setpoint` is no output topic or signal"));
  EXPECT_THAT(errors_of(head + "vehicle_rates_setpoint = { relative = 1 }\n"),
              HasSubstr("missing key `absolute`"));
  for (const char* value : {"-1", "nan", "inf"}) {
    EXPECT_THAT(errors_of(head + "mc_att_ctrl_status = { absolute = " + value + " }\n"),
                HasSubstr("tolerances must be finite and not negative"));
  }
  // Without quotes the dot makes a table of its own.
  EXPECT_THAT(errors_of(head + "vehicle_rates_setpoint.roll = { absolute = 1 }\n"),
              HasSubstr("unknown key `roll`"));
}

// The name is a key in the provenance of the goldens, and part of the ids in reports.
TEST(CaseErrors, ANameThatCannotBeShown) {
  const CaseFiles files;
  for (const char* name : {"two\nlines", "no utf-8 \xff"}) {
    const auto parsed = parse_case(files.write("tests", name, CaseFiles::with("")));
    ASSERT_FALSE(parsed) << name;
    EXPECT_THAT(parsed.error().message,
                testing::HasSubstr("only UTF-8 without control characters"));
  }
}

}  // namespace
}  // namespace attest
