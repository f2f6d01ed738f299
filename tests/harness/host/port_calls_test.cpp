// The note of the running call: written around each call of a port, in whichever module.
#include "harness/host/port_calls.hpp"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "harness/port/builtin.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

const std::string mixer = "R: 4x 10000 10000 10000 0";

// A controller that calls back in each of its functions.
class CallingUnit final : public UnitOf<attest_inputs, attest_outputs> {
 public:
  explicit CallingUnit(const std::function<void()>& call) : call_(call) {}
  ~CallingUnit() override { call_(); }
  int set_parameter(const std::string&, float) override { return called(); }
  int set_timestamp_sample(std::uint64_t) override { return called(); }
  int step(const attest_inputs&, attest_outputs&) override { return called(); }

 private:
  int called() {
    call_();
    return ATTEST_OK;
  }
  const std::function<void()>& call_;
};

class CallingPort final : public Port {
 public:
  explicit CallingPort(const std::function<void()>& call) : call_(call) {}
  std::string name() const override { return "calling"; }
  std::string version() const override { return "1"; }
  std::unique_ptr<Unit> create_unit(Module, const std::string&, const std::string&) override {
    call_();
    return std::make_unique<CallingUnit>(call_);
  }

 private:
  const std::function<void()>& call_;
};

TEST(PortCalls, TheRunningCallIsNamed) {
  const auto calls = PortCalls::make();
  ASSERT_TRUE(calls) << calls.error().to_string();
  std::string seen;
  const std::function<void()> look = [&] { seen = calls->current(); };
  CallingPort original(look);
  const auto port = calls->noted(original);
  EXPECT_EQ(calls->current(), "");
  auto unit = port->create("px4-v1.5.5");
  EXPECT_EQ(seen, " in create()");
  EXPECT_EQ(calls->current(), "");
  attest_outputs out{};
  for (const char* expected : {" in step() at tick 0", " in step() at tick 1"}) {
    EXPECT_EQ(unit->step(attest_inputs{}, out), ATTEST_OK);
    EXPECT_EQ(seen, expected);
  }
  EXPECT_EQ(unit->set_parameter("MC_ROLL_P", 6), ATTEST_OK);
  EXPECT_EQ(seen, " in set_parameter()");
  EXPECT_EQ(unit->set_timestamp_sample(7), ATTEST_OK);
  EXPECT_EQ(seen, " in set_timestamp_sample()");
  unit.reset();
  EXPECT_EQ(seen, " in destroy()");
  EXPECT_EQ(calls->current(), "");
}

// The call in which the process before has crashed.
TEST(PortCalls, AfterAResetNoCallRuns) {
  const auto calls = PortCalls::make();
  ASSERT_TRUE(calls) << calls.error().to_string();
  std::string seen = "not called";
  const std::function<void()> reset = [&] {
    calls->reset();
    seen = calls->current();
  };
  CallingPort original(reset);
  calls->noted(original)->create("px4-v1.5.5");
  EXPECT_EQ(seen, "");
  EXPECT_EQ(calls->count(), 0u);
}

TEST(PortCalls, EachInstanceCountsItsOwnTicks) {
  const auto calls = PortCalls::make();
  ASSERT_TRUE(calls);
  std::string seen;
  const std::function<void()> look = [&] { seen = calls->current(); };
  CallingPort original(look);
  const auto port = calls->noted(original);
  const auto one = port->create(""), other = port->create("");
  attest_outputs out{};
  one->step(attest_inputs{}, out);
  one->step(attest_inputs{}, out);
  EXPECT_EQ(seen, " in step() at tick 1");
  other->step(attest_inputs{}, out);
  EXPECT_EQ(seen, " in step() at tick 0");
}

// In a live flight of the cascade.
TEST(PortCalls, TwoUnitsMayRunAtTheSameTime) {
  const auto calls = PortCalls::make();
  ASSERT_TRUE(calls);
  std::string seen;
  const std::function<void()> look = [&] { seen = calls->current(); };
  CallingPort of_attitude(look);
  const auto attitude_port = calls->noted(of_attitude);
  const auto attitude = attitude_port->create_unit(Module::attitude_unit, "", "");
  attest_outputs out{};
  attitude->step(attest_inputs{}, out);
  EXPECT_EQ(seen, " in step() at tick 0 of the attitude unit");
  const std::function<void()> step_the_other = [&] { attitude->step(attest_inputs{}, out); };
  CallingPort of_rate(step_the_other);
  const auto rate_port = calls->noted(of_rate);
  const auto rate = rate_port->create_unit(Module::rate_unit, "", "");
  rate->step(attest_inputs{}, out);
  EXPECT_EQ(seen, " in step() at tick 0 or in step() at tick 2 of the attitude unit");
  EXPECT_EQ(calls->current(), "");
}

// Has other values than the defaults of Port, and no module.
class DeclaringPort final : public Port {
 public:
  std::string name() const override { return "declaring"; }
  std::string version() const override { return "2"; }
  std::vector<std::string> unsupported_groups() const override { return {"rates"}; }
  std::optional<int> fraction_bits() const override { return 24; }
  std::optional<Rate> fixed_step() const override { return Rate::hz(250); }
  std::unique_ptr<Unit> create_unit(Module, const std::string&, const std::string&) override {
    return nullptr;
  }
};

TEST(PortCalls, TheNotedPortIsThePort) {
  const auto calls = PortCalls::make();
  ASSERT_TRUE(calls);
  DeclaringPort original;
  const auto port = calls->noted(original);
  EXPECT_EQ(port->name(), "declaring");
  EXPECT_EQ(port->version(), "2");
  EXPECT_EQ(port->unsupported_groups(), std::vector<std::string>{"rates"});
  EXPECT_EQ(port->fraction_bits(), 24);
  EXPECT_EQ(port->fixed_step(), Rate::hz(250));
  EXPECT_EQ(port->modules(), only(Module::mc_att_control));
  EXPECT_EQ(port->create("px4-v1.5.5"), nullptr);
  EXPECT_EQ(calls->current(), "");
  const auto builtin = open_builtin();
  const auto whole = calls->noted(*builtin);
  for (const ModuleInfo& info : modules()) {
    const auto all = known_profiles();
    const auto profile = std::find_if(all.begin(), all.end(), [&](const ProfileInfo& one) {
      return contains(one.modules, info.module);
    });
    ASSERT_NE(profile, all.end()) << info.name;
    const std::string name(profile->name);
    EXPECT_NE(whole->create_unit(info.module, name, mixer), nullptr) << info.name;
  }
}

}  // namespace
}  // namespace attest
