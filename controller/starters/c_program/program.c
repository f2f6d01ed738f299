/* SPDX-License-Identifier: BSD-3-Clause */
#include "program.h"

#include <string.h>

#include "modules.h"

/* 1, or 0 for a board with less than 100 kB of memory: the outputs of a batch need most of it.
 * attest then asks for one step after the other. */
#ifndef PROGRAM_BATCH
#define PROGRAM_BATCH 1
#endif

/* The frequency of cost_end(), or 0: the program does not count. */
#ifndef PROGRAM_CLOCK_HZ
#define PROGRAM_CLOCK_HZ 0
#endif
#define TEXT_OF(number) #number
#define COST_OF(clock_hz) ",\"cost\":{\"unit\":\"cycles\",\"clock_hz\":" TEXT_OF(clock_hz) "}"

enum { COUNTS = PROGRAM_CLOCK_HZ > 0, COST_SIZE = COUNTS ? 2 * sizeof(uint32_t) : 0 };
enum { CREATE = 1, DESTROY, SET_PARAMETER, STEP, BATCH };
enum { MAX_BATCH = PROGRAM_BATCH ? 1024 : 1, MAX_TEXT = 4096, MAX_PROFILE = 64, MAX_UNITS = 64 };

typedef struct {
  uint32_t size, kind, unit, sequence;
} header;

/* ---- answers ---------------------------------------------------------------------------------*/

/* An answer, and in the handshake a line. Too long a handshake has no end, and attest says so. */
static unsigned char answer[8192 + MAX_BATCH * (sizeof(module_outputs) + COST_SIZE)];
static size_t answer_size;

static void put(const void* from, size_t size) {
  if (size > sizeof answer - answer_size) return;
  memcpy(answer + answer_size, from, size);
  answer_size += size;
}

static void put_number(uint32_t number) { put(&number, sizeof number); }

static void put_text(const char* text) { put(text, strlen(text)); }

static void send_answer(const header* head) {
  header of_answer = *head;
  of_answer.size = (uint32_t)(answer_size - sizeof of_answer);
  memcpy(answer, &of_answer, sizeof of_answer);
  connection_write(answer, answer_size);
}

/* ---- requests --------------------------------------------------------------------------------*/

typedef struct {
  void* self; /* NULL if the entry is free */
  uint32_t number, module;
  module_outputs out; /* the same struct for every step, as the ABI says */
} instance;

static instance instances[MAX_UNITS];

static instance* find(uint32_t number) {
  for (int i = 0; i < MAX_UNITS; ++i) {
    if (instances[i].self && instances[i].number == number) return &instances[i];
  }
  return NULL;
}

static uint32_t create(uint32_t number, const char* payload) {
  struct {
    uint32_t module, length;
  } start;
  char profile[MAX_PROFILE] = {0};
  memcpy(&start, payload, sizeof start);
  if (start.length >= MAX_PROFILE) return ATTEST_UNSUPPORTED;
  memcpy(profile, payload + sizeof start, start.length);
  for (int i = 0; i < MAX_UNITS; ++i) {
    if (instances[i].self) continue;
    memset(&instances[i], 0, sizeof instances[i]);
    instances[i].number = number;
    instances[i].module = start.module;
    instances[i].self = module_create(start.module, profile, payload + sizeof start + start.length);
    return instances[i].self ? ATTEST_OK : ATTEST_UNSUPPORTED;
  }
  return ATTEST_UNSUPPORTED;
}

/* Requests without steps. Returns 0 if the connection ended. */
static int serve_text(const header* head) {
  static char payload[MAX_TEXT + 1];
  instance* const unit = find(head->unit);
  float value;
  if (head->size > MAX_TEXT || !connection_read(payload, head->size)) return 0;
  payload[head->size] = '\0';
  if (head->kind == CREATE) {
    put_number(create(head->unit, payload));
  } else if (head->kind == SET_PARAMETER && unit) {
    memcpy(&value, payload, sizeof value);
    put_number(
        (uint32_t)module_set_parameter(unit->module, unit->self, payload + sizeof value, value));
  } else if (head->kind == DESTROY && unit) {
    module_destroy(unit->module, unit->self);
    unit->self = NULL;
    put_number(ATTEST_OK);
  } else {
    put_number(ATTEST_INVALID);
  }
  return 1;
}

/* Reads the inputs of a step, steps, and adds outputs and cost to the answer. Returns 0 if the
 * connection ended. */
static int serve_step(instance* unit, uint32_t* result) {
  struct {
    uint64_t timestamp_sample;
    module_inputs in;
  } timed;
  const attest_timestamp_sample* const sample = port_extension(ATTEST_EXTENSION_TIMESTAMP_SAMPLE);
  if (!connection_read(&timed, sizeof timed.timestamp_sample + modules[unit->module].inputs)) {
    return 0;
  }
  uint32_t cost = 0;
  if (*result != ATTEST_OK) return 1; /* a batch ends with the first error */
  if (sample && unit->module == CONTROLLER) {
    *result = (uint32_t)sample->set_timestamp_sample(unit->self, timed.timestamp_sample);
  }
  if (*result == ATTEST_OK) {
    if (COUNTS) cost_begin();
    *result = (uint32_t)module_step(unit->module, unit->self, &timed.in, &unit->out);
    if (COUNTS) cost = cost_end();
  }
  put(&unit->out, modules[unit->module].outputs);
  if (COUNTS) put_number(cost);
  if (COUNTS) put_number(stack_used());
  return 1;
}

