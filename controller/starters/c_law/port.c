/* SPDX-License-Identifier: BSD-3-Clause */
#include "law.h"
#include "law_port.h"

static void attitude(const attest_attitude_law_inputs* in, float rates_sp[3]) {
  attitude_law(in->vehicle_attitude.q, in->vehicle_attitude_setpoint.q_d,
               in->vehicle_attitude_setpoint.yaw_sp_move_rate, in->attitude_gains.p,
               in->attitude_gains.rate_max, in->attitude_gains.yaw_weight, rates_sp);
}

static void rate(const attest_rate_law_inputs* in, float integral[3], float torque[3]) {
  const rate_gains gains = {in->rate_gains.p, in->rate_gains.i, in->rate_gains.d, in->rate_gains.ff,
                            in->rate_gains.integral_max};
  const float rates_sp[3] = {in->vehicle_rates_setpoint.roll, in->vehicle_rates_setpoint.pitch,
                             in->vehicle_rates_setpoint.yaw};
  rate_law(&gains, in->vehicle_angular_velocity.xyz, in->vehicle_angular_velocity.xyz_derivative,
           rates_sp, in->saturation.positive, in->saturation.negative, in->law.landed, in->law.dt,
           integral, torque);
}

/* The attitude law of v1.18 has a reference model. */
LAW_PORT("attest-starter-c-law", "px4-v1.14.4 px4-v1.15.4 px4-v1.16.0 px4-v1.17", attitude,
         "px4-v1.14.4 px4-v1.15.4 px4-v1.16.0 px4-v1.17 px4-v1.18", rate)
