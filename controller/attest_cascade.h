/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * attest_cascade.h - the C ABI of the two units of PX4 v1.14 to v1.18: the attitude unit, which
 * computes a rates setpoint from the attitude, and the rate unit, which computes torque from rates.
 *
 * Each unit is an extension of attest_unit.h, a table of functions that a port returns from its
 * extension(). A port may have one unit or both. If it has no controller of attest_unit.h, it may
 * leave create, destroy, set_parameter and step of its attest_unit NULL. Compiles as C11 and as
 * C++17.
 *
 * The host (attest) steps the attitude unit once for each vehicle_attitude sample, and the rate
 * unit once for each vehicle_angular_velocity sample, each at its own rate. The units share nothing
 * but the topic vehicle_rates_setpoint, which the host carries from one to the other.
 *
 * What attest_unit.h says of frames, threads, memory, parameters, results, `updated` and
 * `published` holds here too. One more rule holds for time: `timestamp` is when the step runs, and
 * increases from step to step. It is the only clock. Timestamps inside topics are data: they may be
 * equal to `timestamp` or older. In the group `robustness` they may have any value.
 *
 * Initial values: before the first sample of a topic, the unit uses the value that the comment of a
 * field gives as "initially ...". Such a field usually is 0 until then, so the unit must not read
 * it.
 *
 * Own publications: a setpoint that a unit publishes is also an input of that unit, as in the
 * firmware. The host does not pass it back, so the unit keeps it. The attitude unit in stabilized
 * mode publishes vehicle_attitude_setpoint; the rate unit in acro mode publishes
 * vehicle_rates_setpoint. The unit keeps this setpoint as the newest sample of that topic. It
 * replaces an external sample that the unit has not used yet. At its first use it counts as new.
 * In the firmware this holds for multicopters only. Since v1.15 the attitude unit of a VTOL
 * publishes mc_virtual_attitude_setpoint and reads vehicle_attitude_setpoint, so its own setpoint
 * comes back later, through another module. The host has no such module: under attest the attitude
 * unit of a VTOL keeps its own setpoint, too.
 *
 * Parameters: create() comes before set_parameter(), so the unit reads its parameters no earlier
 * than at its first step. Those set before the first step hold from the start: initial values that
 * depend on a parameter have its value. The firmware of v1.14 to v1.18 checks parameter_update at
 * most once a second. The host passes it in the next step, and the port must read the parameters in
 * that step. In the vehicle a port may do either: a change then takes effect at another time.
 *
 * Bits: an output has the bits of the firmware only if the compiler does not fuse multiplications
 * and additions (-ffp-contract=off).
 *
 * Profiles: the comment of a field says which profiles read it, if not all do.
 */
#ifndef ATTEST_CASCADE_H
#define ATTEST_CASCADE_H

#include "attest_unit.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the attitude unit -----------------------------------------------------------------------*/

#define ATTEST_EXTENSION_ATTITUDE_UNIT "attest.attitude_unit.v1" /* const attest_attitude_unit* */

enum {
  ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT = 1 << 0,
  ATTEST_ATTITUDE_UPDATED_MANUAL_CONTROL_SETPOINT = 1 << 1,
  ATTEST_ATTITUDE_UPDATED_VEHICLE_CONTROL_MODE = 1 << 2,
  ATTEST_ATTITUDE_UPDATED_VEHICLE_STATUS = 1 << 3,
  ATTEST_ATTITUDE_UPDATED_VEHICLE_LAND_DETECTED = 1 << 4,
  ATTEST_ATTITUDE_UPDATED_VEHICLE_LOCAL_POSITION = 1 << 5,
  ATTEST_ATTITUDE_UPDATED_HOVER_THRUST_ESTIMATE = 1 << 6,
  ATTEST_ATTITUDE_UPDATED_AUTOTUNE_ATTITUDE_CONTROL_STATUS = 1 << 7,
  ATTEST_ATTITUDE_UPDATED_PARAMETER_UPDATE = 1 << 8
};