/* `step` and `batch`. The inputs of a batch are read step by step, so they need no memory. */
static int serve_steps(const header* head, instance* unit) {
  uint32_t result = ATTEST_OK, done = 0;
  struct {
    uint32_t steps, zero;
  } batch = {1, 0};
  if (head->kind == BATCH && !connection_read(&batch, sizeof batch)) return 0;
  const size_t at = answer_size;
  put_number(result);
  if (head->kind == BATCH) put_number(done);
  for (uint32_t i = 0; i < batch.steps; ++i) {
    if (!serve_step(unit, &result)) return 0;
    done += result == ATTEST_OK;
  }
  memcpy(answer + at, &result, sizeof result);
  if (head->kind == BATCH) {
    memcpy(answer + at + sizeof result, &done, sizeof done);
    answer_size = at + sizeof result + sizeof done;
    answer_size += done * (modules[unit->module].outputs + COST_SIZE);
  }
  return 1;
}

void program_serve(void) {
  header head;
  while (connection_read(&head, sizeof head)) {
    instance* const unit = find(head.unit);
    answer_size = sizeof head;
    if (head.kind != STEP && head.kind != BATCH) {
      if (!serve_text(&head)) break;
    } else if (!unit || !serve_steps(&head, unit)) {
      break;
    }
    send_answer(&head);
  }
  for (int i = 0; i < MAX_UNITS; ++i) {
    if (instances[i].self) module_destroy(instances[i].module, instances[i].self);
    instances[i].self = NULL;
  }
}

/* ---- the handshake ---------------------------------------------------------------------------*/

/* The versions of the law. */
static const char* const profiles[] = {"px4-v1.3.4",  "px4-v1.5.5", "px4-v1.14.4", "px4-v1.15.4",
                                       "px4-v1.16.0", "px4-v1.17",  "px4-v1.18"};

static int supports(const char* profile) {
  for (uint32_t module = 0; module < MODULES; ++module) {
    void* const self = module_create(module, profile, "R: 4x 10000 10000 10000 0");
    if (!self) continue;
    module_destroy(module, self);
    return 1;
  }
  return 0;
}

static void put_list(const char* name) {
  put_text(",\"");
  put_text(name);
  put_text("\":[");
}

/* Adds a word to a list. */
static void put_word(const char* word, size_t size) {
  if (answer[answer_size - 1] != '[') put_text(",");
  put_text("\"");
  put(word, size);
  put_text("\"");
}

/* A list in an extension is text, with commas. */
static void put_words(const char* name, const char* text) {
  if (!text) return;
  put_list(name);
  while (*text) {
    const size_t size = strcspn(text, ", ");
    if (size) put_word(text, size);
    text += size + (text[size] != '\0');
  }
  put_text("]");
}

static void put_member(const char* name, const char* text) {
  if (!text) return;
  put_text(",\"");
  put_text(name);
  put_text("\":\"");
  put_text(text);
  put_text("\"");
}

int program_greet(const char* frames) {
  char byte;
  do { /* the line of attest has nothing that this program needs */
    if (!connection_read(&byte, 1)) return 0;
  } while (byte != '\n');
  answer_size = 0;
  put_text("{\"protocol\":1");
  put_member("name", attest_unit_v1()->name);
  put_member("version", attest_unit_v1()->version);
  put_member("frames", frames);
  if (PROGRAM_BATCH) put_text(",\"batch\":true");
  if (COUNTS) put_text(COST_OF(PROGRAM_CLOCK_HZ));
  put_list("profiles");
  for (size_t i = 0; i < sizeof profiles / sizeof profiles[0]; ++i) {
    if (supports(profiles[i])) put_word(profiles[i], strlen(profiles[i]));
  }
  put_text("]");
  put_list("modules");
  for (uint32_t module = MIXER; module < MODULES; ++module) {
    if (port_extension(modules[module].extension)) {
      put_word(modules[module].name, strlen(modules[module].name));
    }
  }
  put_text("]");
  put_words("unsupported_groups", port_extension(ATTEST_EXTENSION_UNSUPPORTED_GROUPS));
  put_words("lacks", port_extension(ATTEST_EXTENSION_LACKS));
  put_member("arithmetic", port_extension(ATTEST_EXTENSION_ARITHMETIC));
  put_member("fixed_step", port_extension(ATTEST_EXTENSION_FIXED_STEP));
  put_text("}\n");
  connection_write(answer, answer_size);
  return 1;
}
