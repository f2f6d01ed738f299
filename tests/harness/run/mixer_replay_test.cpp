#include "harness/run/mixer_replay.hpp"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::HasSubstr;
using testing::Optional;

constexpr const char* quad = "R: 4x 10000 10000 10000 0";

const std::string recorded = ATTEST_SOURCE_DIR "/golden/recorded/mixer-v1.5.5/";

MixerTrace recorded_quad() {
  const auto trace = read_mixer_csv(recorded + "4x.csv");
  if (!trace) ADD_FAILURE() << trace.error().to_string();
  return trace.value_or(MixerTrace{});
}

TEST(MixerReplay, TheFirmwaresMixerIsOurs) {
  const auto replay = replay_mixer(recorded_quad(), quad);
  ASSERT_TRUE(replay);
  EXPECT_EQ(replay->samples, 1100u);
  EXPECT_EQ(replay->deviating, 0u);
  EXPECT_EQ(replay->first, "");
}

TEST(MixerReplay, OneBitOfAnOutputIsFound) {
  MixerTrace trace = recorded_quad();
  trace.samples[7].out[2] = std::nextafter(trace.samples[7].out[2], 9.0f);
  const auto replay = replay_mixer(trace, quad);
  ASSERT_TRUE(replay);
  EXPECT_EQ(replay->deviating, 1u);
  EXPECT_THAT(replay->first, HasSubstr("out[2] at sample 7: got "));
}

TEST(MixerReplay, AFlagIsFoundAndTheFirstIsReported) {
  MixerTrace trace = recorded_quad();
  trace.samples[3].yaw_limit = trace.samples[3].yaw_limit ? 0 : 1;
  trace.samples[9].out[0] += 1;
  const auto replay = replay_mixer(trace, quad);
  ASSERT_TRUE(replay);
  EXPECT_EQ(replay->deviating, 2u);
  EXPECT_THAT(replay->first, HasSubstr("yaw_limit at sample 3"));
}

TEST(MixerReplay, ADefinitionThatDoesNotFitIsAnError) {
  const auto none = replay_mixer(recorded_quad(), "R: 4q 1 1 1 0");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("mixer `R: 4q 1 1 1 0`"));
  const auto six = replay_mixer(recorded_quad(), "R: 6x 10000 10000 10000 0");
  ASSERT_FALSE(six);
  EXPECT_THAT(six.error().message, HasSubstr("has 4 rotors"));
}

TEST(MixerOf, TheProvenanceSays) {
  EXPECT_THAT(mixer_of(recorded + "4x_scaled_idle.csv"),
              Optional(std::string("R: 4x 8000 9000 5000 1500")));
}

TEST(MixerOf, OrTheNameOfTheFile) {
  const TemporaryDirectory folder;
  EXPECT_THAT(mixer_of((folder.path() / "6x.csv").string()),
              Optional(std::string("R: 6x 10000 10000 10000 0")));
  EXPECT_EQ(mixer_of((folder.path() / "flight.csv").string()), std::nullopt);
}

}  // namespace
}  // namespace attest
