// Properties of the inputs of every case.
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

std::string any_signal() {
  const int a = *rc::gen::inRange(-9, 10), b = *rc::gen::inRange(-9, 10);
  const int tick = *rc::gen::inRange(1, 12);
  switch (*rc::gen::inRange(0, 6)) {
    case 0:
      return fmt::format("{}", a);
    case 1:
      return fmt::format("{{ signal = \"step\", from = {}, to = {}, at_ticks = {} }}", a, b, tick);
    case 2:
      return fmt::format("{{ signal = \"ramp\", from = {}, to = {}, end_ticks = {} }}", a, b, tick);
    case 3:
      return fmt::format("{{ signal = \"sine\", amplitude = {}, cycles = {} }}", a, b);
    case 4:
      return fmt::format("{{ signal = \"chirp\", amplitude = {}, from_hz = 1, to_hz = {} }}", a, b);
    default:
      return fmt::format(
          "{{ signal = \"random_walk\", seed = {}, step = 2, min = -9, max = 9, every_ticks = {} "
          "}}",
          b, tick);
  }
}

std::string any_publication() {
  const int a = *rc::gen::inRange(1, 9), b = *rc::gen::inRange(0, 9);
  switch (*rc::gen::inRange(0, 5)) {
    case 0:
      return "";
    case 1:
      return "publish = \"never\"";
    case 2:
      return fmt::format("period_ticks = {}\nphase_ticks = {}", a, b);
    case 3:
      return fmt::format("rate_hz = {}\nphase_s = 0.00{}", 30 * a, b);
    default:
      return fmt::format("publish_at_ticks = [{}, {}]", b, b + a);
  }
}

Case any_case() {
  const int jitter = *rc::gen::inRange(0, 90), seed = *rc::gen::inRange(0, 100);
  const int first = *rc::gen::inRange(0, 9);
  return case_of(
      fmt::format("[unit]\njitter = 0.{:02}\nseed = {}\ndrop_ticks = [{}, {}]\n"
                  "[control_state]\nq = {{ tilt_deg = {} }}\nroll_rate = {}\n"
                  "[battery_status]\nscale = {}\n{}\n"
                  "[manual_control_setpoint]\nx = {}\ny = {}\n{}\n"
                  "[parameters]\nMC_ROLL_P = {}\n",
                  jitter, seed, first, first + 1, any_signal(), any_signal(), any_signal(),
                  any_publication(), any_signal(), any_signal(), any_publication(), any_signal()));
}

bool same_inputs(const attest_inputs& a, const attest_inputs& b) {
  for (const Channel& channel : channels()) {
    Sample x{}, y{};
    x.in = a;
    y.in = b;
    if (value_of(channel, x) != value_of(channel, y)) return false;
  }
  return true;
}

RC_GTEST_PROP(Stimulate, TheSameCaseAndRateGiveTheSameBits, ()) {
  const Case the_case = any_case();
  const Rate rate = *rc::gen::elementOf(standard_rates());
  const Trace one = stimulate(the_case, rate), two = stimulate(the_case, rate);
  RC_ASSERT(one.samples.size() == two.samples.size());
  for (std::size_t tick = 0; tick < one.samples.size(); ++tick) {
    RC_ASSERT(same_inputs(one.samples[tick].in, two.samples[tick].in));
  }
  RC_ASSERT(one.parameters == two.parameters);
}

RC_GTEST_PROP(Stimulate, TimestampsStrictlyIncrease, ()) {
  const Trace trace = stimulate(any_case(), *rc::gen::elementOf(standard_rates()));
  RC_ASSERT(trace.samples.size() == 8u);
  for (std::size_t tick = 1; tick < trace.samples.size(); ++tick) {
    RC_ASSERT(trace.samples[tick - 1].in.timestamp < trace.samples[tick].in.timestamp);
  }
}

// A topic changes only in a sample that has its bit.
RC_GTEST_PROP(Stimulate, WithoutItsBitATopicStaysAsItWas, ()) {
  const Trace trace = stimulate(any_case(), *rc::gen::elementOf(standard_rates()));
  attest_inputs last{};
  for (const Sample& sample : trace.samples) {
    const attest_inputs& in = sample.in;
    if (!(in.updated & ATTEST_UPDATED_BATTERY_STATUS)) {
      RC_ASSERT(in.battery_status.scale == last.battery_status.scale);
    }
    if (!(in.updated & ATTEST_UPDATED_MANUAL_CONTROL_SETPOINT)) {
      RC_ASSERT(in.manual_control_setpoint.x == last.manual_control_setpoint.x);
      RC_ASSERT(in.manual_control_setpoint.y == last.manual_control_setpoint.y);
      RC_ASSERT(in.manual_control_setpoint.z == last.manual_control_setpoint.z);
    }
    last = in;
  }
}

RC_GTEST_PROP(Stimulate, EveryParameterChangeIsOneAndHasTheBit, ()) {
  const Trace trace = stimulate(any_case(), *rc::gen::elementOf(standard_rates()));
  RC_ASSERT(!trace.parameters.empty());
  RC_ASSERT(trace.parameters[0].tick == 0u);
  for (std::size_t i = 0; i < trace.parameters.size(); ++i) {
    const ParameterChange& change = trace.parameters[i];
    RC_ASSERT(trace.samples[change.tick].in.updated & ATTEST_UPDATED_PARAMETER_UPDATE);
    if (i == 0) continue;
    RC_ASSERT(change.tick > trace.parameters[i - 1].tick);
    RC_ASSERT(change.value != trace.parameters[i - 1].value);
  }
}

}  // namespace
}  // namespace attest
