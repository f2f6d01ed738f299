/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * The connection of the program over a serial line, with bridge.py on the other side.
 *
 * Both sides send packets:
 *
 *     bridge to board    sequence number, limit of data in the answer, data, CRC-32
 *     board to bridge    sequence number, data, CRC-32
 *
 * A packet is encoded by COBS, so that it has no zero byte, and stands between zero bytes: after a
 * fault both sides find the next packet at the next zero. The bridge sends a packet until the board
 * has answered it. The board has no timer: it answers each packet once more if it comes again, and
 * asks for a damaged one. A session begins with a packet START; the packets that follow count 1 to
 * 250, then 1 again. Data is the stream of bytes of PROTOCOL.md, in pieces.
 */
#include "serial.h"

#include <string.h>

#include "board.h"
#include "program.h"

enum { START = 0, LAST = 250, FAULT = 253, DAMAGED = 254, NO_SESSION = 255 };
enum { MAX_DATA = 240, CRC_SIZE = 4, MAX_PACKET = 2 + MAX_DATA + CRC_SIZE };

static uint8_t sequence = NO_SESSION; /* of the last packet of the bridge, or NO_SESSION */
static uint8_t received[MAX_PACKET];
static size_t received_at, received_end; /* the data that the program has not read */
static uint8_t reply[MAX_DATA];
static size_t reply_size, reply_limit;
static int is_over; /* a new session has begun, which ends the program's reading */

/* ---- packets ---------------------------------------------------------------------------------*/

/* The CRC of Ethernet and zip. */
static uint32_t crc_of(const uint8_t* bytes, size_t size) {
  uint32_t crc = 0xffffffffu;
  for (size_t i = 0; i < size; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xedb88320u & (0u - (crc & 1u)));
  }
  return ~crc;
}

/* COBS: each zero becomes the distance to the next one. A packet has fewer than 254 bytes. */
static void send(uint8_t number, const void* data, size_t size) {
  uint8_t packet[MAX_PACKET], line[MAX_PACKET + 3];
  size_t at = 1, end = 2;
  packet[0] = number;
  memcpy(packet + 1, data, size);
  const uint32_t crc = crc_of(packet, 1 + size);
  for (int i = 0; i < CRC_SIZE; ++i) packet[1 + size + (size_t)i] = (uint8_t)(crc >> 8 * i);
  line[0] = 0;
  for (size_t i = 0; i < 1 + size + CRC_SIZE; ++i, ++end) {
    line[end] = packet[i];
    if (packet[i] != 0) continue;
    line[at] = (uint8_t)(end - at);
    at = end;
  }
  line[at] = (uint8_t)(end - at);
  line[end++] = 0;
  serial_write(line, end);
}

/* Waits for the next packet. Returns its size without the CRC, or 0 if it is damaged. */
static size_t receive(void) {
  size_t size = 0, left = 0; /* bytes until the next zero */
  int is_too_long = 0;
  uint8_t byte;
  while ((byte = serial_read()) == 0) continue;
  for (left = byte; (byte = serial_read()) != 0;) {
    is_too_long |= size == MAX_PACKET;
    if (is_too_long) continue;
    received[size++] = --left == 0 ? 0 : byte;
    if (left == 0) left = byte;
  }
  if (is_too_long || left != 1 || size < 2 + CRC_SIZE) return 0;
  size -= CRC_SIZE;
  const uint32_t crc = crc_of(received, size);
  for (int i = 0; i < CRC_SIZE; ++i) {
    if (received[size + (size_t)i] != (uint8_t)(crc >> 8 * i)) return 0;
  }
  return size;
}

/* ---- the session -----------------------------------------------------------------------------*/

/* Answers the last packet and waits for the next one. Returns 0 if a session begins. */
static int next_packet(void) {
  if (sequence != NO_SESSION) send(sequence, reply, reply_size);
  for (;;) {
    const size_t size = receive();
    if (size == 0) {
      send(DAMAGED, NULL, 0);
    } else if (received[0] == START) {
      is_over = 1;
      return 0;
    } else if (sequence == NO_SESSION) {
      send(NO_SESSION, NULL, 0);
    } else if (received[0] == sequence) {
      send(sequence, reply, reply_size);
    } else if (received[0] == sequence % LAST + 1) {
      sequence = received[0];
      reply_limit = received[1] < MAX_DATA ? received[1] : MAX_DATA;
      reply_size = 0;
      received_at = 2;
      received_end = size;
      return 1;
    }
  }
}

int connection_read(void* to, size_t size) {
  uint8_t* const bytes = to;
  for (size_t i = 0; i < size; ++i) {
    while (received_at == received_end) {
      if (is_over || !next_packet()) return 0;
    }
    bytes[i] = received[received_at++];
  }
  return 1;
}

void connection_write(const void* from, size_t size) {
  const uint8_t* const bytes = from;
  for (size_t i = 0; i < size; ++i) {
    while (reply_size >= reply_limit) {
      if (is_over || !next_packet()) return;
    }
    reply[reply_size++] = bytes[i];
  }
}

_Noreturn void board_fail(const char* reason) {
  const size_t size = strlen(reason);
  for (;;) {
    send(FAULT, reason, size < MAX_DATA ? size : MAX_DATA);
    receive();
  }
}

int main(void) {
  serial_open();
  while (!is_over) next_packet();
  for (;;) {
    is_over = 0;
    sequence = START;
    reply_size = reply_limit = received_at = received_end = 0;
    if (program_greet("binary")) program_serve();
  }
}
