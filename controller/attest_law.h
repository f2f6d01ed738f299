/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * attest_law.h - the two laws alone: from an attitude to rates, and from rates to torque.
 *
 * A port of these two functions needs no topics, no modes, no parameters and no arming: each call
 * gets its gains and limits as inputs. They are two extensions of attest_unit.h, each a table of
 * functions. A port that has no unit leaves create, destroy, set_parameter and step of attest_unit
 * NULL, and returns the tables from its extension(). The rules of attest_unit.h for frames,
 * threads, memory and results hold here too. Compiles as C11 and as C++17.
 *
 * A comment that begins with "v1.5" holds for px4-v1.5.5 and px4-v1.3.4 only, one with "v1.14" for
 * the later profiles only. A law does not read what is only for other profiles. Flags are bytes:
 * zero is false, any other value is true. ATTEST_EXTENSION_FIXED_STEP does not apply: dt is given.
 */
#ifndef ATTEST_LAW_H
#define ATTEST_LAW_H

#include "attest_unit.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the attitude law ------------------------------------------------------------------------*/

#define ATTEST_EXTENSION_ATTITUDE_LAW "attest.attitude_law.v1" /* const attest_attitude_law* */

typedef struct attest_attitude_law_inputs {
  struct {
    float q[4]; /* body to world; in few cases of another norm than 1 */
  } vehicle_attitude;
  struct {
    uint64_t timestamp; /* [us] px4-v1.18 only. The first one above 0 starts the reference model,
                         * a later one moves it, and any other leaves it as it is */
    float q_d[4];       /* of any norm. v1.14: the law makes it 1 */
    float yaw_sp_move_rate; /* [rad/s] v1.5: about body z, added after the limit. v1.14: about the
                             * world's z, added before the limit, ignored if not finite */
  } vehicle_attitude_setpoint;
  struct {                   /* roll, pitch, yaw */
    float p[3];              /* [1/s] v1.14: p[2] before it is divided by the yaw weight */
    float rate_max[3];       /* [rad/s] */
    float yaw_weight;        /* v1.14: the law limits it to 0 .. 1 */
    float yaw_ff;            /* v1.5: MC_YAW_FF */
    float weathervane_scale; /* v1.5: share of rate_max[2] that is left while weathervane is set */
    float ref_w_n;           /* [rad/s] px4-v1.18: MC_REF_W_N; the law raises it to 0.1 */
    float ref_ff;            /* px4-v1.18: MC_REF_FF; the law limits it to 0 .. 1 */
    float ref_ff_max;        /* [rad/s] px4-v1.18: MC_REF_FF_MAX; no limit if it is not above 0 */
  } attitude_gains;
  struct {
    uint8_t weathervane; /* v1.5: flag, the wind may turn the nose */
  } law;
} attest_attitude_law_inputs;

typedef struct attest_attitude_law_outputs {
  struct {
    float roll, pitch, yaw; /* [rad/s] about body x, y, z */
  } vehicle_rates_setpoint;
} attest_attitude_law_outputs;

typedef struct attest_attitude_law {
  /* A law in its first state. Returns NULL if the profile is not supported. */
  void* (*create)(const char* profile);
  void (*destroy)(void* self);
  int (*step)(void* self, const attest_attitude_law_inputs* in, attest_attitude_law_outputs* out);
} attest_attitude_law;

/* ---- the rate law ----------------------------------------------------------------------------*/

#define ATTEST_EXTENSION_RATE_LAW "attest.rate_law.v1" /* const attest_rate_law* */

typedef struct attest_rate_law_inputs {
  struct {
    float xyz[3];            /* [rad/s] */
    float xyz_derivative[3]; /* [rad/s^2] v1.14: the D term acts on it */
  } vehicle_angular_velocity;
  struct {
    float roll, pitch, yaw; /* [rad/s] */
    float thrust;           /* v1.5: 0 .. 1 */
  } vehicle_rates_setpoint;
  struct {             /* of the call before */
    float rates[3];    /* [rad/s] v1.5: the D term acts on the difference */
    float rates_sp[3]; /* [rad/s] px4-v1.3.4: the feed-forward acts on the difference */
  } previous;
  struct { /* roll, pitch, yaw; v1.14: p, i and d times K */
    float p[3], i[3], d[3], ff[3];
    float integral_max[3]; /* v1.14 */
    float tpa_break;       /* px4-v1.5.5: MC_TPA_BREAK and MC_TPA_SLOPE */
    float tpa_slope;
  } rate_gains;
  struct {
    float dt;       /* [s] since the call before; the law does not limit it */
    uint8_t landed; /* v1.14: flag, the integral stands still */
    uint8_t reset;  /* flag: the integral is set to 0 before this call uses it */
  } law;
  struct { /* v1.14: flags, no more torque about that axis in that direction */
    uint8_t positive[3];
    uint8_t negative[3];
  } saturation;
  struct { /* v1.5: flags of the mixer; px4-v1.3.4 does not read yaw */
    uint8_t lower_limit, upper_limit, yaw;
  } multirotor_motor_limits;
} attest_rate_law_inputs;

typedef struct attest_rate_law_outputs {
  struct {
    float xyz[3]; /* not limited, and before the yaw filter of the unit since v1.16 */
  } vehicle_torque_setpoint;
  struct {
    float rollspeed_integ, pitchspeed_integ, yawspeed_integ; /* after this call */
  } rate_ctrl_status;
} attest_rate_law_outputs;

typedef struct attest_rate_law {
  void* (*create)(const char* profile);
  void (*destroy)(void* self);
  int (*step)(void* self, const attest_rate_law_inputs* in, attest_rate_law_outputs* out);
} attest_rate_law;

/* ---- layout, never changed -------------------------------------------------------------------*/

#ifdef __cplusplus
#define ATTEST_LAYOUT(type, field, offset) \
  static_assert(offsetof(type, field) == (offset), "attest ABI layout: " #type "." #field)
#define ATTEST_SIZE(type, size) static_assert(sizeof(type) == (size), "attest ABI size: " #type)
#else
#define ATTEST_LAYOUT(type, field, offset) \
  _Static_assert(offsetof(type, field) == (offset), "attest ABI layout: " #type "." #field)
#define ATTEST_SIZE(type, size) _Static_assert(sizeof(type) == (size), "attest ABI size: " #type)
#endif

ATTEST_LAYOUT(attest_attitude_law_inputs, vehicle_attitude_setpoint, 16);
ATTEST_LAYOUT(attest_attitude_law_inputs, attitude_gains, 48);
ATTEST_LAYOUT(attest_attitude_law_inputs, law, 96);
ATTEST_SIZE(attest_attitude_law_inputs, 104);
ATTEST_SIZE(attest_attitude_law_outputs, 12);
ATTEST_LAYOUT(attest_rate_law_inputs, vehicle_rates_setpoint, 24);
ATTEST_LAYOUT(attest_rate_law_inputs, previous, 40);
ATTEST_LAYOUT(attest_rate_law_inputs, rate_gains, 64);
ATTEST_LAYOUT(attest_rate_law_inputs, law, 132);
ATTEST_LAYOUT(attest_rate_law_inputs, saturation, 140);
ATTEST_LAYOUT(attest_rate_law_inputs, multirotor_motor_limits, 146);
ATTEST_SIZE(attest_rate_law_inputs, 152);
ATTEST_SIZE(attest_rate_law_outputs, 24);

#undef ATTEST_LAYOUT
#undef ATTEST_SIZE

#ifdef __cplusplus
}
#endif

#endif /* ATTEST_LAW_H */
