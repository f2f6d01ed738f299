/* SPDX-License-Identifier: BSD-3-Clause */
/* The UART of the emulated board (mps2-an386). Put that of your board in its place. */
#include "serial.h"

typedef struct {
  volatile uint32_t data, state, control, interrupt, divider;
} uart;

static uart* const line = (uart*)0x40004000;

enum { FULL_TO_SEND = 1, FULL_RECEIVED = 2 };

void serial_open(void) {
  line->divider = 25000000 / 115200; /* the clock, in Hz, and the baud rate */
  line->control = 3;                 /* sends and receives */
}

uint8_t serial_read(void) {
  while (!(line->state & FULL_RECEIVED)) continue;
  return (uint8_t)line->data;
}

void serial_write(const uint8_t* bytes, size_t size) {
  for (size_t i = 0; i < size; ++i) {
    while (line->state & FULL_TO_SEND) continue;
    line->data = bytes[i];
  }
}
