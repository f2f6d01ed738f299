/* SPDX-License-Identifier: BSD-3-Clause */
// A port in modern C++, written from the description of the law: parameters, one step, the C ABI.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <string>

#include <attest_unit.h>

#include "control.hpp"

namespace {

using mc::Vec3;

class ParameterStore {
 public:
  bool set(const std::string& name, float value) {
    const auto found = values_.find(name);
    if (found == values_.end()) return false;
    found->second = value;
    return true;
  }

  mc::Gains gains() const {
    const float roll = 0.2f / get("MC_ROLL_TC");
    const float pitch = 0.2f / get("MC_PITCH_TC");
    mc::Gains g;
    g.attitude_p = {get("MC_ROLL_P") * roll, get("MC_PITCH_P") * pitch, get("MC_YAW_P")};
    g.rate_p = {get("MC_ROLLRATE_P") * roll, get("MC_PITCHRATE_P") * pitch, get("MC_YAWRATE_P")};
    g.rate_i = {get("MC_ROLLRATE_I"), get("MC_PITCHRATE_I"), get("MC_YAWRATE_I")};
    g.rate_d = {get("MC_ROLLRATE_D") * roll, get("MC_PITCHRATE_D") * pitch, get("MC_YAWRATE_D")};
    g.rate_ff = {get("MC_ROLLRATE_FF"), get("MC_PITCHRATE_FF"), get("MC_YAWRATE_FF")};
    g.rate_max = {rad("MC_ROLLRATE_MAX"), rad("MC_PITCHRATE_MAX"), rad("MC_YAWRATE_MAX")};
    g.auto_rate_max = {g.rate_max[0], g.rate_max[1], rad("MC_YAWRAUTO_MAX")};
    g.acro_rate_max = {rad("MC_ACRO_R_MAX"), rad("MC_ACRO_P_MAX"), rad("MC_ACRO_Y_MAX")};
    g.yaw_ff = get("MC_YAW_FF");
    g.rattitude_threshold = get("MC_RATT_TH");
    g.weather_vane_scale = get("VT_WV_YAWR_SCL");
    g.tpa_break = get("MC_TPA_BREAK");
    g.tpa_slope = get("MC_TPA_SLOPE");
    g.scale_by_battery = get("MC_BAT_SCALE_EN") != 0.0f;
    g.circuit_breaker = static_cast<int>(get("CBRK_RATE_CTRL")) == 140253;
    return g;
  }

  bool tailsitter_recovery() const {
    return get("VT_TYPE") == 0.0f && get("VT_OPT_RECOV_EN") != 0.0f;
  }

 private:
  float get(const char* name) const { return values_.at(name); }
  float rad(const char* name) const { return mc::radians(get(name)); }

  std::map<std::string, float> values_ = {
      {"MC_ROLL_TC", 0.2f},       {"MC_ROLL_P", 6.5f},         {"MC_ROLLRATE_P", 0.15f},
      {"MC_ROLLRATE_I", 0.05f},   {"MC_ROLLRATE_D", 0.003f},   {"MC_ROLLRATE_FF", 0.0f},
      {"MC_PITCH_TC", 0.2f},      {"MC_PITCH_P", 6.5f},        {"MC_PITCHRATE_P", 0.15f},
      {"MC_PITCHRATE_I", 0.05f},  {"MC_PITCHRATE_D", 0.003f},  {"MC_PITCHRATE_FF", 0.0f},
      {"MC_YAW_P", 2.8f},         {"MC_YAWRATE_P", 0.2f},      {"MC_YAWRATE_I", 0.1f},
      {"MC_YAWRATE_D", 0.0f},     {"MC_YAWRATE_FF", 0.0f},     {"MC_YAW_FF", 0.5f},
      {"MC_ROLLRATE_MAX", 220.f}, {"MC_PITCHRATE_MAX", 220.f}, {"MC_YAWRATE_MAX", 200.f},
      {"MC_YAWRAUTO_MAX", 45.0f}, {"MC_ACRO_R_MAX", 360.0f},   {"MC_ACRO_P_MAX", 360.0f},
      {"MC_ACRO_Y_MAX", 360.0f},  {"MC_RATT_TH", 1.0f},        {"MC_TPA_BREAK", 1.0f},
      {"MC_TPA_SLOPE", 1.0f},     {"MC_BAT_SCALE_EN", 0.0f},   {"VT_WV_YAWR_SCL", 0.15f},
      {"VT_TYPE", 0.0f},          {"VT_OPT_RECOV_EN", 0.0f},   {"CBRK_RATE_CTRL", 0.0f},
  };
};

// A topic: the copy in use, and the sample that was not taken yet.
template <typename T>
struct Subscription {
  T copy{};
  std::optional<T> pending;

