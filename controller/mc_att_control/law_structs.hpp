// Between the structs of attest_law.h and the laws of every profile: gains in, results out.
#pragma once

#include "controller/attest_law.h"
#include "controller/mc_att_control/ordered.hpp"

namespace attest::mc_att_control {

// Parameters is that of any profile: the names of these parameters are the same in all.
template <typename Parameters>
void set_gains(const decltype(attest_attitude_law_inputs::attitude_gains)& given,
               Parameters& parameters) {
  parameters.mc_roll_p = given.p[0];
  parameters.mc_pitch_p = given.p[1];
  parameters.mc_yaw_p = given.p[2];
}

template <typename Parameters>
void set_gains(const decltype(attest_rate_law_inputs::rate_gains)& given, Parameters& parameters) {
  parameters.mc_rollrate_p = given.p[0];
  parameters.mc_pitchrate_p = given.p[1];
  parameters.mc_yawrate_p = given.p[2];
  parameters.mc_rollrate_i = given.i[0];
  parameters.mc_pitchrate_i = given.i[1];
  parameters.mc_yawrate_i = given.i[2];
  parameters.mc_rollrate_d = given.d[0];
  parameters.mc_pitchrate_d = given.d[1];
  parameters.mc_yawrate_d = given.d[2];
  parameters.mc_rollrate_ff = given.ff[0];
  parameters.mc_pitchrate_ff = given.ff[1];
  parameters.mc_yawrate_ff = given.ff[2];
}

template <typename Scalar>
void write(const Vector3<Scalar>& rates, attest_attitude_law_outputs& out) {
  out.vehicle_rates_setpoint = {static_cast<float>(rates[0]), static_cast<float>(rates[1]),
                                static_cast<float>(rates[2])};
}

template <typename Scalar>
void write(const Vector3<Scalar>& torque, const Vector3<Scalar>& integral,
           attest_rate_law_outputs& out) {
  for (int i = 0; i < 3; ++i) out.vehicle_torque_setpoint.xyz[i] = static_cast<float>(torque[i]);
  out.rate_ctrl_status = {static_cast<float>(integral[0]), static_cast<float>(integral[1]),
                          static_cast<float>(integral[2])};
}

}  // namespace attest::mc_att_control
