// The last message of the child process of a stress run: the measurements of the flight. For each
// unit three blobs follow: samples, ticks, LoopTick::commanded (-1 if it is empty).
//
//     {"units": [{"stress": {...}, "ticks": n, "samples": n, "commanded": n, "parameters": [...],
//                 "fault"}, ...], "divergence"}
//     {"refused": true, "fault"}                      the port did not make all units
#pragma once

#include <chrono>

#include "harness/core/json_reader.hpp"
#include "harness/host/trace_message.hpp"
#include "harness/measure/stress.hpp"
#include "harness/process/message_socket.hpp"

namespace attest {

// The child of a stress run sends a message at least this often.
inline constexpr auto report_every = std::chrono::seconds(1);

// The times of a flight end before this: a step may be late, but its port must answer in time.
Nanoseconds longest_of(const StressTask& task);

void send_measured(const StressMeasurement& measured, MessageSocket& parent);

// Reads the message of a flight. Reports to `head` what attest's code in the child would not send:
// a wrong member, a time out of the flight, or a flight that is short without a reason. The result
// is then incomplete. `of_program`: as for fault_from(). `was_asked_to_stop`: the flight may be
// shorter than its case.
StressMeasurement measurement_from(const StressTask& task, bool of_program, bool was_asked_to_stop,
                                   JsonReader& head, BlobReader& blobs);

}  // namespace attest
