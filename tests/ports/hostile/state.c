/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: fail. A C starter whose state is wrong in a way that short runs of one instance do not
 * show. Compiled with one of these definitions, and with CASCADE for the units of the cascade:
 *
 *   STARTS_AGAIN     a counter of 16 bits wraps; then the unit is in its power-on state again
 *   ALL_STEPS        wrong from step 65,536 of the process on
 *   FROM_INSTANCE=N  wrong from the Nth instance on
 *   USED_SLOT        from the 65th instance on, an instance has the state of an earlier one
 *   LIVING_SLOT      the 257th instance takes the place of the first, which may still exist
 *   SHARED_INPUTS    each step reads its inputs from one static copy
 *   SHARED_OUTPUTS   each step writes its outputs to one static copy
 *   LAST_PROFILE     every instance has the law of the profile that was created last
 *   FIRST_PROFILE    every instance has the law of the profile that was created first
 *   SHARED_SIZE      the absolute value of an input is in a static variable, and is computed again
 *                    only when the input of the instance changes */
#ifdef CASCADE
#include <attest_cascade.h>
#else
#include <attest_unit.h>
#endif
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

const attest_unit* attest_starter_unit_v1(void);

#ifdef CASCADE
static const char* const profiles[] = {"px4-v1.16.0", "px4-v1.15.4", "px4-v1.14.4"};
#else
static const char* const profiles[] = {"px4-v1.5.5", "px4-v1.3.4"};
#endif
enum { PROFILES = sizeof profiles / sizeof profiles[0], MOST_BYTES = 512 };

/* A unit of the starter. */
typedef struct module {
  void* (*create)(const char* profile);
  void (*destroy)(void* self);
  int (*set_parameter)(void* self, const char* name, float value);
  int (*step)(void* self, const void* in, void* out);
  size_t in_size, out_size;
  size_t input, output; /* offsets of a float */
} module;

typedef struct instance {
  const module* of;
  void* unit[PROFILES]; /* only with ..._PROFILE more than the first */
  _Alignas(8) unsigned char out[PROFILES][MOST_BYTES];
  const char* profile;
  int own; /* index of its profile */
  uint16_t steps;
  int is_wrong;
  float last;
} instance;

static void fill(instance* one, const module* of, const char* profile) {
  memset(one, 0, sizeof *one);
  one->of = of;
  one->profile = profile;
  one->last = NAN;
  for (int i = 0; i < PROFILES; i++) {
    if (strcmp(profiles[i], profile) == 0) one->own = i;
  }
#if defined(LAST_PROFILE) || defined(FIRST_PROFILE)
  for (int i = 0; i < PROFILES; i++) one->unit[i] = of->create(profiles[i]);
#else
  one->unit[0] = of->create(profile);
#endif
}

#if defined(USED_SLOT) || defined(LIVING_SLOT)
#ifdef USED_SLOT
enum { SLOTS = 64 };
#else
enum { SLOTS = 256 };
#endif
static instance slots[SLOTS];
#endif

#if defined(LAST_PROFILE) || defined(FIRST_PROFILE)
static int law = -1;
#endif

static void* create(const module* of, const char* profile) {
  static unsigned made = 0;
  void* const probe = of->create(profile);
  if (probe == NULL) return NULL;
  of->destroy(probe);
  made++;
#if defined(USED_SLOT) || defined(LIVING_SLOT)
  instance* one = &slots[(made - 1) % SLOTS];
#ifdef USED_SLOT
  if (made > SLOTS && one->of == of) return one;
#endif
  fill(one, of, profile);
#else
  instance* one = malloc(sizeof *one);
  fill(one, of, profile);
#endif
#ifdef FROM_INSTANCE
  one->is_wrong = made >= FROM_INSTANCE;
#endif
#ifdef LAST_PROFILE
  law = one->own;
#endif
#ifdef FIRST_PROFILE
  if (law < 0) law = one->own;
#endif
  return one;
}

static void destroy(void* self) {
#if defined(USED_SLOT) || defined(LIVING_SLOT)
  (void)self;
#else
  instance* one = self;
  for (int i = 0; i < PROFILES; i++) {
    if (one->unit[i] != NULL) one->of->destroy(one->unit[i]);
  }
  free(one);
#endif
}

static int set_parameter(void* self, const char* name, float value) {
  instance* one = self;
  int result = ATTEST_INVALID;
  for (int i = 0; i < PROFILES; i++) {
    if (one->unit[i] == NULL) continue;
    const int set = one->of->set_parameter(one->unit[i], name, value);
    if (i == one->own || one->unit[1] == NULL) result = set;
  }
  return result;
}

