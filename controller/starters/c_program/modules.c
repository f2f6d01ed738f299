/* SPDX-License-Identifier: BSD-3-Clause */
#include "modules.h"

/* The functions of a module. `any` is NULL if the port has no such module. */
typedef union {
  const void* any;
  const attest_unit* controller;
  const attest_mixer* mixer;
  const attest_battery_status* battery;
  const attest_attitude_unit* attitude;
  const attest_rate_unit* rate;
  const attest_attitude_law* attitude_law;
  const attest_rate_law* rate_law;
} functions;

const module_description modules[MODULES] = {
    {"", "", sizeof(attest_inputs), sizeof(attest_outputs)},
    {"mixer", ATTEST_EXTENSION_MIXER, sizeof(attest_mixer_inputs), sizeof(attest_mixer_outputs)},
    {"battery_status", ATTEST_EXTENSION_BATTERY_STATUS, sizeof(attest_battery_inputs),
     sizeof(attest_battery_outputs)},
    {"attitude_unit", ATTEST_EXTENSION_ATTITUDE_UNIT, sizeof(attest_attitude_inputs),
     sizeof(attest_attitude_outputs)},
    {"rate_unit", ATTEST_EXTENSION_RATE_UNIT, sizeof(attest_rate_inputs),
     sizeof(attest_rate_outputs)},
    {"attitude_law", ATTEST_EXTENSION_ATTITUDE_LAW, sizeof(attest_attitude_law_inputs),
     sizeof(attest_attitude_law_outputs)},
    {"rate_law", ATTEST_EXTENSION_RATE_LAW, sizeof(attest_rate_law_inputs),
     sizeof(attest_rate_law_outputs)},
};

const void* port_extension(const char* id) {
  const attest_unit* const port = attest_unit_v1();
  return port->extension ? port->extension(id) : NULL;
}

static functions functions_of(uint32_t module) {
  if (module >= MODULES) return (functions){NULL};
  if (module != CONTROLLER) return (functions){port_extension(modules[module].extension)};
  return (functions){attest_unit_v1()->create ? attest_unit_v1() : NULL};
}

void* module_create(uint32_t module, const char* profile, const char* definition) {
  const functions of = functions_of(module);
  if (!of.any) return NULL;
  switch (module) {
    case CONTROLLER:
      return of.controller->create(profile);
    case MIXER:
      return of.mixer->create(profile, definition);
    case BATTERY:
      return of.battery->create(profile);
    case ATTITUDE:
      return of.attitude->create(profile);
    case RATE:
      return of.rate->create(profile);
    case ATTITUDE_LAW:
      return of.attitude_law->create(profile);
    default:
      return of.rate_law->create(profile);
  }
}

void module_destroy(uint32_t module, void* self) {
  const functions of = functions_of(module);
  switch (module) {
    case CONTROLLER:
      of.controller->destroy(self);
      break;
    case MIXER:
      of.mixer->destroy(self);
      break;
    case BATTERY:
      of.battery->destroy(self);
      break;
    case ATTITUDE:
      of.attitude->destroy(self);
      break;
    case RATE:
      of.rate->destroy(self);
      break;
    case ATTITUDE_LAW:
      of.attitude_law->destroy(self);
      break;
    default:
      of.rate_law->destroy(self);
  }
}

int module_set_parameter(uint32_t module, void* self, const char* name, float value) {
  const functions of = functions_of(module);
  switch (module) {
    case CONTROLLER:
      return of.controller->set_parameter(self, name, value);
    case BATTERY:
      return of.battery->set_parameter(self, name, value);
    case ATTITUDE:
      return of.attitude->set_parameter(self, name, value);
    case RATE:
      return of.rate->set_parameter(self, name, value);
    default:
      return ATTEST_INVALID; /* a module without parameters */
  }
}

int module_step(uint32_t module, void* self, const module_inputs* in, module_outputs* out) {
  const functions of = functions_of(module);
  switch (module) {
    case CONTROLLER:
      return of.controller->step(self, &in->controller, &out->controller);
    case MIXER:
      return of.mixer->step(self, &in->mixer, &out->mixer);
    case BATTERY:
      return of.battery->step(self, &in->battery, &out->battery);
    case ATTITUDE:
      return of.attitude->step(self, &in->attitude, &out->attitude);
    case RATE:
      return of.rate->step(self, &in->rate, &out->rate);
    case ATTITUDE_LAW:
      return of.attitude_law->step(self, &in->attitude_law, &out->attitude_law);
    default:
      return of.rate_law->step(self, &in->rate_law, &out->rate_law);
  }
}
