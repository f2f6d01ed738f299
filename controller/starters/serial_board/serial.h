/* SPDX-License-Identifier: BSD-3-Clause */
/* serial.h - a serial line, for you to implement: uart_mps2.c is an example. 8 bits, no parity, no
 * flow control. The line may lose, repeat and change bytes. */
#ifndef SERIAL_H
#define SERIAL_H

#include <stddef.h>
#include <stdint.h>

/* Called once, first. Sets the baud rate. */
void serial_open(void);

/* Waits for a byte. */
uint8_t serial_read(void);

/* Sends `size` bytes. */
void serial_write(const uint8_t* bytes, size_t size);

#endif /* SERIAL_H */
