/* SPDX-License-Identifier: BSD-3-Clause */
/* The exported symbol, the profiles, and access to parameters by name. */
#include "port.h"

#include <string.h>

/* ---- the exported symbol ---------------------------------------------------------------------*/

/* To keep one unit only, delete the row of the other and its files. */
static const struct {
  const char* id;
  const void* table;
} extensions[] = {
    {ATTEST_EXTENSION_ATTITUDE_UNIT, &attitude_unit_table},
    {ATTEST_EXTENSION_RATE_UNIT, &rate_unit_table},
};

static const void* extension(const char* id) {
  for (size_t i = 0; i < sizeof extensions / sizeof extensions[0]; i++) {
    if (strcmp(extensions[i].id, id) == 0) return extensions[i].table;
  }
  return NULL;
}

const attest_unit* attest_unit_v1(void) {
  /* create, destroy, set_parameter and step are NULL: the port has extensions only. */
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "attest-starter-c-cascade",
      .version = "0.1.0",
      .extension = extension,
  };
  return &unit;
}

/* ---- profiles --------------------------------------------------------------------------------*/

#define AUTOTUNE_STATES_BEFORE_V1_17 \
  { 2, 4, 6, 10 }
#define AUTOTUNE_STATES \
  { 3, 6, 9, 13 }

static const profile profiles[PROFILE_COUNT] = {
    [PX4_V1_14_4] = {.name = "px4-v1.14.4",
                     .lowpass_as_average = true,
                     .setpoint_first = true,
                     .yaw_of_any_norm = true,
                     .autotune_states = AUTOTUNE_STATES_BEFORE_V1_17},
    [PX4_V1_15_4] = {.name = "px4-v1.15.4",
                     .throttle_slews = true,
                     .autotune_states = AUTOTUNE_STATES_BEFORE_V1_17},
    [PX4_V1_16_0] = {.name = "px4-v1.16.0",
                     .yaw_torque_filter = true,
                     .yaw_lock = true,
                     .hover_estimate = true,
                     .throttle_slews = true,
                     .autotune_states = AUTOTUNE_STATES_BEFORE_V1_17},
    [PX4_V1_17] = {.name = "px4-v1.17",
                   .yaw_torque_filter = true,
                   .yaw_lock = true,
                   .yaw_expo_fixed = true,
                   .hover_estimate = true,
                   .throttle_slews = true,
                   .autotune_states = AUTOTUNE_STATES},
    [PX4_V1_18] = {.name = "px4-v1.18",
                   .yaw_torque_filter = true,
                   .ignores_heading_good = true,
                   .yaw_lock = true,
                   .yaw_expo_fixed = true,
                   .keeps_lost_correction = true,
                   .hover_estimate = true,
                   .throttle_slews = true,
                   .reference_model = true,
                   .autotune_states = AUTOTUNE_STATES},
};

const profile* profile_find(const char* name) {
  for (size_t i = 0; i < PROFILE_COUNT; i++) {
    if (strcmp(profiles[i].name, name) == 0) return &profiles[i];
  }
  return NULL;
}

/* ---- parameters ------------------------------------------------------------------------------*/

static float initial(const parameter* row, const profile* selected) {
  return row->initial[selected - profiles];
}

static bool is_absent(const parameter* row, const profile* selected) {
  return isnan(initial(row, selected));
}

static void write_value(const parameter* row, void* values, float value) {
  memcpy((char*)values + row->offset, &value, sizeof value);
}

void parameters_initialise(const parameter table[], size_t count, const profile* selected,
                           void* values) {
  for (size_t i = 0; i < count; i++) {
    if (is_absent(&table[i], selected)) continue; /* a renamed parameter has two rows for a field */
    write_value(&table[i], values, initial(&table[i], selected));
  }
}

int parameters_set(const parameter table[], size_t count, const profile* selected, void* values,
                   const char* name, float value) {
  for (size_t i = 0; i < count; i++) {
    if (!is_absent(&table[i], selected) && strcmp(table[i].name, name) == 0) {
      write_value(&table[i], values, value);
      return ATTEST_OK;
    }
  }
  return ATTEST_INVALID;
}
