/* SPDX-License-Identifier: BSD-3-Clause */
/* The program of the board on the host, to try it without a board: its line is a pseudo-terminal,
 * which bridge.py opens as its stdin and stdout. */
#include <stdlib.h>
#include <unistd.h>

#include "serial.h"

void serial_open(void) {}

uint8_t serial_read(void) {
  static uint8_t bytes[512];
  static ssize_t at, end;
  if (at == end) {
    at = 0;
    end = read(STDIN_FILENO, bytes, sizeof bytes);
    if (end <= 0) exit(EXIT_SUCCESS); /* the bridge has closed the line */
  }
  return bytes[at++];
}

void serial_write(const uint8_t* bytes, size_t size) {
  while (size > 0) {
    const ssize_t done = write(STDOUT_FILENO, bytes, size);
    if (done <= 0) exit(EXIT_FAILURE);
    bytes += done;
    size -= (size_t)done;
  }
}
