#include "tests/harness/report/sample_run.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace attest {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

VectorResult result(Verdict verdict, const std::string& group, const std::string& name,
                    LoopRate rate, const std::string& reason) {
  VectorResult out = passed(group, name, rate);
  out.verdict = verdict;
  out.reason = reason;
  out.tightest.reset();
  return out;
}

VectorResult failing(const std::string& group, const std::string& name, LoopRate rate,
                     Deviation first, std::size_t deviating_ticks) {
  VectorResult out = result(Verdict::fail, group, name, rate, "");
  out.first = first;
  out.deviating_ticks = deviating_ticks;
  return out;
}

VectorResult died(Verdict verdict, const std::string& name, LoopRate rate,
                  const std::string& reason) {
  VectorResult out = result(verdict, "robustness", name, rate, reason);
  out.ticks = 0;
  return out;
}

VectorResult with_headroom(VectorResult out, const char* channel, double ratio, std::size_t tick) {
  out.tightest = Headroom{ratio, tick, *find_channel(Module::mc_att_control, channel)};
  return out;
}

// A sign error in the yaw law: the same case fails in the same way at three rates.
void add_attitude(std::vector<VectorResult>& results) {
  const char* yaw = "out/vehicle_rates_setpoint.yaw";
  const Rate slow = Rate::hz(100);
  const Rate fast = Rate::hz(250);
  const Rate odd = Rate::hz(1000, 3);
  results.push_back(with_headroom(passed("attitude", "roll_30", slow),
                                  "out/vehicle_rates_setpoint.roll", 12.34, 17));
  results.push_back(with_headroom(passed("attitude", "roll_30", fast),
                                  "out/actuator_controls_0.control[0]", 40, 3));
  results.push_back(with_headroom(passed("attitude", "roll_30", odd),
                                  "out/mc_att_ctrl_status.roll_rate_integ", 150.5, 499));
  for (const Rate rate : {slow, fast, odd}) {
    results.push_back(
        failing("attitude", "yaw_step", rate, deviation(yaw, 17, -1.5F, 0.3F, 2e-4), 483));
  }
  VectorResult nan_control = result(Verdict::non_finite, "attitude", "zero_thrust", fast, "");
  nan_control.first = deviation("out/actuator_controls_0.control[1]", 0, nan, -0.0625F, 1e-4);
  nan_control.deviating_ticks = 1;
  results.push_back(nan_control);
}

void add_mixed(std::vector<VectorResult>& results) {
  const Rate rate = Rate::hz(250);
  results.push_back(failing(
      "mixed", "a_case_whose_name_is_as_long_as_names_of_cases_get_when_they_say_all_they_check",
      rate, deviation("out/vehicle_rates_setpoint.published", 4, 0, 1, 0), 1));
  results.push_back(failing(
      "mixed", "integral_limit", rate,
      deviation("out/mc_att_ctrl_status.pitch_rate_integ", 120, 0.30002F, 0.3F, 2e-5), 380));
  results.back().worst =
      deviation("out/mc_att_ctrl_status.pitch_rate_integ", 310, 0.3052F, 0.3F, 2e-5);
  results.push_back(result(Verdict::unsupported, "mixed", "rattitude", rate, "the port said so"));
  results.push_back(result(Verdict::unsupported, "mixed", "acro", rate, "the port said so"));
  results.push_back(result(Verdict::skip, "mixed", "on_threshold", rate,
                           "decides on a threshold: exact level only"));
  results.push_back(result(Verdict::skip, "mixed", "on_threshold", Rate::hz(1000, 3),
                           "decides on a threshold: exact level only"));
  VectorResult expected =
      result(Verdict::xfail, "mixed", "yaw_freeze", rate, "known: see <issue 12> & \"friends\"");
  expected.first = deviation("out/actuator_controls_0.control[2]", 9, 0.25F, 0.125F, 1e-4);
  expected.deviating_ticks = 9;
  results.push_back(expected);
  results.push_back(result(Verdict::xpass, "mixed", "yaw_limit", rate, ""));
}

void add_robustness(std::vector<VectorResult>& results) {
  const Rate rate = Rate::hz(3000);
  results.push_back(died(Verdict::crash, "nan_input", rate,
                         "killed by signal 11 (SIGSEGV); last words: </failure>]]><script>alert(1)"
                         "</script> \x1b[2J\x01 \xff and\na second line"));
  results.push_back(died(Verdict::timeout, "inf_input", rate, "no answer within 10 s"));
  results.push_back(died(Verdict::protocol, "denormals", rate, "step() returned 7"));
}

