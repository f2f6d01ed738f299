/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * wrapper.h - a port that is the C starter with one thing changed.
 *
 * The starter's sources are linked into every port with their entry point renamed. A wrapper
 * exports its own attest_unit_v1() with the functions below, and replaces one of them. Each
 * wrapper says at its top how the host must judge it.
 */
#ifndef ATTEST_TESTS_PORTS_WRAPPER_H
#define ATTEST_TESTS_PORTS_WRAPPER_H

#include <attest_unit.h>
#include <stdint.h>
#include <stdlib.h>

/* The starter's attest_unit_v1(). */
const attest_unit* attest_starter_unit_v1(void);

/* Counted from 0: late enough that earlier steps were compared and found right. */
#define WRAPPER_FAULT_STEP 20u

typedef struct wrapper {
  void* law;           /* instance of the starter */
  uint32_t step_index; /* of the step that runs, or runs next */
} wrapper;

static inline void* wrapper_create(const char* profile) {
  wrapper* w = calloc(1, sizeof *w);
  if (w == NULL) return NULL;
  w->law = attest_starter_unit_v1()->create(profile);
  if (w->law == NULL) {
    free(w);
    return NULL;
  }
  return w;
}

static inline void wrapper_destroy(void* self) {
  wrapper* w = self;
  attest_starter_unit_v1()->destroy(w->law);
  free(w);
}

static inline int wrapper_set_parameter(void* self, const char* name, float value) {
  wrapper* w = self;
  return attest_starter_unit_v1()->set_parameter(w->law, name, value);
}

static inline int wrapper_step(void* self, const attest_inputs* in, attest_outputs* out) {
  wrapper* w = self;
  w->step_index++;
  return attest_starter_unit_v1()->step(w->law, in, out);
}

/* Whether the step that begins now must go wrong. */
static inline int wrapper_fault_is_due(const void* self) {
  const wrapper* w = self;
  return w->step_index == WRAPPER_FAULT_STEP;
}

/* Defines the exported symbol. */
#define WRAPPER_UNIT(name_, create_, step_)     \
  const attest_unit* attest_unit_v1(void) {     \
    static const attest_unit unit = {           \
        .abi_version = ATTEST_UNIT_ABI_VERSION, \
        .name = name_,                          \
        .version = "0.1.0",                     \
        .create = create_,                      \
        .destroy = wrapper_destroy,             \
        .set_parameter = wrapper_set_parameter, \
        .step = step_,                          \
        .extension = NULL,                      \
    };                                          \
    return &unit;                               \
  }                                             \
  _Static_assert(1, "takes the semicolon of the use")

#endif /* ATTEST_TESTS_PORTS_WRAPPER_H */
