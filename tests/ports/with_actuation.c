/* SPDX-License-Identifier: BSD-3-Clause */
/* Right: the C starter, with a mixer and a battery estimate written by hand from the law's
 * description, without sight of controller/actuation. It is the second implementation of these
 * groups. Their goldens agree with it to the bit. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attest_actuation.h"

const attest_unit* attest_starter_unit_v1(void);

/* ---- the mixer -------------------------------------------------------------------------------*/

struct arm {
  double clockwise_from_nose_deg;
  int counter_clockwise;
};

static const struct arm quad_x[] = {{45, 1}, {-135, 1}, {-45, 0}, {135, 0}};
static const struct arm quad_plus[] = {{90, 1}, {-90, 1}, {0, 0}, {180, 0}};
static const struct arm hexa_x[] = {{90, 0}, {-90, 1}, {-30, 0}, {150, 1}, {30, 1}, {-150, 0}};
static const struct arm octo_x[] = {{22.5, 0},  {-157.5, 0}, {67.5, 1},  {157.5, 1},
                                    {-22.5, 1}, {-112.5, 1}, {-67.5, 0}, {112.5, 0}};

struct mixer {
  int count;
  float roll[8], pitch[8], yaw[8];
  float roll_scale, pitch_scale, yaw_scale, idle;
  float last[8];
};

static float six_decimals(double x) { return (float)(round(x * 1e6) / 1e6); }

static void place(struct mixer* m, const struct arm* arms, int count) {
  const double degree = acos(-1.0) / 180.0;
  m->count = count;
  for (int i = 0; i < count; ++i) {
    const double angle = arms[i].clockwise_from_nose_deg;
    m->roll[i] = six_decimals(cos((angle + 90.0) * degree));
    m->pitch[i] = six_decimals(cos(angle * degree));
    m->yaw[i] = arms[i].counter_clockwise ? 1.0f : -1.0f;
  }
}

static void* mixer_create(const char* profile, const char* definition) {
  char geometry[3];
  int roll, pitch, yaw, deadband;
  if (strcmp(profile, "px4-v1.5.5") != 0) return NULL;
  if (sscanf(definition, "R: %2s %d %d %d %d", geometry, &roll, &pitch, &yaw, &deadband) != 5) {
    return NULL;
  }
  struct mixer* m = calloc(1, sizeof *m);
  if (m == NULL) return NULL;
  if (strcmp(geometry, "4x") == 0) {
    place(m, quad_x, 4);
  } else if (strcmp(geometry, "4+") == 0) {
    place(m, quad_plus, 4);
  } else if (strcmp(geometry, "6x") == 0) {
    place(m, hexa_x, 6);
  } else {
    place(m, octo_x, 8);
  }
  m->roll_scale = (float)roll / 10000.0f;
  m->pitch_scale = (float)pitch / 10000.0f;
  m->yaw_scale = (float)yaw / 10000.0f;
  m->idle = -1.0f + 2.0f * ((float)deadband / 10000.0f);
  for (int i = 0; i < 8; ++i) m->last[i] = deadband == 0 ? NAN : 0.0f;
  return m;
}

static float between(float low, float x, float high) {
  if (x < low) return low;
  return x > high ? high : x;
}

struct room {
  float boost, share;
};

/* The five ways in which the rotors' span can be beyond their limits. */
static struct room make_room(float min, float max, float thrust) {
  const float raise = 1.5f * thrust - thrust, lower = thrust - 0.6f * thrust;
  struct room r = {0.0f, 1.0f};
  if (min < 0.0f && max < 1.0f && -min <= 1.0f - max) {
    if (raise >= -min) {
      r.boost = -min;
      return r;
    }
    r.boost = raise;
  } else if (max > 1.0f && min > 0.0f && min >= max - 1.0f) {
    if (lower >= max - 1.0f) {
      r.boost = -(max - 1.0f);
      return r;
    }
    r.boost = -lower;
  } else if (min < 0.0f && max < 1.0f) {
    r.boost = between(0.0f, -min - (1.0f - max) / 2.0f, raise);
  } else if (max > 1.0f && min > 0.0f) {
    r.boost = between(-lower, -(max - 1.0f - min) / 2.0f, 0.0f);
  } else if (min < 0.0f && max > 1.0f) {
    r.boost = between(0.6f * thrust - thrust, -(max - 1.0f + min) / 2.0f, raise);
  } else {
    return r;
  }
  if (min < 0.0f) {
    r.share = (thrust + r.boost) / (thrust - min);
  } else {
    r.share = (1.0f - (thrust + r.boost)) / (max - thrust);
  }
  return r;
}