  void receive(const attest_inputs& in, uint32_t bit, const T& sample) {
    if (in.updated & bit) pending = sample;
  }
  void latch() {
    if (pending) copy = *pending;
    pending.reset();
  }
};

class Controller {
 public:
  explicit Controller(mc::Law law) : law_(law), attitude_(law), rate_(law) {
    status_.copy.is_rotary_wing = 1;
  }

  bool set_parameter(const char* name, float value) { return parameters_.set(name, value); }
  void step(const attest_inputs& in, attest_outputs& out);

 private:
  void receive(const attest_inputs& in);
  void outer_loop(attest_outputs& out);
  void attitude_loop();
  void acro();
  void publish_rates_setpoint(attest_outputs& out);
  void publish_controls(const Vec3& u, attest_outputs& out) const;

  mc::Law law_;
  ParameterStore parameters_;
  std::optional<mc::Gains> gains_;  // empty before the first step
  mc::AttitudeControl attitude_;
  std::optional<mc::TailsitterRecovery> tailsitter_;
  mc::RateControl rate_;

  Subscription<decltype(attest_inputs::vehicle_attitude_setpoint)> attitude_sp_;
  Subscription<decltype(attest_inputs::vehicle_rates_setpoint)> rates_sp_topic_;
  Subscription<decltype(attest_inputs::manual_control_setpoint)> manual_;
  Subscription<decltype(attest_inputs::battery_status)> battery_;
  Subscription<decltype(attest_inputs::vehicle_control_mode)> mode_;
  Subscription<decltype(attest_inputs::actuator_armed)> armed_;
  Subscription<decltype(attest_inputs::vehicle_status)> status_;
  Subscription<decltype(attest_inputs::multirotor_motor_limits)> limits_;
  std::optional<bool> virtual_topics_;  // decided by the first vehicle_status