/* The step of the starter, on the copies of inputs and outputs that the port may change. */
static int inner_step(instance* one, const void* in, void* out) {
#if defined(LAST_PROFILE) || defined(FIRST_PROFILE)
  int result = ATTEST_OK;
  for (int i = 0; i < PROFILES; i++) result |= one->of->step(one->unit[i], in, one->out[i]);
  memcpy(out, one->out[law], one->of->out_size);
  return result;
#else
  return one->of->step(one->unit[0], in, out);
#endif
}

static int step(void* self, const void* in, void* out) {
  instance* one = self;
  float value;
#ifdef STARTS_AGAIN
  if (++one->steps == 0) {
    one->of->destroy(one->unit[0]);
    one->unit[0] = one->of->create(one->profile);
  }
#endif
#ifdef ALL_STEPS
  static unsigned steps = 0;
  if (++steps > 65535) one->is_wrong = 1;
#endif
#if defined(SHARED_INPUTS) || defined(SHARED_SIZE)
#ifdef SHARED_INPUTS
  static
#endif
      _Alignas(8) unsigned char own[MOST_BYTES];
  memcpy(own, in, one->of->in_size);
  in = own;
#endif
#ifdef SHARED_SIZE
  static float size;
  memcpy(&value, own + one->of->input, sizeof value);
  if (value != one->last) size = fabsf(value);
  one->last = value;
  value = copysignf(size, value);
  memcpy(own + one->of->input, &value, sizeof value);
#endif
#ifdef SHARED_OUTPUTS
  static _Alignas(8) unsigned char shared[MOST_BYTES];
  memcpy(shared, out, one->of->out_size);
  const int result = inner_step(one, in, shared);
  memcpy(out, shared, one->of->out_size);
#else
  const int result = inner_step(one, in, out);
#endif
  memcpy(&value, (char*)out + one->of->output, sizeof value);
  if (one->is_wrong) value = 1.05f * value + 0.01f;
  memcpy((char*)out + one->of->output, &value, sizeof value);
  return result;
}

/* MODULE(name, its table in the starter, type of its table, inputs, outputs, two of their floats)
 * defines `name`_table, which is a table of this port. */
#define MODULE(name, starter, table_type, in_type, out_type, input_, output_)                    \
  static void* starter_create_##name(const char* profile) { return (starter)->create(profile); } \
  static void starter_destroy_##name(void* self) { (starter)->destroy(self); }                   \
  static int starter_set_##name(void* self, const char* parameter, float value) {                \
    return (starter)->set_parameter(self, parameter, value);                                     \
  }                                                                                              \
  static int starter_step_##name(void* self, const void* in, void* out) {                        \
    return (starter)->step(self, in, out);                                                       \
  }                                                                                              \
  static const module name##_module = {starter_create_##name,     starter_destroy_##name,        \
                                       starter_set_##name,        starter_step_##name,           \
                                       sizeof(in_type),           sizeof(out_type),              \
                                       offsetof(in_type, input_), offsetof(out_type, output_)};  \
  static void* create_##name(const char* profile) { return create(&name##_module, profile); }    \
  static int step_##name(void* self, const in_type* in, out_type* out) {                         \
    return step(self, in, out);                                                                  \
  }                                                                                              \
  _Static_assert(sizeof(in_type) <= MOST_BYTES && sizeof(out_type) <= MOST_BYTES, "does not fit")

#ifdef CASCADE
#define STARTER(type, id) ((const type*)attest_starter_unit_v1()->extension(id))
MODULE(attitude, STARTER(attest_attitude_unit, ATTEST_EXTENSION_ATTITUDE_UNIT),
       attest_attitude_unit, attest_attitude_inputs, attest_attitude_outputs,
       manual_control_setpoint.roll, vehicle_rates_setpoint.roll);
MODULE(rate, STARTER(attest_rate_unit, ATTEST_EXTENSION_RATE_UNIT), attest_rate_unit,
       attest_rate_inputs, attest_rate_outputs, vehicle_angular_velocity.xyz[0],
       vehicle_torque_setpoint.xyz[0]);

static const void* extension(const char* id) {
  static const attest_attitude_unit attitude = {create_attitude, destroy, set_parameter,
                                                step_attitude};
  static const attest_rate_unit rate = {create_rate, destroy, set_parameter, step_rate};
  if (strcmp(id, ATTEST_EXTENSION_ATTITUDE_UNIT) == 0) return &attitude;
  return strcmp(id, ATTEST_EXTENSION_RATE_UNIT) == 0 ? &rate : NULL;
}
#else
MODULE(controller, attest_starter_unit_v1(), attest_unit, attest_inputs, attest_outputs,
       control_state.roll_rate, actuator_controls_0.control[0]);
#endif

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "state",
      .version = "0.1.0",
#ifdef CASCADE
      .extension = extension,
#else
      .create = create_controller,
      .destroy = destroy,
      .set_parameter = set_parameter,
      .step = step_controller,
#endif
  };
  return &unit;
}