static int mixer_step(void* self, const attest_mixer_inputs* in, attest_mixer_outputs* out) {
  struct mixer* m = self;
  const float* control = in->actuator_controls_0.control;
  const float roll = between(-1.0f, control[0] * m->roll_scale, 1.0f);
  const float pitch = between(-1.0f, control[1] * m->pitch_scale, 1.0f);
  float yaw = between(-1.0f, control[2] * m->yaw_scale, 1.0f);
  float thrust = between(0.0f, control[3], 1.0f);
  float min = 1.0f, max = 0.0f;
  for (int i = 0; i < m->count; ++i) {
    const float tilt = roll * m->roll[i] + pitch * m->pitch[i] + thrust;
    if (tilt < min) min = tilt;
    if (tilt > max) max = tilt;
  }
  const struct room room = make_room(min, max, thrust);
  out->multirotor_motor_limits.lower_limit = min < 0.0f;
  out->multirotor_motor_limits.upper_limit = max > 1.0f;
  out->multirotor_motor_limits.yaw = 0;
  for (int i = 0; i < m->count; ++i) {
    const float tilt = (roll * m->roll[i] + pitch * m->pitch[i]) * room.share;
    const float command = tilt + yaw * m->yaw[i] + thrust + room.boost;
    if (command >= 0.0f && command <= 1.0f) continue;
    float wanted = 0.0f;
    if (command > 1.0f) {
      thrust -= fminf(0.15f, command - 1.0f);
      wanted = 1.0f;
    }
    const float rest = tilt + thrust + room.boost;
    yaw = fabsf(m->yaw[i]) <= FLT_EPSILON ? 0.0f : (wanted - rest) / m->yaw[i];
    out->multirotor_motor_limits.yaw = 1;
  }
  for (int i = 0; i < m->count; ++i) {
    const float tilt = (roll * m->roll[i] + pitch * m->pitch[i]) * room.share;
    const float command = tilt + yaw * m->yaw[i] + thrust + room.boost;
    float answer = between(m->idle, m->idle + command * (1.0f - m->idle), 1.0f);
    const float limit = in->mixer.delta_out_max;
    if (limit > 0.0f) {
      const float change = answer - m->last[i];
      if (change > limit) answer = m->last[i] + limit;
      if (change < -limit) answer = m->last[i] - limit;
    }
    m->last[i] = answer;
    out->actuator_outputs.output[i] = answer;
  }
  return ATTEST_OK;
}

/* ---- the battery estimate --------------------------------------------------------------------*/

struct battery {
  float cells, empty, charged, drop, resistance;
  float remaining, filtered_v;
};

static void* battery_create(const char* profile) {
  static const struct battery fresh = {0.0f, 3.4f, 4.05f, 0.3f, -1.0f, 1.0f, -1.0f};
  if (strcmp(profile, "px4-v1.5.5") != 0) return NULL;
  struct battery* b = malloc(sizeof *b);
  if (b != NULL) *b = fresh;
  return b;
}

static int battery_set_parameter(void* self, const char* name, float value) {
  struct battery* b = self;
  if (strcmp(name, "BAT_N_CELLS") == 0) {
    b->cells = value;
  } else if (strcmp(name, "BAT_V_EMPTY") == 0) {
    b->empty = value;
  } else if (strcmp(name, "BAT_V_CHARGED") == 0) {
    b->charged = value;
  } else if (strcmp(name, "BAT_V_LOAD_DROP") == 0) {
    b->drop = value;
  } else if (strcmp(name, "BAT_R_INTERNAL") == 0) {
    b->resistance = value;
  } else {
    return ATTEST_INVALID;
  }
  return ATTEST_OK;
}

/* A first-order filter that keeps its state where the result would not be finite. */
static void follow(float* state, float sample) {
  const float next = *state * 0.99f + sample * 0.01f;
  if (isfinite(next)) *state = next;
}

static int battery_step(void* self, const attest_battery_inputs* in, attest_battery_outputs* out) {
  struct battery* b = self;
  const float voltage = in->battery.voltage_v;
  const float range = b->charged - b->empty;
  float empty = b->empty;
  if (b->filtered_v < 0.0f) b->filtered_v = voltage;
  follow(&b->filtered_v, voltage);
  if (b->resistance >= 0.0f) {
    empty -= in->battery.current_a * b->resistance;
  } else {
    const float load = (fabsf(in->battery.throttle) + 0.1f) / 1.1f;
    empty -= b->drop * (in->battery.armed ? load : 0.0f);
  }
  follow(&b->remaining, (voltage - b->cells * empty) / (b->cells * range));
  b->remaining = between(0.0f, b->remaining, 1.0f);
  float scale = b->charged / (b->empty + range * b->remaining);
  if (scale > 1.3f) scale = 1.3f;
  if (!isfinite(scale) || scale < 1.0f) scale = 1.0f;
  out->battery_status.scale = b->filtered_v > 2.1f ? scale : 1.0f;
  return ATTEST_OK;
}

/* ---- the port --------------------------------------------------------------------------------*/

static const void* extension(const char* id) {
  static const attest_mixer mixer = {mixer_create, free, mixer_step};
  static const attest_battery_status battery = {battery_create, free, battery_set_parameter,
                                                battery_step};
  if (strcmp(id, ATTEST_EXTENSION_MIXER) == 0) return &mixer;
  if (strcmp(id, ATTEST_EXTENSION_BATTERY_STATUS) == 0) return &battery;
  return NULL;
}

ATTEST_EXPORT const attest_unit* attest_unit_v1(void) {
  static attest_unit table;
  table = *attest_starter_unit_v1();
  table.name = "with-actuation";
  table.extension = extension;
  return &table;
}
