/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * attest_actuation.h - the C ABI of two optional modules between the controller and the motors:
 * the multirotor mixer and the battery estimate that scales the controls.
 *
 * They are two extensions of attest_unit.h, each a table of functions. A port that returns them
 * from its extension() is given the cases of the groups `mixer` and `battery_status`. For other
 * ports those cases are counted as unsupported. The rules of attest_unit.h for threads, memory and
 * results hold here too. Compiles as C11 and as C++17.
 */
#ifndef ATTEST_ACTUATION_H
#define ATTEST_ACTUATION_H

#include "attest_unit.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ATTEST_MIXER_ROTORS_MAX 8

/* ---- the mixer -------------------------------------------------------------------------------*/

#define ATTEST_EXTENSION_MIXER "attest.mixer.v1" /* const attest_mixer* */

typedef struct attest_mixer_inputs {
  struct {            /* topic actuator_controls_0 */
    float control[4]; /* roll, pitch, yaw [-1..1] about body x, y, z (FRD); thrust [0..1] */
  } actuator_controls_0;
  struct {
    float delta_out_max; /* largest change of an output since the previous call; no limit if 0 */
  } mixer;
} attest_mixer_inputs;

/* The host passes the same struct to every call, zeroed before the first. */
typedef struct attest_mixer_outputs {
  struct {
    float output[ATTEST_MIXER_ROTORS_MAX]; /* -1 stopped .. 1 full; one for each rotor */
  } actuator_outputs;
  struct {               /* topic multirotor_motor_limits; any value but 0 is true */
    uint8_t lower_limit; /* a motor is at its minimum */
    uint8_t upper_limit; /* a motor is at its maximum */
    uint8_t yaw;         /* yaw was cut to keep roll and pitch */
  } multirotor_motor_limits;
} attest_mixer_outputs;

typedef struct attest_mixer {
  /* A new mixer. `definition` is a line of a PX4 mixer file,
   * "R: <geometry> <roll> <pitch> <yaw> <deadband>"
   * with numbers in 1/10000, such as "R: 4x 10000 10000 10000 0". It is valid during the call only.
   * With a deadband of 0, delta_out_max does not limit the first step, because there is no previous
   * output. With another deadband the previous output is 0, and delta_out_max limits the first step
   * too. Returns NULL if the mixer is not supported. Its cases are then counted as unsupported. */
  void* (*create)(const char* profile, const char* definition);
  void (*destroy)(void* self);
  int (*step)(void* self, const attest_mixer_inputs* in, attest_mixer_outputs* out);
} attest_mixer;

/* ---- the battery estimate --------------------------------------------------------------------*/

#define ATTEST_EXTENSION_BATTERY_STATUS \
  "attest.battery_status.v1" /* const attest_battery_status* */

typedef struct attest_battery_inputs {
  struct {
    float voltage_v; /* of the pack */
    float current_a;
    float throttle; /* [0..1] as commanded */
    uint8_t armed;  /* flag */
  } battery;
} attest_battery_inputs;

typedef struct attest_battery_outputs {
  struct {       /* topic battery_status */
    float scale; /* [1] factor on the controls, 1 .. 1.3 */
  } battery_status;
} attest_battery_outputs;

typedef struct attest_battery_status {
  /* A new estimate, before its first sample. Returns NULL if the profile is not supported. */
  void* (*create)(const char* profile);
  void (*destroy)(void* self);
  /* Sets BAT_N_CELLS, BAT_V_EMPTY, BAT_V_CHARGED, BAT_V_LOAD_DROP or BAT_R_INTERNAL (negative:
   * unknown). Called before the first step only. Their defaults are those of the firmware:
   * 0, 3.4 V, 4.05 V, 0.3 V and -1. With 0 cells the estimate is not finite, and the scale is 1. */
  int (*set_parameter)(void* self, const char* name, float value);
  /* Takes one sample. The samples are 10 ms apart (100 Hz). */
  int (*step)(void* self, const attest_battery_inputs* in, attest_battery_outputs* out);
} attest_battery_status;

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

ATTEST_LAYOUT(attest_mixer_inputs, mixer, 16);
ATTEST_SIZE(attest_mixer_inputs, 20);
ATTEST_LAYOUT(attest_mixer_outputs, multirotor_motor_limits, 32);
ATTEST_SIZE(attest_mixer_outputs, 36);
ATTEST_LAYOUT(attest_battery_inputs, battery.armed, 12);
ATTEST_SIZE(attest_battery_inputs, 16);
ATTEST_SIZE(attest_battery_outputs, 4);

#undef ATTEST_LAYOUT
#undef ATTEST_SIZE

#ifdef __cplusplus
}
#endif

#endif /* ATTEST_ACTUATION_H */
