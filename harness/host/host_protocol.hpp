// The messages between a judge and the process of a port (message_socket.hpp): a head in JSON, and
// structs as they are in memory. Both processes are forks of one process, so the structs have the
// same layout. In this list, the structs stand on the right. "fault" and "divergence" are present
// only if there was one.
//
//     process -> {"request": 0, "says": {...}}              once, when the port is loaded
//     judge   -> {"do": "drive", "subject": ..., ...}       the module's inputs, tick by tick
//     process -> {"request": 1, "fault": {...}}             its outputs
//     judge   -> {"do": "fly", "configuration": ...}        LoopTicks of the unit, those of the
//                                                           attitude unit (empty: no cascade)
//     process -> {"request": 2, "fault", "divergence", "parameters", ...}
//                                                           samples, plant samples
//                of the cascade also "attitude_ticks", "attitude_parameters"
//                                                           and the attitude unit's samples
//     judge   -> {"do": "fly_live", ...}                    (a LivePlan)
//     process -> {"request": 3, "units": [...], ...}        live_message.hpp
//     judge   -> {"do": "time", "subject": ..., ...}        the module's inputs, tick by tick
//     process -> {"request": 4, "fault", "clock_ns", "steps", "stack"}
//                                                           nanoseconds of each step; of a
//                port that counts its cost: "costs"         StepCost of each step
//     judge   -> {"do": "supports", "profile": ...}
//     process -> {"request": 5, "supports": true}
//
// A long trace is driven in several requests, one for each Part (open_loop.hpp).
//
// "request" counts the requests, which may come in any order. {"request": n, "fault": {...}} alone
// is the answer to any request if a program ended, or broke its protocol, outside of a step. Other
// kinds of fault come alone only in place of a live flight.
//
// {"request": n, "error": {...}} replaces the greeting if the port cannot be loaded, and the answer
// to "fly", "fly_live" or "time" if attest cannot do that. The port's code runs in that process, so
// the judge does not trust its messages. It checks each member where it arrives: its type, and its
// range. A message with a wrong member, or that does not answer its request, is a broken protocol.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "harness/host/live_message.hpp"
#include "harness/host/port_host.hpp"
#include "harness/host/trace_message.hpp"
#include "harness/process/message_socket.hpp"

namespace attest {

// Of the judge: the heads of its requests.
std::string drive_request(const ModuleUnderTest& subject, std::size_t ticks,
                          const std::vector<ParameterChange>& changes);
std::string fly_request(const FlightPlan& plan);
std::string time_request(const ModuleUnderTest& subject, const Trace& inputs, bool with_stack);
std::string supports_request(const std::string& profile);

// A message that has arrived, and the number of the request that it must answer.
struct Arrived {
  const std::string& head;
  BlobReader& blobs;
  std::uint64_t request;
  bool of_program = false;  // the port is a program, which may end while its host goes on
};

// Errors of the readers: the message is not a valid answer to that request; the text names the
// member. A valid answer has all `ticks` ticks. A flight or a timing may have fewer, if the answer
// has the fault or divergence that ended it. The error in a result of a reader is that of an answer
// with "error". `ticks_before`: of the trace, before its part in this answer.
struct Driven {
  std::vector<std::byte> outputs;  // of the subject's module (ModuleInfo::out)
  std::optional<PortFault> fault;
};
Result<Driven> read_driven(const Arrived& arrived, const ModuleUnderTest& subject,
                           std::size_t ticks);
// The traces of the result have no `source`. `duration`: of the case.
Result<Result<Flown>> read_flown(const Arrived& arrived, const FlightPlan& plan,
                                 Nanoseconds duration);
Result<Result<LiveFlight>> read_live(const Arrived& arrived, const LiveRequest& request);
// `counts`: the port declared that it counts its cost.
Result<Result<StepTimes>> read_times(const Arrived& arrived, std::size_t ticks, bool counts);
Result<bool> read_supports(const Arrived& arrived);
Result<Result<Declarations>> read_greeting(const Arrived& arrived);
// Reads an answer of a program's host that is a fault only: Kind::crash or Kind::protocol. Empty:
// it is another answer.
std::optional<PortFault> read_fault(const Arrived& arrived);

// Of the port's process.
bool greet(const Declarations& says, MessageSocket& judge);
bool refuse(const Error& error, std::uint64_t request, MessageSocket& judge);
bool give_fault(const PortFault& fault, std::uint64_t request, MessageSocket& judge);

// Handles the request and sends the answer. False when the judge has gone.
bool answer(const Arrived& question, PortHost& host, MessageSocket& judge);

}  // namespace attest
