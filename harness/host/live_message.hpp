// The request "fly_live" (host_protocol.hpp) and its answer: the measurements of a flight in real
// time. The judge computes all figures from them. Two blobs follow for each unit: its ticks, and
// the samples of the first ones.
//
//     {"units": [{"ticks": n, "skipped": n, "usage": {...}, "parameters": [...], "fault"}, ...],
//      "plant": {"late_steps": n, "usage": {...}, "latency": {...}}, "privileges": [...],
//      "divergence"}
//     {"fault": {...}}      LiveFlight::fault
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/core/json_reader.hpp"
#include "harness/host/trace_message.hpp"
#include "harness/process/message_socket.hpp"
#include "harness/realtime/live_flight.hpp"

namespace attest {

// The head of the request "fly_live", and the plan in it.
std::string live_request(const LivePlan& plan);
LivePlan live_plan_from(const nlohmann::json& head);

nlohmann::json to_json(const Usage& usage);
nlohmann::json to_json(const std::vector<RealtimePrivilege>& privileges);

// `blobs` receives those that follow. They refer to `flight`.
nlohmann::json live_json(const LiveFlight& flight, std::vector<Blob>& blobs);

// The flight that an answer must be of.
struct LiveRequest {
  const Case& the_case;
  const LivePlan& plan;
  Nanoseconds longest{0};          // no time in the answer is longer
  bool was_asked_to_stop = false;  // the flight may be shorter than its case
};

// Reports to `head` what attest's code in the port's process would not send: a wrong member, a time
// out of the flight, or a flight that is short without a reason. The result is then incomplete.
// `of_program`: as for fault_from().
LiveFlight live_from(const LiveRequest& request, bool of_program, JsonReader& head,
                     BlobReader& blobs);

}  // namespace attest
