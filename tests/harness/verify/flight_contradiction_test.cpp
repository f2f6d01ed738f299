// Flights of the reference, of which a test then forges one trace. The forged outputs are right for
// the forged inputs, so a comparison with the reference tick by tick cannot find them.
#include "harness/verify/flight_contradiction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/parse.hpp"
#include "harness/host/in_process_host.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/plant/vehicle_models.hpp"
#include "harness/port/builtin.hpp"

namespace attest {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const std::filesystem::path tree = ATTEST_SOURCE_DIR;
const LoopRate controller_rate(Rate::hz(250));
const LoopRate cascade_rate(Rate::hz(250), Rate::hz(1000));

class AFlight {
 public:
  AFlight(const std::string& case_file, const LoopRate& rate)
      : case_(*parse_case(tree / "cases" / case_file)),
        iris_(*VehicleModel::load(tree / "models", "iris")) {
    case_.duration = {60, Span::In::ticks};
    plan_ = {{rate, PlantConfiguration{"iris", PlantKind::ode}}, flight_timing(case_, rate)};
    flown = *InProcessHost(open_builtin(), {}, course()).fly(plan_);
  }

  std::string contradiction() const { return flight_contradiction(course(), plan_, flown); }

  // Makes the outputs those of the law for the inputs of the trace.
  void answer(Trace& trace) const {
    const ModuleUnderTest subject{case_.profile, module_of(trace.present)};
    EXPECT_FALSE(InProcessHost(open_builtin()).drive(subject, trace));
  }

  Flown flown;

 private:
  Course course() const { return {&case_, iris_.get()}; }

  Case case_;
  std::shared_ptr<const VehicleModel> iris_;
  FlightPlan plan_;
};

AFlight controller() { return {"px4-v1.5.5/flight/tilt_step_30.toml", controller_rate}; }
AFlight cascade() { return {"px4-v1.16.0/flight/sticks.toml", cascade_rate}; }

TEST(FlightContradiction, AFlightOfTheReferenceHasNone) {
  EXPECT_THAT(controller().contradiction(), IsEmpty());
  EXPECT_THAT(cascade().contradiction(), IsEmpty());
}

TEST(FlightContradiction, TheCaseSetsTimesTopicsAndParameters) {
  const auto forged = [](const auto& change) {
    AFlight flight = controller();
    change(flight.flown.trace);
    flight.answer(flight.flown.trace);
    return flight.contradiction();
  };
  EXPECT_THAT(forged([](Trace& trace) { ++trace.samples[7].in.timestamp; }),
              HasSubstr("timestamp at tick 7 of the controller"));
  EXPECT_THAT(
      forged([](Trace& trace) { trace.samples[9].in.vehicle_attitude_setpoint.q_d[1] = 1; }),
      HasSubstr("in/vehicle_attitude_setpoint.q_d[1] at tick 9"));
  EXPECT_THAT(forged([](Trace& trace) {
                trace.samples[8].in.updated ^= ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
              }),
              HasSubstr("an updated bit at tick 8"));
  EXPECT_THAT(forged([](Trace& trace) { trace.parameters[0].value += 1; }),
              HasSubstr("the parameters of the controller"));
  EXPECT_THAT(forged([](Trace& trace) { trace.samples.pop_back(); }), HasSubstr("number of ticks"));
}

TEST(FlightContradiction, TheCaseSetsTopicsOfTheAttitudeUnit) {
  AFlight flight = cascade();
  flight.flown.attitude_trace->samples[5].attitude_in.manual_control_setpoint.roll = 0.7f;
  EXPECT_THAT(flight.contradiction(), HasSubstr("at tick 5 of the attitude unit"));
}

TEST(FlightContradiction, TheRateUnitGetsWhatTheAttitudeUnitSent) {
  AFlight flight = cascade();
  // A port that flew with another estimate, and reports the true one.
  flight.flown.attitude_trace->samples[10].attitude_in.vehicle_attitude.q[1] += 0.1f;
  flight.answer(*flight.flown.attitude_trace);
  // Four ticks of the rate unit are one of the attitude unit, whose setpoint arrives a tick later.
  EXPECT_THAT(flight.contradiction(), HasSubstr("vehicle_rates_setpoint at tick 41 of the rate"));
}

TEST(FlightContradiction, BothUnitsFlyToTheEnd) {
  AFlight shorter = cascade();
  shorter.flown.attitude_trace->samples.pop_back();
  EXPECT_THAT(shorter.contradiction(), HasSubstr("number of ticks"));
  AFlight alone = cascade();
  alone.flown.attitude_trace.reset();
  EXPECT_THAT(alone.contradiction(), HasSubstr("number of ticks"));
}

TEST(FlightContradiction, AFlightThatEndedEarlyHasFewerTicks) {
  AFlight flight = controller();
  flight.flown.trace.samples.resize(20);
  flight.flown.divergence = Divergence{};
  EXPECT_THAT(flight.contradiction(), IsEmpty());
}

}  // namespace
}  // namespace attest