void add_flights(std::vector<VectorResult>& results) {
  const double infinity = std::numeric_limits<double>::infinity();
  VectorResult lost =
      failing("flight", "hover", Rate::hz(250),
              deviation("out/vehicle_rates_setpoint.roll", 20, -1.5F, 0.3F, 2e-4), 3);
  lost.plant_configuration = PlantConfiguration{"iris", PlantKind::mujoco};
  lost.ticks = 40;
  lost.reason = "the flight ended at 1.918 s (tick 480): the body rate is 80 rad/s, beyond 80";
  results.push_back(lost);
  VectorResult slow = result(Verdict::fail, "flight", "hover", Rate::hz(250),
                             "metric levels: settling_time_s is inf, above 2");
  slow.plant_configuration = PlantConfiguration{"hexa", PlantKind::ode};
  slow.metrics = {{"levels", Measure::settling_time_s, infinity, 0.5, 0.05, -infinity, 2},
                  {"rolls", Measure::peak_rate_rad_s, 6.1, 6, 0.3, 5, 9}};
  results.push_back(slow);
}

}  // namespace

VectorResult passed(const std::string& group, const std::string& name, LoopRate rate) {
  VectorResult out;
  out.profile = "px4-v1.5.5";
  out.group = group;
  out.name = name;
  out.rate = rate;
  out.ticks = 500;
  out.elapsed_s = 0.0125;
  return out;
}

Deviation deviation(const char* channel, std::size_t tick, float got, float want,
                    double tolerance) {
  Deviation out;
  out.tick = tick;
  out.timestamp_us = 4000 * tick;
  out.channel = *find_channel(Module::mc_att_control, channel);
  out.got = static_cast<double>(got);
  out.want = static_cast<double>(want);
  out.tolerance = tolerance;
  const bool same_sign = std::isfinite(got) && (got < 0) == (want < 0);
  if (same_sign && channels()[out.channel].type == ChannelType::f32) {
    out.ulp = std::abs(std::bit_cast<std::int32_t>(got) - std::bit_cast<std::int32_t>(want));
  }
  return out;
}

RunResult sample_run() {
  RunResult run;
  run.attest_version = "0.1.0";
  run.port = "lib:./it's mine.so";
  run.port_name = "acme <fc> & \x1b[31mco";
  run.port_version = "1.2-\"rc\"";
  run.port_modules = only(Module::mc_att_control);
  run.level = Level::numeric;
  run.rates = {Rate::hz(100), Rate::hz(250), Rate::hz(1000, 3), Rate::hz(3000)};
  for (const char* group : {"attitude", "flight", "mixed", "robustness", "tpa"}) {
    run.suite[std::string("px4-v1.5.5/") + group][Rate::hz(250)] = 2;
  }
  run.suite_sha256 = std::string(64, 'a');
  run.port_sha256 = std::string(64, 'b');
  run.date = "2026-03-31";
  run.limits = {true, 10, 4, 16, {true, true}};
  run.cases_version = "1.0";
  run.golden_version = "1.1";
  add_attitude(run.results);
  add_mixed(run.results);
  add_robustness(run.results);
  add_flights(run.results);
  for (const VectorResult& result : run.results) {
    run.case_files[result.case_id()] = "cases/" + result.case_id() + ".toml";
    run.golden_files[result.case_id()] = "golden/" + result.case_id() + ".csv";
  }
  run.selected = run.results.size() + 1;  // one has an error instead
  run.errors = {Error{"row 4 has 21 columns, expected 22",
                      "golden/px4-v1.5.5/mixed/take_off/250hz.csv", 4, 0},
                Error{"cannot fork: <out of memory>", "", 0, 0}};
  run.stopped_early = true;
  return run;
}

RunResult passing_run() {
  RunResult run;
  run.attest_version = "0.1.0";
  run.port = "builtin";
  run.port_name = "reference";
  run.port_version = "0.1.0";
  run.port_modules = only(Module::mc_att_control);
  run.level = Level::exact;
  run.rates = {Rate::hz(50), Rate::hz(250)};
  for (const char* name : {"pitch_5", "roll_30", "yaw_step"}) {
    for (const LoopRate& rate : run.rates) {
      run.results.push_back(passed("attitude", name, rate));
      const std::string id = run.results.back().case_id();
      run.case_files[id] = "cases/" + id + ".toml";
      run.golden_files[id] = "golden/" + id + ".csv";
      ++run.suite["px4-v1.5.5/attitude"][rate];
    }
  }
  run.selected = run.results.size();
  run.suite_sha256 = std::string(64, 'a');
  run.suite_is_released = true;
  run.date = "2026-03-31";
  run.limits = {true, 10, 4, 16, {true, true}};
  return run;
}

Flown two_level_ticks() {
  Flown flown;
  Trace& trace = flown.trace;
  trace.present = channels_of(Module::mc_att_control);
  trace.samples.resize(2);
  trace.samples[1].in.timestamp = 4000;
  trace.plant.resize(2);
  for (PlantSample& sample : trace.plant) sample.q = {1, 0, 0, 0};
  return flown;
}

}  // namespace attest
