#include "harness/sweep/sweep_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* good_sweep =
    "schema = 1\n"                             // 1
    "case = 'flight/hover'\n"                  // 2
    "rate = '250:1000'\n"                      // 3
    "design = 'latin_hypercube'\n"             // 4
    "samples = 100\n"                          // 5
    "[disperse.mass]\n"                        // 6
    "keys = ['vehicle.mass_kg']\n"             // 7
    "as = 'factor'\n"                          // 8
    "distribution = 'uniform'\n"               // 9
    "low = 0.9\n"                              // 10
    "high = 1.1\n"                             // 11
    "[disperse.tilt]\n"                        // 12
    "keys = ['case.flight.start.tilt_deg']\n"  // 13
    "distribution = 'normal'\n"                // 14
    "mean = 0\n"                               // 15
    "deviation = 5\n"                          // 16
    "[correlate.both]\n"                       // 17
    "dispersions = ['mass', 'tilt']\n"         // 18
    "matrix = [1, 0.5, 0.5, 1]\n"              // 19
    "[require.settles]\n"                      // 20
    "max = 2\n"                                // 21
    "probability = 0.9\n";                     // 22

std::string with(const std::string& what, const std::string& replacement) {
  std::string text = good_sweep;
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), replacement);
}

TEST(SweepFile, GivesEveryValue) {
  const auto sweep = parse_sweep(good_sweep, "s.toml");
  ASSERT_TRUE(sweep) << sweep.error().to_string();
  EXPECT_EQ(sweep->case_name, "flight/hover");
  EXPECT_EQ(sweep->rate.to_string(), "250:1000");
  EXPECT_EQ(sweep->design.kind, DesignKind::latin_hypercube);
  EXPECT_EQ(sweep->design.samples, 100u);
  EXPECT_EQ(sweep->design.dimensions, 2u);
  EXPECT_THAT(sweep->design.correlation, ElementsAre(1, 0.5, 0.5, 1));
  ASSERT_EQ(sweep->dispersions.size(), 2u);
  EXPECT_EQ(sweep->dispersions[0].as, Dispersion::As::factor);
  EXPECT_EQ(sweep->dispersions[0].keys[0].path, "mass_kg");
  EXPECT_EQ(sweep->dispersions[1].keys[0].document, DispersedKey::Document::the_case);
  EXPECT_EQ(sweep->requirements[0].metric, "settles");
  EXPECT_EQ(sweep->confidence, 0.95);
}

TEST(SweepFile, ASobolSequenceHasNoRequirements) {
  for (const char* const design : {"sobol", "saltelli"}) {
    const auto sweep = parse_sweep(with("latin_hypercube", design), "s.toml");
    ASSERT_FALSE(sweep);
    EXPECT_THAT(sweep.error().to_string(), HasSubstr("s.toml:20:2: needs the design"));
  }
}

TEST(SweepFile, AnOptionReplacesTheNumberOfSamples) {
  EXPECT_EQ(parse_sweep(good_sweep, "s.toml", 7)->design.samples, 7u);
}

TEST(SweepFile, AGridHasTheProductOfItsLevels) {
  const auto sweep = parse_sweep(
      "schema = 1\ncase = 'hover'\nrate = 250\ndesign = 'grid'\n"
      "[disperse.mass]\nkeys = ['vehicle.mass_kg']\ndistribution = 'uniform'\nlow = 1\nhigh = 2\n"
      "levels = 4\n"
      "[disperse.cells]\nkeys = ['vehicle.battery.cells']\ndistribution = 'choice'\n"
      "values = [3, 4, 6]\n"
      "[disperse.noise]\nkeys = ['case.flight.estimator.seed']\ndistribution = 'seed'\n",
      "s.toml");
  ASSERT_TRUE(sweep) << sweep.error().to_string();
  EXPECT_EQ(sweep->design.samples, 12u);
  EXPECT_THAT(sweep->design.levels, ElementsAre(4, 3));
}

struct Wrong {
  std::string what, replacement, message;

  friend void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.replacement; }
};

class WrongSweep : public testing::TestWithParam<Wrong> {};

