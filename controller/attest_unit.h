/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * attest_unit.h - the C ABI of ports that are shared libraries.
 *
 * A port of the multicopter attitude controller that is a shared library exports one symbol,
 * attest_unit_v1(), which returns a table of functions. The author of such a port needs to read
 * this header only. It compiles as C11 and as C++17. Ports that are programs do not need it.
 *
 * Life cycle, in the order in which the host (attest) calls:
 *
 *     unit = attest_unit_v1();
 *     unit->extension(id);                              any id, any number of times
 *     self = unit->create("px4-v1.5.5");
 *     unit->set_parameter(self, "MC_ROLL_P", 6.5f);     any number of times
 *     for each control_state sample:
 *         unit->set_parameter(...)                      only before a step that has
 *                                                       ATTEST_UPDATED_PARAMETER_UPDATE set
 *         unit->step(self, &in, &out);
 *     unit->destroy(self);
 *
 * Frames: world is NED, body is FRD. Quaternions are Hamilton, scalar first {w, x, y, z}, and
 * rotate body into world: v_NED = R(q) v_FRD. Angles are in rad, rates in rad/s; some parameters
 * are in degrees. Names are those of the PX4 topics and fields that carry the signal.
 *
 * Time: `timestamp` is the only clock. A unit must not read another one.
 *
 * Threads: attest_unit_v1() is called once. The host calls extension() from any thread, but from
 * one at a time. It also calls each instance from one thread at a time. That thread may change
 * between calls: `attest stress` calls create() and destroy() on one thread and the rest on a
 * real-time thread. Several instances may exist at once, also of different profiles. Two instances
 * may be called from two threads at the same time: a static variable with an intermediate result
 * then has that of the other instance. A port that allows only one instance, or instances of one
 * profile only, returns NULL from create() while an instance exists. The cases of the group
 * `instances` that need a second one are then unsupported.
 *
 * Memory: the host owns both structs and all strings that it passes. They are valid during the call
 * only. The unit owns the result of create() until destroy(). The table, `name`, `version` and all
 * results of extension() must stay valid and unchanged until the library is unloaded. A step should
 * neither allocate nor block.
 *
 * Text: a unit may print on stdout and stderr. The host keeps the text apart from its own. A report
 * shows the last line if the unit crashes, returns ATTEST_FAILED or has a wrong output. `attest run
 * --in-process` shows all of it, on stderr.
 */
#ifndef ATTEST_UNIT_H
#define ATTEST_UNIT_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32)
#define ATTEST_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define ATTEST_EXPORT __attribute__((visibility("default")))
#else
#define ATTEST_EXPORT
#endif

#define ATTEST_UNIT_ABI_VERSION 1u

/* ---- inputs ----------------------------------------------------------------------------------
 *
 * `updated` has a bit for each topic, set if the topic was published since the previous step. A
 * topic whose bit is clear holds its last published sample, or zeros before its first publication.
 * A port copies a topic only if its bit is set in this step, or was set in an earlier step and the
 * port has not copied the topic since. The law copies vehicle_attitude_setpoint only in steps that
 * control attitude, and vehicle_rates_setpoint only in offboard rates mode. In other steps the port
 * remembers the bit, and copies the topic at the next step that needs it. control_state is new in
 * every step and has no bit.
 *
 * Flags are bytes: zero is false and ANY other value is true (a flag of multirotor_motor_limits may
 * arrive as 1, 2 or 4).
 */
enum {
  ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT = 1 << 0,
  ATTEST_UPDATED_VEHICLE_RATES_SETPOINT = 1 << 1,
  ATTEST_UPDATED_MANUAL_CONTROL_SETPOINT = 1 << 2,
  ATTEST_UPDATED_VEHICLE_CONTROL_MODE = 1 << 3,
  ATTEST_UPDATED_ACTUATOR_ARMED = 1 << 4,
  ATTEST_UPDATED_VEHICLE_STATUS = 1 << 5,
  ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS = 1 << 6,
  ATTEST_UPDATED_BATTERY_STATUS = 1 << 7,
  ATTEST_UPDATED_PARAMETER_UPDATE = 1 << 8 /* parameters changed: see set_parameter() */
};

