/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * law_port.h - makes a port of two functions. It needs a change only for another state.
 *
 *     LAW_PORT(name, profiles, attitude, profiles, rate)
 *
 * Each law has the profiles that it is for, separated by spaces. The functions are
 *
 *     void attitude(const attest_attitude_law_inputs* in, float rates_sp[3]);
 *     void rate(const attest_rate_law_inputs* in, float integral[3], float torque[3]);
 *
 * integral is the state of an instance: 0 at first, and after a reset.
 */
#ifndef LAW_PORT_H
#define LAW_PORT_H

#include <attest_law.h>
#include <stdlib.h>
#include <string.h>

enum { VECTOR_SIZE = 3 * sizeof(float) };

/* Returns NULL if the profile is not one of `profiles`. */
static inline void* law_create(const char* profiles, const char* profile) {
  const size_t length = strlen(profile);
  for (const char* at = profiles; (at = strstr(at, profile)) != NULL; at += length) {
    const int begins = at == profiles || at[-1] == ' ';
    if (begins && (at[length] == ' ' || at[length] == '\0')) return calloc(1, VECTOR_SIZE);
  }
  return NULL;
}

#define LAW_PORT(port_name, attitude_profiles, attitude, rate_profiles, rate)                  \
  static void* create_attitude(const char* profile) {                                          \
    return law_create(attitude_profiles, profile);                                             \
  }                                                                                            \
  static int step_attitude(void* self, const attest_attitude_law_inputs* in,                   \
                           attest_attitude_law_outputs* out) {                                 \
    (void)self;                                                                                \
    float rates_sp[3];                                                                         \
    attitude(in, rates_sp);                                                                    \
    memcpy(&out->vehicle_rates_setpoint, rates_sp, VECTOR_SIZE);                               \
    return ATTEST_OK;                                                                          \
  }                                                                                            \
  static void* create_rate(const char* profile) { return law_create(rate_profiles, profile); } \
  static int step_rate(void* integral, const attest_rate_law_inputs* in,                       \
                       attest_rate_law_outputs* out) {                                         \
    if (in->law.reset) memset(integral, 0, VECTOR_SIZE);                                       \
    rate(in, integral, out->vehicle_torque_setpoint.xyz);                                      \
    memcpy(&out->rate_ctrl_status, integral, VECTOR_SIZE);                                     \
    return ATTEST_OK;                                                                          \
  }                                                                                            \
  static const void* extension(const char* id) {                                               \
    static const attest_attitude_law attitude_table = {create_attitude, free, step_attitude};  \
    static const attest_rate_law rate_table = {create_rate, free, step_rate};                  \
    if (strcmp(id, ATTEST_EXTENSION_ATTITUDE_LAW) == 0) return &attitude_table;                \
    return strcmp(id, ATTEST_EXTENSION_RATE_LAW) == 0 ? &rate_table : NULL;                    \
  }                                                                                            \
  const attest_unit* attest_unit_v1(void) {                                                    \
    static const attest_unit unit = {ATTEST_UNIT_ABI_VERSION, port_name, "1.0",                \
                                     .extension = extension};                                  \
    return &unit;                                                                              \
  }

#endif /* LAW_PORT_H */
