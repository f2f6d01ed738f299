/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * law.h - the attitude law of PX4 v1.14 to v1.17, and the rate law of v1.14 to v1.18.
 *
 * World is NED, body is FRD. Quaternions are {w, x, y, z}, body to world. Vectors are about body
 * x, y, z: roll, pitch, yaw.
 */
#ifndef LAW_H
#define LAW_H

#include <stdbool.h>
#include <stdint.h>

/* From the attitude q and its setpoint q_d, of any norm, to rates_sp [rad/s]. yaw_rate [rad/s] is
 * about the world's z, and is added to the result. It is ignored if it is not finite. p is in 1/s,
 * rate_max in rad/s. yaw_weight (0 .. 1) says how much yaw counts compared with roll and pitch. */
void attitude_law(const float q[4], const float q_d[4], float yaw_rate, const float p[3],
                  const float rate_max[3], float yaw_weight, float rates_sp[3]);

typedef struct rate_gains {
  const float *p, *i, *d, *ff, *integral_max; /* each of three: roll, pitch, yaw */
} rate_gains;

/* From the rates [rad/s], their derivative [rad/s^2] and their setpoint to the torque. positive and
 * negative are flags: the motors cannot give more torque about that axis in that direction.
 * integral is the state of the law, 0 at first. It changes only in flight. */
void rate_law(const rate_gains* gains, const float rates[3], const float derivative[3],
              const float rates_sp[3], const uint8_t positive[3], const uint8_t negative[3],
              bool landed, float dt_s, float integral[3], float torque[3]);

#endif /* LAW_H */