typedef struct attest_inputs {
  uint64_t timestamp; /* [us] time of this step; never decreases. The law's dt is the
                       * difference between the timestamps of two steps, limited to
                       * 2 .. 20 ms. The sample in control_state may be older: see
                       * ATTEST_EXTENSION_TIMESTAMP_SAMPLE. */
  uint32_t updated;   /* ATTEST_UPDATED_... bits */

  struct {            /* topic control_state: the estimate that this step uses */
    float q[4];       /* attitude, body FRD to world NED; a few cases have a norm other than 1 */
    float roll_rate;  /* [rad/s] about body x (forward) */
    float pitch_rate; /* [rad/s] about body y (right) */
    float yaw_rate;   /* [rad/s] about body z (down) */
  } control_state;

  struct {                          /* topic vehicle_attitude_setpoint */
    float q_d[4];                   /* desired attitude, body FRD to world NED. The topic of
                                     * px4-v1.3.4 has the rotation matrix R(q_d) instead: a port
                                     * of that profile computes it from q_d */
    float thrust;                   /* [0..1] collective thrust along -z body */
    float yaw_sp_move_rate;         /* [rad/s] yaw rate commanded by the pilot, fed forward */
    float landing_gear;             /* [-1..1] passed through to control[7] */
    uint8_t disable_mc_yaw_control; /* flag: in autonomous modes the wind may turn the nose */
  } vehicle_attitude_setpoint;

  struct {        /* topic vehicle_rates_setpoint: from outside, used in offboard rates mode */
    float roll;   /* [rad/s] about body x */
    float pitch;  /* [rad/s] about body y */
    float yaw;    /* [rad/s] about body z */
    float thrust; /* [0..1] collective thrust along -z body */
  } vehicle_rates_setpoint;

  struct {   /* topic manual_control_setpoint: the sticks */
    float x; /* [-1..1] pitch stick, positive forward (nose down) */
    float y; /* [-1..1] roll stick, positive right */
    float z; /* [0..1] throttle stick */
    float r; /* [-1..1] yaw stick, positive clockwise seen from above */
  } manual_control_setpoint;

  struct {       /* topic battery_status */
    float scale; /* [1] factor on roll, pitch, yaw and thrust if MC_BAT_SCALE_EN is not 0 */
  } battery_status;

  struct { /* topic vehicle_control_mode: flags */
    uint8_t flag_control_manual_enabled;
    uint8_t flag_control_auto_enabled;
    uint8_t flag_control_rates_enabled;
    uint8_t flag_control_attitude_enabled;
    uint8_t flag_control_rattitude_enabled;
    uint8_t flag_control_velocity_enabled;
  } vehicle_control_mode;

  struct { /* topic actuator_armed */
    uint8_t armed;
  } actuator_armed;

  struct {                  /* topic vehicle_status */
    uint8_t is_rotary_wing; /* before the first sample, the unit takes it as true */
    uint8_t is_vtol;        /* selects the topics of the outputs: see attest_outputs */
  } vehicle_status;

  struct {               /* topic multirotor_motor_limits: saturation reported by the mixer */
    uint8_t lower_limit; /* a motor is at its minimum */
    uint8_t upper_limit; /* a motor is at its maximum */
    uint8_t yaw;         /* yaw was cut to keep roll and pitch */
  } multirotor_motor_limits;
} attest_inputs;

/* ---- outputs ---------------------------------------------------------------------------------
 *
 * `published` is a flag: not 0 in a step that publishes the topic, otherwise 0. If it is 0, the
 * other fields of the topic keep what was last published. The host passes the same struct to every
 * step, zeroed before the first. So a unit has to write `published` of every topic, and the other
 * fields only of the topics that it publishes.
 *
 * Topics: a unit publishes vehicle_rates_setpoint and actuator_controls_0 only after its first
 * sample of vehicle_status, which selects the topics for the life of the instance. If is_vtol is
 * set in that sample, they are the virtual topics mc_virtual_rates_setpoint and
 * actuator_controls_virtual_mc; the outputs below are the same fields for both. mc_att_ctrl_status
 * needs no vehicle_status.
 *
 * Own publications: the unit has one copy of vehicle_rates_setpoint. Its own result overwrites an
 * external sample in that copy. If the unit publishes on vehicle_rates_setpoint, an external sample
 * that it has not copied yet is lost, too. Before its first vehicle_status, when it publishes
 * nothing, its result overwrites the copy only. A VTOL publishes on the virtual topic, so its
 * external sample waits until offboard rates mode copies it.
 */
