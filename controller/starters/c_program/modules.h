/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * modules.h - the modules of a port by their numbers in PROTOCOL.md. The port is that of
 * attest_unit_v1(): its controller, and the modules of its extension().
 */
#ifndef PROGRAM_MODULES_H
#define PROGRAM_MODULES_H

#include <stddef.h>
#include <stdint.h>

#include "attest_actuation.h"
#include "attest_cascade.h"
#include "attest_law.h"
#include "attest_unit.h"

enum { CONTROLLER, MIXER, BATTERY, ATTITUDE, RATE, ATTITUDE_LAW, RATE_LAW, MODULES };

typedef union {
  attest_inputs controller;
  attest_mixer_inputs mixer;
  attest_battery_inputs battery;
  attest_attitude_inputs attitude;
  attest_rate_inputs rate;
  attest_attitude_law_inputs attitude_law;
  attest_rate_law_inputs rate_law;
} module_inputs;

typedef union {
  attest_outputs controller;
  attest_mixer_outputs mixer;
  attest_battery_outputs battery;
  attest_attitude_outputs attitude;
  attest_rate_outputs rate;
  attest_attitude_law_outputs attitude_law;
  attest_rate_law_outputs rate_law;
} module_outputs;

typedef struct {
  const char *name, *extension;
  size_t inputs, outputs; /* bytes */
} module_description;

extern const module_description modules[MODULES];

/* NULL if the port has no such extension. */
const void* port_extension(const char* id);

/* NULL if the port has no such module, or not for this profile. Only a mixer has a definition. */
void* module_create(uint32_t module, const char* profile, const char* definition);

void module_destroy(uint32_t module, void* self);

int module_set_parameter(uint32_t module, void* self, const char* name, float value);

int module_step(uint32_t module, void* self, const module_inputs* in, module_outputs* out);

#endif /* PROGRAM_MODULES_H */
