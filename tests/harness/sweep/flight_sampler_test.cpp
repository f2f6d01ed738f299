#include "harness/sweep/flight_sampler.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/parse.hpp"
#include "harness/core/file.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

const std::filesystem::path source = ATTEST_SOURCE_DIR;

constexpr const char* mass_and_tilt =
    "schema = 1\ncase = 'x'\nrate = 250\ndesign = 'monte_carlo'\nsamples = 50\n"
    "[disperse.mass]\nkeys = ['vehicle.mass_kg']\nas = 'factor'\n"
    "distribution = 'uniform'\nlow = 0.9\nhigh = 1.1\n"
    "[disperse.tilt]\nkeys = ['case.flight.start.tilt_deg']\n"
    "distribution = 'uniform'\nlow = -3\nhigh = 3\n";

Result<FlightSampler> sampler_of(const std::string& text) {
  const auto file = source / "cases/px4-v1.5.5/flight/tilt_step_30.toml";
  auto sweep = parse_sweep(text, "s.toml");
  if (!sweep) return tl::unexpected(sweep.error());
  const auto iris = *VehicleModel::load(source / "models", "iris");
  return FlightSampler::make(*std::move(sweep), {*parse_case(file),
                                                 *read_file(file),
                                                 {"iris", PlantKind::mujoco},
                                                 iris,
                                                 *read_file(iris->vehicle().file)});
}

std::string error_of(const std::string& text) {
  const auto sampler = sampler_of(text);
  return sampler ? "" : sampler.error().to_string();
}

TEST(FlightSampler, PutsTheNumbersIntoCaseAndVehicle) {
  const auto sampler = sampler_of(mass_and_tilt);
  ASSERT_TRUE(sampler) << sampler.error().to_string();
  const auto flight = sampler->sample(42);
  ASSERT_TRUE(flight) << flight.error().to_string();
  const double mass = flight->vehicle_model->vehicle().mass_kg;
  EXPECT_EQ(mass, 1.5 * flight->drawn[0]);
  EXPECT_NE(mass, 1.5);
  const auto document = TomlDocument::parse(flight->case_text, "c.toml");
  EXPECT_EQ(*document->number("flight.start.tilt_deg"), flight->drawn[1]);
  EXPECT_EQ(flight->the_case.id(), "px4-v1.5.5/flight/tilt_step_30");
}

TEST(FlightSampler, TheTextsOfASampleGiveTheSameFlight) {
  const auto flight = *sampler_of(mass_and_tilt)->sample(7);
  const auto again = parse_vehicle(flight.vehicle_text, "iris.toml");
  EXPECT_EQ(again->mass_kg, flight.vehicle_model->vehicle().mass_kg);
}

TEST(FlightSampler, TheSampleOfAnIndexIsAlwaysTheSame) {
  const auto first = *sampler_of(mass_and_tilt);
  const auto second = *sampler_of(mass_and_tilt);
  EXPECT_EQ(first.sample(9)->drawn, second.sample(9)->drawn);
  EXPECT_NE(first.sample(9)->drawn, first.sample(8)->drawn);
}

TEST(FlightSampler, EachSampleHasSeedsOfItsOwn) {
  const auto sampler = *sampler_of(std::string(mass_and_tilt) +
                                   "[disperse.noise]\nkeys = ['case.flight.estimator.seed']\n"
                                   "distribution = 'seed'\n");
  const auto one = *sampler.sample(1), other = *sampler.sample(2);
  EXPECT_NE(one.the_case.flight->estimator.seed, other.the_case.flight->estimator.seed);
  EXPECT_EQ(static_cast<double>(one.the_case.flight->estimator.seed), one.drawn[2]);
}

TEST(FlightSampler, ADistributionThatReachesImpossibleNumbersIsRefused) {
  const std::string text =
      "schema = 1\ncase = 'x'\nrate = 250\ndesign = 'monte_carlo'\nsamples = 5\n"
      "[disperse.mass]\nkeys = ['vehicle.mass_kg']\ndistribution = 'normal'\nmean = 1.5\n"
      "deviation = 0.5\n";
  const std::string error = error_of(text);
  EXPECT_THAT(error, HasSubstr("s.toml:6: [disperse.mass] at its lowest number, -2.6"));
  EXPECT_THAT(error, HasSubstr("vehicle.mass_kg = -2.6"));
  EXPECT_THAT(error, HasSubstr("must be positive; use a bounded distribution"));
}

TEST(FlightSampler, AnImpossibleNumberOfAChoiceIsRefusedWhereverItStands) {
  for (const char* const values : {"[1.5, 99, -2]", "[1.5, -2, 99]", "[-2, 1.5]"}) {
    const std::string error = error_of(
        fmt::format("schema = 1\ncase = 'x'\nrate = 250\ndesign = 'monte_carlo'\nsamples = 5\n"
                    "[disperse.mass]\nkeys = ['vehicle.mass_kg']\ndistribution = 'choice'\n"
                    "values = {}\n",
                    values));
    EXPECT_THAT(error, HasSubstr("[disperse.mass] at its lowest number, -2")) << values;
  }
}

TEST(FlightSampler, NumbersThatAreImpossibleTogetherAreNamedWithTheirSample) {
  const auto sampler = sampler_of(
      "schema = 1\ncase = 'x'\nrate = 250\ndesign = 'monte_carlo'\nsamples = 100\n"
      "[disperse.x]\nkeys = ['vehicle.inertia_kg_m2[0]']\ndistribution = 'uniform'\n"
      "low = 0.026105\nhigh = 0.026145\n"
      "[disperse.y]\nkeys = ['vehicle.inertia_kg_m2[1]']\ndistribution = 'uniform'\n"
      "low = 0.029105\nhigh = 0.029145\n");
  ASSERT_TRUE(sampler) << sampler.error().to_string();
  std::string message;
  for (std::uint64_t i = 0; i < 100; ++i) {
    if (const auto sample = sampler->sample(i); !sample) message = sample.error().to_string();
  }
  EXPECT_THAT(message, testing::MatchesRegex("s.toml:.*sample [0-9]+: vehicle.inertia_kg_m2.0. = "
                                             "0.026.*is impossible.*"));
}

TEST(FlightSampler, AnUnknownKeyIsRefusedByTheStrictReader) {
  std::string text = mass_and_tilt;
  text.replace(text.find("start.tilt_deg"), 14, "start.tild_deg");
  EXPECT_THAT(error_of(text), HasSubstr("unknown key `tild_deg`; did you mean `tilt_deg`?"));
}

TEST(FlightSampler, TheHashNamesAllThatTheSamplesDependOn) {
  const auto first = *sampler_of(mass_and_tilt);
  EXPECT_EQ(first.sha256(), sampler_of(mass_and_tilt)->sha256());
  EXPECT_NE(first.sha256(), sampler_of(std::string(mass_and_tilt) + "# again\n")->sha256());
}

}  // namespace
}  // namespace attest