typedef struct attest_attitude_inputs {
  uint64_t timestamp; /* [us] when this step runs */
  uint32_t updated;   /* ATTEST_ATTITUDE_UPDATED_... bits */
  uint32_t reserved;  /* 0 */

  struct {                      /* topic vehicle_attitude: new in every step, has no bit */
    uint64_t timestamp;         /* [us] when it was published */
    uint64_t timestamp_sample;  /* [us] of the IMU data; the law's dt is its change since the
                                 * previous step, limited to 0.2 .. 20 ms */
    float q[4];                 /* body FRD to world NED */
    float delta_q_reset[4];     /* rotation of the attitude by the estimator's last reset */
    uint8_t quat_reset_counter; /* counts these resets */
  } vehicle_attitude;

  struct {                  /* topic vehicle_attitude_setpoint, external samples only */
    uint64_t timestamp;     /* [us] when it was published; the unit drops a sample that is not
                             * newer than the last one that it used. In px4-v1.18 the time since
                             * that one is also the time step of the reference model */
    float q_d[4];           /* desired attitude, body FRD to world NED */
    float thrust_body[3];   /* [-1..1] along body x, y, z; hover is about {0, 0, -0.5} */
    float yaw_sp_move_rate; /* [rad/s] about world z, fed forward; ignored if not finite */
  } vehicle_attitude_setpoint;

  struct {                  /* topic vehicle_status */
    uint64_t armed_time;    /* [us] when the vehicle was armed; read since px4-v1.15.4 */
    uint8_t armed;          /* flag: arming_state is ARMED; read since px4-v1.15.4 */
    uint8_t is_rotary_wing; /* flag: vehicle_type is ROTARY_WING; initially true */
    uint8_t is_vtol;
    uint8_t in_transition_mode;
    uint8_t is_vtol_tailsitter;
  } vehicle_status;

  struct {              /* topic autotune_attitude_control_status */
    uint64_t timestamp; /* [us] when it was published */
    float rate_sp[3];   /* [rad/s] added to the rates setpoint if `timestamp` is less than 1 s ago
                         * and `state` is 3, 6, 9 or 13; before px4-v1.17 if it is 2, 4, 6 or 10 */
    uint8_t state;
  } autotune_attitude_control_status;

  struct {          /* topic manual_control_setpoint: the sticks, [-1..1] each */
    float roll;     /* positive right */
    float pitch;    /* positive forward, nose down */
    float yaw;      /* positive clockwise seen from above */
    float throttle; /* -1 idle, 1 full */
  } manual_control_setpoint;

  struct {                            /* topic vehicle_local_position */
    float unaided_heading;            /* [rad] from gyros alone; used if finite; initially NaN;
                                       * read since px4-v1.16.0 */
    uint8_t heading_good_for_control; /* flag; initially true; not read in px4-v1.18 */
  } vehicle_local_position;

  struct {              /* topic hover_thrust_estimate, read since px4-v1.16.0 */
    float hover_thrust; /* [0..1] */
    uint8_t valid;
  } hover_thrust_estimate;

  struct { /* topic vehicle_control_mode: flags */
    uint8_t flag_control_manual_enabled;
    uint8_t flag_control_altitude_enabled;
    uint8_t flag_control_velocity_enabled;
    uint8_t flag_control_position_enabled;
    uint8_t flag_control_attitude_enabled;
  } vehicle_control_mode;

  struct {          /* topic vehicle_land_detected */
    uint8_t landed; /* flag; initially true; read since px4-v1.15.4 */
  } vehicle_land_detected;
} attest_attitude_inputs;

typedef struct attest_attitude_outputs {
  struct {                /* topic vehicle_rates_setpoint: result of the attitude law */
    float roll;           /* [rad/s] about body x */
    float pitch;          /* [rad/s] about body y */
    float yaw;            /* [rad/s] about body z */
    float thrust_body[3]; /* [-1..1] thrust_body of the attitude setpoint in use */
    uint8_t published;
  } vehicle_rates_setpoint;

  struct {                  /* topic vehicle_attitude_setpoint: of the sticks, in stabilized mode */
    float q_d[4];           /* body FRD to world NED */
    float thrust_body[3];   /* [-1..1] along body x, y, z */
    float yaw_sp_move_rate; /* [rad/s] about world z */
    uint8_t published;      /* the setpoint's timestamp is that of the step */
  } vehicle_attitude_setpoint;
} attest_attitude_outputs;

typedef struct attest_attitude_unit {
  /* As in attest_unit. `profile` is "px4-v1.14.4", "px4-v1.15.4", "px4-v1.16.0", "px4-v1.17" or
   * "px4-v1.18". */
  void* (*create)(const char* profile);
  void (*destroy)(void* self);
  int (*set_parameter)(void* self, const char* name, float value);
  int (*step)(void* self, const attest_attitude_inputs* in, attest_attitude_outputs* out);
} attest_attitude_unit;