typedef struct attest_outputs {
  struct {        /* topic vehicle_rates_setpoint: of the attitude loop, or of the sticks in acro */
    float roll;   /* [rad/s] about body x */
    float pitch;  /* [rad/s] about body y */
    float yaw;    /* [rad/s] about body z */
    float thrust; /* [0..1] of the attitude setpoint or of the throttle stick */
    uint8_t published;
  } vehicle_rates_setpoint;

  struct {            /* topic actuator_controls_0: result of the rate loop */
    float control[8]; /* roll, pitch, yaw, thrust, 0, 0, 0, landing gear; dimensionless */
    uint8_t published;
  } actuator_controls_0;

  struct { /* topic mc_att_ctrl_status: the integral parts after this step's update */
    float roll_rate_integ;
    float pitch_rate_integ;
    float yaw_rate_integ;
    uint8_t published;
  } mc_att_ctrl_status;
} attest_outputs;

/* ---- the unit --------------------------------------------------------------------------------*/

enum {
  ATTEST_OK = 0,
  ATTEST_UNSUPPORTED = 1, /* not implemented in this port: the case is counted as unsupported */
  ATTEST_INVALID = 2,     /* invalid arguments (unknown parameter name, value not allowed) */
  ATTEST_FAILED = 3       /* internal error of the port: the case fails */
};

typedef struct attest_unit {
  uint32_t abi_version; /* ATTEST_UNIT_ABI_VERSION of the header the port was compiled with */
  const char* name;     /* short and stable, for reports: "acme-fc-rust" */
  const char* version;  /* version of the port */

  /* A new instance in its power-on state with default parameters. `profile` names the version of
   * the law, such as "px4-v1.5.5". Returns NULL if the port does not support the profile; the cases
   * of the profile are then skipped. A profile that was supported once must stay supported. A port
   * that allows only one instance returns NULL while that instance exists. After destroy() it must
   * create another. Legal at any time, also while other instances exist. May allocate. */
  void* (*create)(const char* profile);

  /* Frees an instance. Called once per successful create(), as the last call for the instance. */
  void (*destroy)(void* self);

  /* Sets one parameter by its PX4 name. Returns ATTEST_OK. ATTEST_UNSUPPORTED is right for a
   * parameter that is a constant in the port: the cases that set it are then unsupported, and the
   * others are judged. ATTEST_INVALID is right for a name that the profile does not have and for a
   * value that is not allowed: a case that sets it fails. Integer parameters arrive as the float of
   * the same value. Legal before the first step, and before a step that has
   * ATTEST_UPDATED_PARAMETER_UPDATE set. A value set before the first step holds from creation: it
   * also controls decisions that the law makes once, such as tailsitter recovery. A later value
   * takes effect in the step that follows. Parameters never set have the law's default: `attest
   * list --parameters` prints all defaults. In px4-v1.3.4 MC_TPA_BREAK, MC_TPA_SLOPE and
   * MC_BAT_SCALE_EN do not exist: the host does not set them there, and a port may return
   * ATTEST_INVALID. Same thread as step(). */
  int (*set_parameter)(void* self, const char* name, float value);

  /* One control step. Returns ATTEST_OK or another of the results above. Must work for every input,
   * NaN and infinities included. `in` must not be written. */
  int (*step)(void* self, const attest_inputs* in, attest_outputs* out);

  /* Extends the ABI without breaking it: returns a pointer to the interface named `id`, or NULL.
   * Must return the same pointer for an `id` each time, before create() too. The function pointer
   * itself may be NULL if a port has no extensions. */
  const void* (*extension)(const char* id);
} attest_unit;

/* Extension: const char*, the groups of cases that the port does not support, separated by commas:
 * "tailsitter,robustness". Their cases are counted separately, never as conformant. */
#define ATTEST_EXTENSION_UNSUPPORTED_GROUPS "attest.unsupported_groups"

/* Extension: const char*, what the port has not, separated by commas: "sticks,mc_att_ctrl_status,
 * MC_YAW_FF=0.5". A word is a feature (`attest list --features`), an output or a topic of outputs
 * in which `*` stands for any text (`attest list --channels`), or a parameter that is a constant,
 * with its value. What is declared is not judged, and the rest is. Cases that do not set a constant
 * run with its value. Those that give it another value set it only to find out whether the port has
 * it after all. The statement lists all words. */
#define ATTEST_EXTENSION_LACKS "attest.lacks"

