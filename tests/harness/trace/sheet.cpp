#include "tests/harness/trace/sheet.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace attest {
namespace {

constexpr std::string_view recorded_header =
    "timestamp,in/control_state.q[0],in/control_state.q[1],in/control_state.q[2],"
    "in/control_state.q[3],in/control_state.roll_rate,in/control_state.pitch_rate,"
    "in/control_state.yaw_rate,in/vehicle_attitude_setpoint.q_d[0],"
    "in/vehicle_attitude_setpoint.q_d[1],in/vehicle_attitude_setpoint.q_d[2],"
    "in/vehicle_attitude_setpoint.q_d[3],in/vehicle_attitude_setpoint.thrust,"
    "in/vehicle_attitude_setpoint.yaw_sp_move_rate,"
    "in/vehicle_attitude_setpoint.disable_mc_yaw_control,"
    "in/vehicle_attitude_setpoint.landing_gear,in/vehicle_rates_setpoint.roll,"
    "in/vehicle_rates_setpoint.pitch,in/vehicle_rates_setpoint.yaw,"
    "in/vehicle_rates_setpoint.thrust,in/manual_control_setpoint.x,in/manual_control_setpoint.y,"
    "in/manual_control_setpoint.z,in/manual_control_setpoint.r,"
    "in/vehicle_control_mode.flag_control_manual_enabled,"
    "in/vehicle_control_mode.flag_control_auto_enabled,"
    "in/vehicle_control_mode.flag_control_rates_enabled,"
    "in/vehicle_control_mode.flag_control_attitude_enabled,"
    "in/vehicle_control_mode.flag_control_rattitude_enabled,"
    "in/vehicle_control_mode.flag_control_velocity_enabled,in/actuator_armed.armed,"
    "in/vehicle_status.is_rotary_wing,in/vehicle_status.is_vtol,"
    "in/multirotor_motor_limits.lower_limit,in/multirotor_motor_limits.upper_limit,"
    "in/multirotor_motor_limits.yaw,in/battery_status.scale,in/updated.vehicle_attitude_setpoint,"
    "in/updated.vehicle_rates_setpoint,in/updated.manual_control_setpoint,"
    "in/updated.vehicle_control_mode,in/updated.actuator_armed,in/updated.vehicle_status,"
    "in/updated.multirotor_motor_limits,in/updated.battery_status,in/updated.parameter_update,"
    "out/vehicle_rates_setpoint.published,out/vehicle_rates_setpoint.roll,"
    "out/vehicle_rates_setpoint.pitch,out/vehicle_rates_setpoint.yaw,"
    "out/vehicle_rates_setpoint.thrust,out/actuator_controls_0.published,"
    "out/actuator_controls_0.control[0],out/actuator_controls_0.control[1],"
    "out/actuator_controls_0.control[2],out/actuator_controls_0.control[3],"
    "out/actuator_controls_0.control[7],out/mc_att_ctrl_status.published,"
    "out/mc_att_ctrl_status.roll_rate_integ,out/mc_att_ctrl_status.pitch_rate_integ,"
    "out/mc_att_ctrl_status.yaw_rate_integ\n";

constexpr std::string_view recorded_rows =
    "5004000,0.9999995,-0.00081530656,-0.0005338745,-0.00015369857,-0.40765333,-0.2669373,"
    "-0.0768493,1,0,0,0,0.5,0,0,0,0,0,0,0.4,0,0,0.5,0,1,0,1,1,0,0,1,1,0,0,0,0,1,1,1,1,1,1,1,1,1,"
    "1,1,0.010597921,0.00694199931,0.000860702363,0.5,1,0.123885691,0.0811224878,0.0155420005,0.5,"
    "0,1,0.000418251264,0.000273879297,0.000155419999\n"
    "5008000,0.99999714,-0.002289135,-0.00068802544,-0.00024756105,-0.7369283,-0.07715109,"
    "-0.046600837,1,0,0,0,0.5,0,0,0,0,0,0,0.4,0,0,0.5,0,1,0,1,1,0,0,1,1,0,0,0,0,1,0,0,0,0,0,0,0,0,"
    "0,1,0.0297565702,0.00895170588,0.00138637889,0.5,1,0.362377167,-0.129150331,0.00975286309,"
    "0.5,0,1,0.000418251264,0.000291099859,0.000174614892\n"
    "5012000,0.99999386,-0.0034575844,-0.0003943049,-0.00039203305,-0.584313,0.14687948,"
    "-0.07149808,1,0,0,0,0.5,0,0,0,0,0,0,0.4,0,0,0.5,0,1,0,1,1,0,0,1,1,0,0,0,0,1,0,0,0,0,0,0,0,0,"
    "0,1,0.0449466743,0.00514359493,0.00219538645,0.5,1,-0.0196542684,-0.188992217,0.0149133084,"
    "0.5,0,1,0.000544103212,0.00026275267,0.000204092285\n";

std::uint64_t canonical_bits(double value) {
  return std::isnan(value) ? ~std::uint64_t{0} : std::bit_cast<std::uint64_t>(value);
}

}  // namespace

Sheet Sheet::recorded() { return Sheet(std::string(recorded_header).append(recorded_rows)); }

Sheet::Sheet(std::string_view text) {
  rows_.emplace_back(1);
  for (const char c : text) {
    if (c == '\n') {
      rows_.emplace_back(1);
    } else if (c == ',') {
      rows_.back().emplace_back();
    } else {
      rows_.back().back() += c;
    }
  }
  rows_.pop_back();
}

std::string& Sheet::cell(std::size_t row, std::string_view column) {
  return rows_.at(row).at(index(column));
}

int Sheet::place(std::size_t row, std::string_view column) const {
  std::size_t place = 1;
  for (std::size_t i = 0; i < index(column); ++i) place += rows_.at(row).at(i).size() + 1;
  return static_cast<int>(place);
}

void Sheet::remove(std::string_view column) {
  const auto at = static_cast<std::ptrdiff_t>(index(column));
  for (std::vector<std::string>& row : rows_) row.erase(row.begin() + at);
}

void Sheet::add(std::string_view column, const std::vector<std::string>& cells) {
  rows_.at(0).emplace_back(column);
  for (std::size_t i = 1; i < rows_.size(); ++i) rows_[i].push_back(cells.at(i - 1));
}

std::string Sheet::text() const {
  std::string text;
  for (const std::vector<std::string>& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i == 0 ? "" : ",") + row[i];
    text += '\n';
  }
  return text;
}

std::size_t Sheet::index(std::string_view column) const {
  const auto found = std::find(rows_.front().begin(), rows_.front().end(), column);
  if (found == rows_.front().end()) std::abort();
  return static_cast<std::size_t>(found - rows_.front().begin());
}

bool same_samples(const Trace& a, const Trace& b) {
  if (a.samples.size() != b.samples.size()) return false;
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    for (std::size_t c = 0; c < channels().size(); ++c) {
      if (!a.present[c] && !b.present[c]) continue;
      const double in_a = value_of(channels()[c], a.samples[i]);
      const double in_b = value_of(channels()[c], b.samples[i]);
      if (canonical_bits(in_a) != canonical_bits(in_b)) return false;
    }
  }
  return true;
}

}  // namespace attest
