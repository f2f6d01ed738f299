// A log that attest writes of a trace reads back to the same trace, value for value.
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "harness/trace/output_topics.hpp"
#include "harness/ulog/flight_log.hpp"
#include "harness/ulog/log_topics.hpp"
#include "harness/ulog/trace_log.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

// A trace of a unit in which every input and output changes at random, by the rules of the ABI.
class RandomTrace {
 public:
  explicit RandomTrace(Module module) : module_(module) {}

  Trace trace() {
    Trace trace;
    trace.source = "px4-v1.16.0/rates/random@250hz";
    trace.present = channels_of(module_);
    Sample sample;
    for (std::uint64_t tick = 0; tick < 60; ++tick) {
      sample.in.timestamp = 5000000 + 4000 * tick;
      sample.in.updated = 0;
      clear_published(module_, sample);
      for (const LogTopic& topic : log_topics(module_)) renew(topic, sample);
      trace.samples.push_back(sample);
    }
    trace.parameters = {{0, "MC_YAW_WEIGHT", 0.25f}, {7, "MC_YAW_WEIGHT", 0.5f}};
    set_value(channels()[*find_channel(module_, "in/updated.parameter_update")], trace.samples[7],
              1);
    return trace;
  }

 private:
  void renew(const LogTopic& topic, Sample& sample) {
    if (topic.is_new && random_() % 3 != 0) return;
    if (topic.is_new) set_value(channels()[*topic.is_new], sample, 1);
    for (const LogField& field : topic.fields) {
      const Channel& channel = channels()[field.channel];
      if (channel.type == ChannelType::f32) {
        set_value(channel, sample, random_() % 9 == 0 ? nan : static_cast<float>(random_()));
      } else {
        const bool is_byte = channel.type == ChannelType::u8;
        set_integer(channel, sample, is_byte ? random_() % 4 : big_ - random_());
      }
    }
  }

  static constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  static constexpr std::uint64_t big_ = std::numeric_limits<std::uint64_t>::max();
  Module module_;
  std::mt19937 random_{1};
};

std::string bits_of(const Channel& channel, const Sample& sample) {
  if (channel.type == ChannelType::u64) return std::to_string(integer_of(channel, sample));
  return std::to_string(value_of(channel, sample));
}

class UnitLog : public testing::TestWithParam<Module> {
 protected:
  std::filesystem::path path() const { return directory_.path() / "f.ulg"; }

  TemporaryDirectory directory_;
};

TEST_P(UnitLog, ReadsBackToTheSameTrace) {
  const Trace written = RandomTrace(GetParam()).trace();
  ASSERT_TRUE(write_log(*AtomicFile::open(path()), written));
  const auto log = read_flight_log(path());
  ASSERT_TRUE(log) << log.error().message;
  EXPECT_TRUE(log->is_of_attest);
  EXPECT_EQ(log->profile, "px4-v1.16.0");
  ASSERT_EQ(log->units.size(), 1u);
  const LoggedUnit& unit = log->units[0];
  EXPECT_EQ(unit.module, GetParam());
  EXPECT_TRUE(unit.has_every_step);
  EXPECT_EQ(unit.trace.parameters, written.parameters);
  EXPECT_EQ(unit.trace.present, written.present);
  ASSERT_EQ(unit.trace.samples.size(), written.samples.size());
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (!written.present[i]) continue;
    for (std::size_t tick = 0; tick < written.samples.size(); ++tick) {
      ASSERT_EQ(bits_of(channels()[i], unit.trace.samples[tick]),
                bits_of(channels()[i], written.samples[tick]))
          << channels()[i].name << " at tick " << tick;
    }
  }
}

TEST_P(UnitLog, OfAFlightReadsBack) {
  Trace written = RandomTrace(GetParam()).trace();
  written.plant.resize(written.samples.size(), PlantSample{});
  for (PlantSample& plant : written.plant) plant.voltage_V = 12.5f;
  ASSERT_TRUE(write_log(*AtomicFile::open(path()), written));
  const auto log = read_flight_log(path());
  ASSERT_TRUE(log) << log.error().message;
  EXPECT_EQ(log->units[0].module, GetParam());
  if (GetParam() == Module::mc_att_control) return;  // battery_status is logged at each tick
  const ChannelSet inputs = channels_of(GetParam(), "in/");
  for (std::size_t i = 0; i < channels().size(); ++i) {
    for (std::size_t tick = 0; inputs[i] && tick < written.samples.size(); ++tick) {
      ASSERT_EQ(bits_of(channels()[i], log->units[0].trace.samples[tick]),
                bits_of(channels()[i], written.samples[tick]))
          << channels()[i].name << " at tick " << tick;
    }
  }
}

TEST_P(UnitLog, WithoutAnyOutputReadsBack) {
  Trace written = RandomTrace(GetParam()).trace();
  for (Sample& sample : written.samples) sample.clear_outputs();
  ASSERT_TRUE(write_log(*AtomicFile::open(path()), written));
  const auto log = read_flight_log(path());
  ASSERT_TRUE(log) << log.error().message;
  EXPECT_EQ(log->units[0].trace.present, written.present);
}

INSTANTIATE_TEST_SUITE_P(OfEach, UnitLog,
                         testing::Values(Module::mc_att_control, Module::attitude_unit,
                                         Module::rate_unit),
                         [](const auto& of) { return std::string(name_of(of.param)); });

}  // namespace
}  // namespace attest
