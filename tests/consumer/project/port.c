/* The least that keeps the rules of the ABI: a controller that always answers zero. */
#include <attest_unit.h>
#include <stdlib.h>
#include <string.h>

static void* create(const char* profile) {
  return strcmp(profile, "px4-v1.5.5") == 0 ? malloc(1) : NULL;
}

static int set_parameter(void* self, const char* name, float value) {
  (void)self;
  (void)name;
  (void)value;
  return ATTEST_OK;
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  (void)self;
  (void)in;
  out->vehicle_rates_setpoint.published = 1;
  out->actuator_controls_0.published = 1;
  out->mc_att_ctrl_status.published = 1;
  return ATTEST_OK;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {ATTEST_UNIT_ABI_VERSION, "consumer", "1", create, free,
                                   set_parameter,           step,       NULL};
  return &unit;
}