/* ---- the rate unit ---------------------------------------------------------------------------*/

/* The rate unit copies manual_control_setpoint in acro mode only, and battery_status only while
 * MC_BAT_SCALE_EN is not 0. Until then the last sample stays new, as attest_unit.h says of
 * `updated`. */
#define ATTEST_EXTENSION_RATE_UNIT "attest.rate_unit.v1" /* const attest_rate_unit* */

enum {
  ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT = 1 << 0,
  ATTEST_RATE_UPDATED_MANUAL_CONTROL_SETPOINT = 1 << 1,
  ATTEST_RATE_UPDATED_VEHICLE_CONTROL_MODE = 1 << 2,
  ATTEST_RATE_UPDATED_VEHICLE_STATUS = 1 << 3,
  ATTEST_RATE_UPDATED_VEHICLE_LAND_DETECTED = 1 << 4,
  ATTEST_RATE_UPDATED_CONTROL_ALLOCATOR_STATUS = 1 << 5,
  ATTEST_RATE_UPDATED_BATTERY_STATUS = 1 << 6,
  ATTEST_RATE_UPDATED_PARAMETER_UPDATE = 1 << 8 /* same bit in every unit; 1 << 7 is unused */
};

typedef struct attest_rate_inputs {
  uint64_t timestamp; /* [us] when this step runs */
  uint32_t updated;   /* ATTEST_RATE_UPDATED_... bits */
  uint32_t reserved;  /* 0 */

  struct {                     /* topic vehicle_angular_velocity: new in every step, has no bit */
    uint64_t timestamp_sample; /* [us] of the gyro; the law's dt is its change since the
                                * previous step, limited to 0.125 .. 20 ms */
    float xyz[3];              /* [rad/s] about body x, y, z (FRD) */
    float xyz_derivative[3];   /* [rad/s^2] angular acceleration, filtered by the host */
  } vehicle_angular_velocity;

  struct {                /* topic vehicle_rates_setpoint, of the attitude unit or external */
    float roll;           /* [rad/s] about body x; if not finite, the unit uses the measured rate */
    float pitch;          /* [rad/s] about body y, likewise */
    float yaw;            /* [rad/s] about body z, likewise */
    float thrust_body[3]; /* [-1..1] along body x, y, z */
  } vehicle_rates_setpoint;

  struct {          /* topic manual_control_setpoint: the sticks, [-1..1] each */
    float roll;     /* positive right */
    float pitch;    /* positive forward, nose down */
    float yaw;      /* positive clockwise seen from above */
    float throttle; /* -1 idle, 1 full */
  } manual_control_setpoint;

  struct {                            /* topic control_allocator_status */
    float unallocated_torque[3];      /* commanded torque minus torque that the motors give */
    uint8_t torque_setpoint_achieved; /* flag: no axis is saturated; if set, the unit ignores
                                       * unallocated_torque */
  } control_allocator_status;

  struct {             /* topic battery_status */
    float scale;       /* [1] factor on torque and thrust if MC_BAT_SCALE_EN is not 0 */
    uint8_t connected; /* flag */
  } battery_status;

  struct { /* topic vehicle_control_mode: flags */
    uint8_t flag_armed;
    uint8_t flag_control_manual_enabled;
    uint8_t flag_control_attitude_enabled;
    uint8_t flag_control_rates_enabled;
  } vehicle_control_mode;

  struct {                  /* topic vehicle_status */
    uint8_t is_rotary_wing; /* flag: vehicle_type is ROTARY_WING; initially true */
  } vehicle_status;

  struct {                /* topic vehicle_land_detected; both are initially true */
    uint8_t maybe_landed; /* flag */
    uint8_t landed;       /* flag */
  } vehicle_land_detected;
} attest_rate_inputs;

/* The firmware's rate unit also publishes actuator_controls_status, the mean square of the torque
 * over about half a second. The control loop does not read it, so this ABI does not have it. */