  uint64_t last_ = 0;
  mc::Quat q_;
  Vec3 rates_, rates_sp_;
  float thrust_sp_ = 0.0f;
};

void Controller::receive(const attest_inputs& in) {
  q_ = mc::Quat(in.control_state.q);
  rates_ = {in.control_state.roll_rate, in.control_state.pitch_rate, in.control_state.yaw_rate};
  attitude_sp_.receive(in, ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT, in.vehicle_attitude_setpoint);
  rates_sp_topic_.receive(in, ATTEST_UPDATED_VEHICLE_RATES_SETPOINT, in.vehicle_rates_setpoint);
  manual_.receive(in, ATTEST_UPDATED_MANUAL_CONTROL_SETPOINT, in.manual_control_setpoint);
  battery_.receive(in, ATTEST_UPDATED_BATTERY_STATUS, in.battery_status);
  mode_.receive(in, ATTEST_UPDATED_VEHICLE_CONTROL_MODE, in.vehicle_control_mode);
  armed_.receive(in, ATTEST_UPDATED_ACTUATOR_ARMED, in.actuator_armed);
  status_.receive(in, ATTEST_UPDATED_VEHICLE_STATUS, in.vehicle_status);
  limits_.receive(in, ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS, in.multirotor_motor_limits);
  if (status_.pending && !virtual_topics_) virtual_topics_ = status_.pending->is_vtol != 0;
  manual_.latch();
  battery_.latch();
  mode_.latch();
  armed_.latch();
  status_.latch();
  limits_.latch();
  if (!gains_ && parameters_.tailsitter_recovery()) tailsitter_.emplace();
  if (!gains_ || (in.updated & ATTEST_UPDATED_PARAMETER_UPDATE)) gains_ = parameters_.gains();
}

void Controller::attitude_loop() {
  attitude_sp_.latch();
  const auto& sp = attitude_sp_.copy;
  const auto& mode = mode_.copy;
  const bool autonomous = !mode.flag_control_manual_enabled &&
                          (mode.flag_control_velocity_enabled ||
                           (law_ == mc::Law::v1_5_5 && mode.flag_control_auto_enabled));
  mc::AttitudeDemand demand;
  demand.q = q_;
  demand.q_sp = mc::Quat(sp.q_d);
  demand.yaw_rate_feed_forward = sp.yaw_sp_move_rate;
  demand.use_auto_limit = autonomous;
  demand.weather_vane = autonomous && sp.disable_mc_yaw_control;
  if (tailsitter_) {
    rates_sp_ = tailsitter_->update(demand, *gains_);
  } else {
    rates_sp_ = attitude_.update(demand, *gains_);
    if (demand.weather_vane) rate_.reset_yaw_integral();
  }
  thrust_sp_ = sp.thrust;
}

void Controller::acro() {
  const auto& stick = manual_.copy;
  rates_sp_ = Vec3(stick.y, -stick.x, stick.r).emult(gains_->acro_rate_max);
  thrust_sp_ = stick.z < 0.9f ? stick.z : 0.9f;
}

void Controller::publish_rates_setpoint(attest_outputs& out) {
  rates_sp_topic_.copy = {rates_sp_[0], rates_sp_[1], rates_sp_[2], thrust_sp_};
  if (!virtual_topics_) return;
  // The topic holds one sample: ours replaces one from outside, unless ours goes elsewhere.
  if (!*virtual_topics_) rates_sp_topic_.pending.reset();
  out.vehicle_rates_setpoint = {rates_sp_[0], rates_sp_[1], rates_sp_[2], thrust_sp_, 1};
}

void Controller::outer_loop(attest_outputs& out) {
  auto& mode = mode_.copy;
  if (mode.flag_control_rattitude_enabled &&
      (std::fabs(manual_.copy.y) > gains_->rattitude_threshold ||
       std::fabs(manual_.copy.x) > gains_->rattitude_threshold)) {
    mode.flag_control_attitude_enabled = 0;
  }
  if (mode.flag_control_attitude_enabled) {
    attitude_loop();
    publish_rates_setpoint(out);
  } else if (mode.flag_control_manual_enabled) {
    acro();
    publish_rates_setpoint(out);
  } else {
    rates_sp_topic_.latch();
    const auto& sp = rates_sp_topic_.copy;
    rates_sp_ = {sp.roll, sp.pitch, sp.yaw};
    thrust_sp_ = sp.thrust;
  }
}

void Controller::publish_controls(const Vec3& u, attest_outputs& out) const {
  if (gains_->circuit_breaker || !virtual_topics_) return;
  auto& control = out.actuator_controls_0.control;
  std::fill(std::begin(control), std::end(control), 0.0f);
  for (std::size_t i = 0; i < 3; ++i) control[i] = std::isfinite(u[i]) ? u[i] : 0.0f;
  control[3] = std::isfinite(thrust_sp_) ? thrust_sp_ : 0.0f;
  if (law_ == mc::Law::v1_5_5) {
    control[7] = attitude_sp_.copy.landing_gear;
    if (gains_->scale_by_battery && battery_.copy.scale > 0.0f) {
      for (std::size_t i = 0; i < 4; ++i) control[i] *= battery_.copy.scale;
    }
  }
  out.actuator_controls_0.published = 1;
}

void Controller::step(const attest_inputs& in, attest_outputs& out) {
  const float dt = mc::clamp(static_cast<float>(in.timestamp - last_) / 1000000.0f, 0.002f, 0.02f);
  last_ = in.timestamp;
  out.vehicle_rates_setpoint.published = 0;
  out.actuator_controls_0.published = 0;
  out.mc_att_ctrl_status.published = 0;

  receive(in);
  outer_loop(out);
  if (!mode_.copy.flag_control_rates_enabled) return;

  if (!armed_.copy.armed || !status_.copy.is_rotary_wing) rate_.reset_integral();
  mc::RateDemand demand;
  demand.rates_sp = rates_sp_;
  demand.rates = rates_;
  demand.thrust_sp = thrust_sp_;
  demand.thrust_for_tpa = rates_sp_topic_.copy.thrust;
  demand.may_integrate = !limits_.copy.lower_limit && !limits_.copy.upper_limit;
  demand.yaw_saturated = limits_.copy.yaw != 0;
  const Vec3 u = rate_.update(demand, *gains_, dt);
  publish_controls(u, out);
  const Vec3& integral = rate_.integral();
  out.mc_att_ctrl_status = {integral[0], integral[1], integral[2], 1};
}

// ---- the C ABI ----------------------------------------------------------------------------------

void* create(const char* profile) {
  const std::string name(profile);
  if (name == "px4-v1.5.5") return new (std::nothrow) Controller(mc::Law::v1_5_5);
  if (name == "px4-v1.3.4") return new (std::nothrow) Controller(mc::Law::v1_3_4);
  return nullptr;
}

void destroy(void* self) { delete static_cast<Controller*>(self); }

int set_parameter(void* self, const char* name, float value) {
  return static_cast<Controller*>(self)->set_parameter(name, value) ? ATTEST_OK : ATTEST_INVALID;
}

int step(void* self, const attest_inputs* in, attest_outputs* out) {
  static_cast<Controller*>(self)->step(*in, *out);
  return ATTEST_OK;
}

}  // namespace

const attest_unit* attest_unit_v1() {
  static const attest_unit unit = {ATTEST_UNIT_ABI_VERSION, "cpp-style", "1.0",  create, destroy,
                                   set_parameter,           step,        nullptr};
  return &unit;
}
