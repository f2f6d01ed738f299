/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: pass at 250 Hz, and unsupported at other rates and where ticks or samples are at other
 * times. Both units always step by 4 ms and ignore the times of their samples, like code that
 * Simulink generates. With GAIN defined the rate unit multiplies its roll torque by GAIN, and must
 * fail. */
#include <attest_cascade.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

const attest_unit* attest_starter_unit_v1(void);

static const uint64_t period_us = 4000;

typedef struct wrapped {
  void* unit;
  uint64_t steps;
} wrapped;

static const attest_attitude_unit* attitude_unit(void) {
  return attest_starter_unit_v1()->extension(ATTEST_EXTENSION_ATTITUDE_UNIT);
}

static const attest_rate_unit* rate_unit(void) {
  return attest_starter_unit_v1()->extension(ATTEST_EXTENSION_RATE_UNIT);
}

static void* wrap(void* unit) {
  if (unit == NULL) return NULL;
  wrapped* w = calloc(1, sizeof *w);
  w->unit = unit;
  return w;
}

static void* create_attitude(const char* profile) { return wrap(attitude_unit()->create(profile)); }
static void* create_rate(const char* profile) { return wrap(rate_unit()->create(profile)); }

/* Both units of the starter are freed in the same way. */
static void destroy(void* self) {
  wrapped* w = self;
  rate_unit()->destroy(w->unit);
  free(w);
}

static int set_attitude_parameter(void* self, const char* name, float value) {
  return attitude_unit()->set_parameter(((wrapped*)self)->unit, name, value);
}

static int set_rate_parameter(void* self, const char* name, float value) {
  return rate_unit()->set_parameter(((wrapped*)self)->unit, name, value);
}

static int step_attitude(void* self, const attest_attitude_inputs* in,
                         attest_attitude_outputs* out) {
  wrapped* w = self;
  attest_attitude_inputs own = *in;
  own.vehicle_attitude.timestamp_sample = ++w->steps * period_us;
  return attitude_unit()->step(w->unit, &own, out);
}

static int step_rate(void* self, const attest_rate_inputs* in, attest_rate_outputs* out) {
  wrapped* w = self;
  attest_rate_inputs own = *in;
  own.vehicle_angular_velocity.timestamp_sample = ++w->steps * period_us;
  const int result = rate_unit()->step(w->unit, &own, out);
#ifdef GAIN
  if (out->vehicle_torque_setpoint.published) out->vehicle_torque_setpoint.xyz[0] *= GAIN;
#endif
  return result;
}

static const void* extension(const char* id) {
  static const attest_attitude_unit attitude = {.create = create_attitude,
                                                .destroy = destroy,
                                                .set_parameter = set_attitude_parameter,
                                                .step = step_attitude};
  static const attest_rate_unit rate = {.create = create_rate,
                                        .destroy = destroy,
                                        .set_parameter = set_rate_parameter,
                                        .step = step_rate};
  if (strcmp(id, ATTEST_EXTENSION_ATTITUDE_UNIT) == 0) return &attitude;
  if (strcmp(id, ATTEST_EXTENSION_RATE_UNIT) == 0) return &rate;
  return strcmp(id, ATTEST_EXTENSION_FIXED_STEP) == 0 ? "250" : NULL;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "fixed-step-cascade",
      .version = "0.1.0",
      .extension = extension,
  };
  return &unit;
}
