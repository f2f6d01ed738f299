/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * program.h - answers the requests of PROTOCOL.md with a port that implements attest_unit.h, over
 * any connection: pipes, shared memory, a debugger or a serial line.
 *
 *     connection        one of host.c, or of a board
 *     program_greet()   the handshake
 *     program_serve()   all requests until the connection ends
 *
 * Both run on the same thread. Frames are binary, so the machine must be little-endian.
 */
#ifndef PROGRAM_H
#define PROGRAM_H

#include <stddef.h>
#include <stdint.h>

/* ---- the connection, for you to implement ----------------------------------------------------*/

/* Waits for `size` bytes from attest. Returns 0 if the connection ended before. */
int connection_read(void* to, size_t size);

/* Sends the handshake or a complete answer. */
void connection_write(const void* from, size_t size);

/* ---- the cost of a step ----------------------------------------------------------------------*/

/* Only with -DPROGRAM_CLOCK_HZ=<frequency>, for you to implement: ../cortex_m/arm.c is an
 * example. The program then reports what each step costs. */

/* Called before a step. */
void cost_begin(void);

/* Called after the step. Returns the cycles since cost_begin(), of that frequency. */
uint32_t cost_end(void);

/* The largest size of the stack until now, in bytes. 0 if it is not measured. */
uint32_t stack_used(void);

/* ---- the program -----------------------------------------------------------------------------*/

/* Answers the first line of attest. `frames` is "binary" or "shared". Returns 0 if the connection
 * ended before. */
int program_greet(const char* frames);

/* Answers requests until the connection ends, and then destroys the units that are left. */
void program_serve(void);

#endif /* PROGRAM_H */