/* Extension: const char*, the arithmetic of a port in fixed point: "fixed:22" when its signals have
 * 22 fraction bits; 16 to 32 are allowed. The numeric level then allows, in addition to the
 * tolerances for floats, some multiples of the last bit (LSB). Every report says that. */
#define ATTEST_EXTENSION_ARITHMETIC "attest.arithmetic"

/* Extension: const char*, the rate in Hz of a port that has a fixed sample time and ignores
 * `timestamp`, as generated code often does: "250", or "1000/3" for a step of 3 ms. Such a port is
 * given the cases at that rate whose ticks are all one period apart. Other cases are counted as
 * unsupported, and every report names the fixed step. The cases begin one period after zero, so
 * that the first dt is the period too. (For other ports they begin at 5 s, and the first dt is the
 * longest, 20 ms.) The port computes with the law's dt: its period, clamped to the law's limits
 * (2 .. 20 ms in px4-v1.5.5). The extension also applies to the units of attest_cascade.h: their
 * samples are then taken at the time of their steps. */
#define ATTEST_EXTENSION_FIXED_STEP "attest.fixed_step"

/* Extension: const attest_timestamp_sample*, for a port that needs the time at which the sample in
 * control_state was taken. Under an estimator delay, `timestamp` is later than that time. */
#define ATTEST_EXTENSION_TIMESTAMP_SAMPLE "attest.timestamp_sample.v1"

typedef struct attest_timestamp_sample {
  /* The host calls it exactly once before each step(), after the set_parameter() calls of that step
   * and on the thread of that step. `timestamp_sample` is the time in us, on the clock of
   * `timestamp`, at which the control_state sample of that step was taken. It is not later than the
   * step's `timestamp` and never decreases. It repeats when two steps use the same sample. It
   * equals `timestamp` where no delay is modelled, as in scripted cases. In a flight, a step before
   * the arrival of the first sample gets the state at the start of the flight, and the time of that
   * state. Returns ATTEST_OK or another of the results of step(). */
  int (*set_timestamp_sample)(void* self, uint64_t timestamp_sample);
} attest_timestamp_sample;

/* The one exported symbol. Called once, after the library was loaded. The table stays valid until
 * the library is unloaded. */
ATTEST_EXPORT const attest_unit* attest_unit_v1(void);

/* ---- layout, never changed -------------------------------------------------------------------*/

#include <stddef.h>

#ifdef __cplusplus
#define ATTEST_LAYOUT(type, field, offset) \
  static_assert(offsetof(type, field) == (offset), "attest ABI layout: " #type "." #field)
#define ATTEST_SIZE(type, size) static_assert(sizeof(type) == (size), "attest ABI size: " #type)
#else
#define ATTEST_LAYOUT(type, field, offset) \
  _Static_assert(offsetof(type, field) == (offset), "attest ABI layout: " #type "." #field)
#define ATTEST_SIZE(type, size) _Static_assert(sizeof(type) == (size), "attest ABI size: " #type)
#endif

ATTEST_LAYOUT(attest_inputs, timestamp, 0);
ATTEST_LAYOUT(attest_inputs, updated, 8);
ATTEST_LAYOUT(attest_inputs, control_state, 12);
ATTEST_LAYOUT(attest_inputs, vehicle_attitude_setpoint, 40);
ATTEST_LAYOUT(attest_inputs, vehicle_rates_setpoint, 72);
ATTEST_LAYOUT(attest_inputs, manual_control_setpoint, 88);
ATTEST_LAYOUT(attest_inputs, battery_status, 104);
ATTEST_LAYOUT(attest_inputs, vehicle_control_mode, 108);
ATTEST_LAYOUT(attest_inputs, actuator_armed, 114);
ATTEST_LAYOUT(attest_inputs, vehicle_status, 115);
ATTEST_LAYOUT(attest_inputs, multirotor_motor_limits, 117);
ATTEST_SIZE(attest_inputs, 120);

ATTEST_LAYOUT(attest_outputs, vehicle_rates_setpoint, 0);
ATTEST_LAYOUT(attest_outputs, actuator_controls_0, 20);
ATTEST_LAYOUT(attest_outputs, mc_att_ctrl_status, 56);
ATTEST_SIZE(attest_outputs, 72);

#undef ATTEST_LAYOUT
#undef ATTEST_SIZE

#ifdef __cplusplus
}
#endif

#endif /* ATTEST_UNIT_H */