typedef struct attest_rate_outputs {
  struct {        /* topic vehicle_torque_setpoint */
    float xyz[3]; /* about body x, y, z (FRD); limited to [-1..1] only by battery scaling */
    uint8_t published;
  } vehicle_torque_setpoint;

  struct {        /* topic vehicle_thrust_setpoint */
    float xyz[3]; /* [-1..1] along body x, y, z (FRD) */
    uint8_t published;
  } vehicle_thrust_setpoint;

  struct { /* topic rate_ctrl_status: the integral parts after this step's update */
    float rollspeed_integ;
    float pitchspeed_integ;
    float yawspeed_integ;
    uint8_t published;
  } rate_ctrl_status;

  struct {                /* topic vehicle_rates_setpoint: of the sticks, in acro mode */
    float roll;           /* [rad/s] about body x */
    float pitch;          /* [rad/s] about body y */
    float yaw;            /* [rad/s] about body z */
    float thrust_body[3]; /* [-1..1] along body x, y, z */
    uint8_t published;
  } vehicle_rates_setpoint;
} attest_rate_outputs;

typedef struct attest_rate_unit {
  /* As in attest_unit. `profile` is "px4-v1.14.4", "px4-v1.15.4", "px4-v1.16.0", "px4-v1.17" or
   * "px4-v1.18". */
  void* (*create)(const char* profile);
  void (*destroy)(void* self);
  int (*set_parameter)(void* self, const char* name, float value);
  int (*step)(void* self, const attest_rate_inputs* in, attest_rate_outputs* out);
} attest_rate_unit;

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

ATTEST_LAYOUT(attest_attitude_inputs, timestamp, 0);
ATTEST_LAYOUT(attest_attitude_inputs, updated, 8);
ATTEST_LAYOUT(attest_attitude_inputs, vehicle_attitude, 16);
ATTEST_LAYOUT(attest_attitude_inputs, vehicle_attitude_setpoint, 72);
ATTEST_LAYOUT(attest_attitude_inputs, vehicle_status, 112);
ATTEST_LAYOUT(attest_attitude_inputs, autotune_attitude_control_status, 128);
ATTEST_LAYOUT(attest_attitude_inputs, manual_control_setpoint, 152);
ATTEST_LAYOUT(attest_attitude_inputs, vehicle_local_position, 168);
ATTEST_LAYOUT(attest_attitude_inputs, hover_thrust_estimate, 176);
ATTEST_LAYOUT(attest_attitude_inputs, vehicle_control_mode, 184);
ATTEST_LAYOUT(attest_attitude_inputs, vehicle_land_detected, 189);
ATTEST_SIZE(attest_attitude_inputs, 192);

ATTEST_LAYOUT(attest_attitude_outputs, vehicle_rates_setpoint, 0);
ATTEST_LAYOUT(attest_attitude_outputs, vehicle_attitude_setpoint, 28);
ATTEST_SIZE(attest_attitude_outputs, 64);

ATTEST_LAYOUT(attest_rate_inputs, timestamp, 0);
ATTEST_LAYOUT(attest_rate_inputs, updated, 8);
ATTEST_LAYOUT(attest_rate_inputs, vehicle_angular_velocity, 16);
ATTEST_LAYOUT(attest_rate_inputs, vehicle_rates_setpoint, 48);
ATTEST_LAYOUT(attest_rate_inputs, manual_control_setpoint, 72);
ATTEST_LAYOUT(attest_rate_inputs, control_allocator_status, 88);
ATTEST_LAYOUT(attest_rate_inputs, battery_status, 104);
ATTEST_LAYOUT(attest_rate_inputs, vehicle_control_mode, 112);
ATTEST_LAYOUT(attest_rate_inputs, vehicle_status, 116);
ATTEST_LAYOUT(attest_rate_inputs, vehicle_land_detected, 117);
ATTEST_SIZE(attest_rate_inputs, 120);

ATTEST_LAYOUT(attest_rate_outputs, vehicle_torque_setpoint, 0);
ATTEST_LAYOUT(attest_rate_outputs, vehicle_thrust_setpoint, 16);
ATTEST_LAYOUT(attest_rate_outputs, rate_ctrl_status, 32);
ATTEST_LAYOUT(attest_rate_outputs, vehicle_rates_setpoint, 48);
ATTEST_SIZE(attest_rate_outputs, 76);

#undef ATTEST_LAYOUT
#undef ATTEST_SIZE

#ifdef __cplusplus
}
#endif

#endif /* ATTEST_CASCADE_H */