TEST_P(WrongSweep, IsRefusedWithItsLine) {
  const auto sweep = parse_sweep(with(GetParam().what, GetParam().replacement), "s.toml");
  ASSERT_FALSE(sweep);
  EXPECT_THAT(sweep.error().to_string(), HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongSweep,
    testing::Values(
        Wrong{"schema = 1", "schema = 2", "s.toml:1:1: must be 1"},
        Wrong{"samples = 100", "sample = 100", "s.toml:5:1: unknown key `sample`; did you mean"},
        Wrong{"samples = 100", "samples = 0", "s.toml:5:1: must be positive"},
        Wrong{"samples = 100", "samples = 2000000000", "at most 10000000 are possible"},
        Wrong{"'250:1000'", "'250:'", "s.toml:3:1: "},
        Wrong{"latin_hypercube", "latin", "s.toml:4:1: unknown design `latin`"},
        Wrong{"['vehicle.mass_kg']", "['mass_kg']", "s.toml:7:1: `mass_kg` must begin with"},
        Wrong{"['vehicle.mass_kg']", "[]", "s.toml:7:1: names no key"},
        Wrong{"'factor'", "'times'", "s.toml:8:1: must be value, factor or offset"},
        Wrong{"'uniform'", "'gauss'", "s.toml:9:1: unknown distribution `gauss`"},
        Wrong{"high = 1.1", "high = 0.9", "s.toml:11:1: must be above `low`"},
        Wrong{"low = 0.9", "low = -inf", "s.toml:10:1: must be a finite number"},
        Wrong{"deviation = 5", "deviation = 0", "s.toml:16:1: must be positive"},
        Wrong{"deviation = 5", "deviation = 5\nlevels = 3", "is for the design `grid`"},
        Wrong{"'normal'\nmean = 0", "'truncated_normal'\nlow = 90\nhigh = 91\nmean = 0",
              "leaves less than a millionth"},
        Wrong{"[disperse.mass]", "[disperse.'a,b']", "a name has letters, digits and `_`"},
        Wrong{"['mass', 'tilt']", "['mass', 'tilr']", "no dispersion `tilr`; did you mean `tilt`?"},
        Wrong{"['mass', 'tilt']", "['mass', 'mass']", "`mass` is correlated twice"},
        Wrong{"[1, 0.5, 0.5, 1]", "[1, 0.5, 0.4, 1]", "s.toml:19:1: needs 2 x 2 numbers"},
        Wrong{"[1, 0.5, 0.5, 1]", "[1, 1.5, 1.5, 1]", "s.toml:19:1: needs 2 x 2 numbers"},
        Wrong{"latin_hypercube", "grid", "a grid has all combinations; leave it out"},
        Wrong{"latin_hypercube", "saltelli",
              "s.toml:17:2: Sobol indices need independent dispersions"},
        Wrong{
            "latin_hypercube'\nsamples = 100", "saltelli'\nsamples = 101",
            "s.toml:5:1: must be a multiple of 4: a block is two points, and one more for each of "
            "2 dispersions"},
        Wrong{"max = 2\n", "", "s.toml:20:10: needs `min` or `max`"},
        Wrong{"max = 2\n", "max = 2\nmin = 3\n", "no number is within these bounds"},
        Wrong{"probability = 0.9", "probability = 1", "must be between 0 and 1"},
        Wrong{"probability = 0.9\n", "", "missing key `probability`"},
        Wrong{"samples = 100", "samples = 100\nconfidence = 1", "s.toml:6:1: must be from 0.5"},
        Wrong{"samples = 100", "samples = 100\nstop_when_decided = true",
              "s.toml:6:1: needs independent samples: use the design `monte_carlo`"},
        Wrong{"samples = 100", "samples = 100\nstop_when_decided = 1", "s.toml:6:1: "},
        Wrong{"samples = 100", "samples = 100\ntie = -1",
              "s.toml:6:1: must be from 0 to below 1"}));

TEST(SweepFile, AnEarlyStopNeedsARequirement) {
  std::string text = with("'latin_hypercube'", "'monte_carlo'\nstop_when_decided = true");
  EXPECT_TRUE(parse_sweep(text, "s.toml")->stop_when_decided);
  text.resize(text.find("[require"));
  EXPECT_THAT(parse_sweep(text, "s.toml").error().to_string(),
              HasSubstr("s.toml:5:1: needs a requirement: [require.NAME]"));
}

TEST(SweepFile, AMatrixThatIsNotPositiveDefiniteIsRefused) {
  const std::string third =
      "[disperse.wind]\nkeys = ['case.flight.wind_m_s.north']\ndistribution = 'normal'\n"
      "mean = 0\ndeviation = 1\n[correlate.both]\n";
  std::string text = with("[correlate.both]\n", third);
  text.replace(text.find("'tilt']\nmatrix"), 7, "'tilt', 'wind']");
  text.replace(text.find("[1, 0.5, 0.5, 1]"), 16, "[1, 0.9, -0.9, 0.9, 1, 0.9, -0.9, 0.9, 1]");
  const auto sweep = parse_sweep(text, "s.toml");
  ASSERT_FALSE(sweep);
  EXPECT_THAT(sweep.error().to_string(), HasSubstr("s.toml:24:1: is not positive definite"));
}

class BoundSweep : public testing::Test {
 protected:
  static Result<void> bound(const std::string& text) {
    const auto the_case = TomlDocument::parse("[flight]\nwhy = 'x'\n", "c.toml");
    const auto vehicle = TomlDocument::parse("mass_kg = 1.5\nmixer = 'R'\n", "v.toml");
    Metric settles;
    settles.name = "settles";
    auto sweep = *parse_sweep(text, "s.toml");
    return bind_sweep(*the_case, *vehicle, {settles}, sweep);
  }
};

TEST_F(BoundSweep, FindsItsKeysAndMetrics) { EXPECT_TRUE(bound(good_sweep)); }

TEST_F(BoundSweep, AFactorNeedsAValue) {
  const auto done = bound(with("vehicle.mass_kg", "vehicle.mas_kg"));
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().to_string(),
              HasSubstr("s.toml:6: [disperse.mass]: `mas_kg` has no value in the vehicle"));
}

TEST_F(BoundSweep, AKeyMustBeANumber) {
  EXPECT_THAT(bound(with("vehicle.mass_kg", "vehicle.mixer")).error().to_string(),
              HasSubstr("`mixer` is no number"));
}

TEST_F(BoundSweep, TheCaseMustHaveTheMetric) {
  EXPECT_THAT(bound(with("[require.settles]", "[require.setles]")).error().to_string(),
              HasSubstr("s.toml:20: [require.setles]: the case has no metric `setles`; did you "
                        "mean `settles`?"));
}

}  // namespace
}  // namespace attest
