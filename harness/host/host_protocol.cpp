#include "harness/host/host_protocol.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/error_json.hpp"
#include "harness/core/json_text.hpp"
#include "harness/core/printable.hpp"
#include "harness/host/declarations_json.hpp"
#include "harness/realtime/painted_stack.hpp"

namespace attest {
namespace {

using nlohmann::json;

json to_json(const ModuleUnderTest& subject) {
  return {{"profile", subject.profile},
          {"module", subject.module},
          {"mixer", subject.mixer},
          {"instances", subject.instances},
          {"first_tick", subject.part.first_tick},
          {"is_last", subject.part.is_last},
          {"other_profiles", subject.other_profiles}};
}

ModuleUnderTest subject_from(const json& in) {
  return {in.at("profile").get<std::string>(),
          in.at("module").get<Module>(),
          in.at("mixer").get<std::string>(),
          in.at("instances").get<Instances>(),
          {in.at("first_tick").get<std::size_t>(), in.at("is_last").get<bool>()},
          in.at("other_profiles").get<std::vector<std::string>>()};
}

// Reads the trace of a request. The judge is trusted, so the inputs are there.
Trace trace_from(const json& head, Module module, BlobReader& blobs) {
  Trace trace;
  const std::size_t ticks = head.at("ticks").get<std::size_t>();
  trace.samples.resize(ticks);
  const Block inputs = info_of(module).all_inputs();
  inputs.paste(blobs.read<std::byte>(ticks * inputs.size).value(), trace.samples);
  std::string error;
  JsonReader reader(head, error);
  trace.parameters = changes_from(reader, "parameters", SIZE_MAX);
  return trace;
}

// Handles one request in the port's process.
class Answerer {
 public:
  Answerer(const Arrived& question, PortHost& host, MessageSocket& judge)
      : question_(question), host_(host), judge_(judge) {}

  bool answer() {
    const json head = json_from(question_.head);
    const std::string what = head.at("do").get<std::string>();
    if (what == "drive") return drive(head);
    if (what == "fly") return fly(head);
    if (what == "fly_live") return fly_live(head);
    if (what == "time") return time(head);
    return send({{"supports", host_.supports(head.at("profile").get<std::string>())}});
  }

 private:
  bool drive(const json& head) {
    const ModuleUnderTest subject = subject_from(head.at("subject"));
    Trace trace = trace_from(head, subject.module, question_.blobs);
    json answer = json::object();
    set_end(host_.drive(subject, trace), {}, answer);
    const std::vector<std::byte> outputs = info_of(subject.module).out.copy(trace.samples);
    return send(std::move(answer), {blob_of(outputs)});
  }

  bool fly(const json& head) {
    FlightPlan plan;
    plan.configuration = configuration_from(head.at("configuration"));
    plan.timing.unit = ticks_from(head.at("ticks"));
    plan.timing.attitude_unit = ticks_from(head.at("attitude_ticks"));
    plan.from_one_period_on = head.at("from_one_period_on").get<bool>();
    const auto flown = host_.fly(plan);
    if (!flown) return refuse(flown.error(), question_.request, judge_);
    const Trace& trace = flown->trace;
    json answer = {{"ticks", trace.samples.size()}, {"parameters", changes_json(trace.parameters)}};
    set_end(flown->fault, flown->divergence, answer);
    std::vector<Blob> blobs{blob_of(trace.samples), blob_of(trace.plant)};
    if (const auto& attitude = flown->attitude_trace) {
      answer["attitude_ticks"] = attitude->samples.size();
      answer["attitude_parameters"] = changes_json(attitude->parameters);
      blobs.push_back(blob_of(attitude->samples));
    }
    return send(std::move(answer), blobs);
  }

  bool fly_live(const json& head) {
    const auto flight = host_.fly_live(live_plan_from(head), {});
    if (!flight) return refuse(flight.error(), question_.request, judge_);
    std::vector<Blob> blobs;
    json answer = live_json(*flight, blobs);
    return send(std::move(answer), blobs);
  }

  LoopTiming ticks_from(const json& count) {
    return question_.blobs.read<LoopTick>(count.get<std::size_t>()).value();
  }

  bool time(const json& head) {
    const ModuleUnderTest subject = subject_from(head.at("subject"));
    const Trace trace = trace_from(head, subject.module, question_.blobs);
    const auto times = host_.time_steps(subject, trace, head.at("stack").get<bool>());
    if (!times) return refuse(times.error(), question_.request, judge_);
    json answer = {{"clock_ns", times->clock.count()}, {"steps", times->steps.size()}};
    if (times->stack_bytes) answer["stack"] = *times->stack_bytes;
    set_end(times->fault, {}, answer);
    if (!host_.declarations().cost) return send(std::move(answer), {blob_of(times->steps)});
    answer["costs"] = times->costs.size();
    return send(std::move(answer), {blob_of(times->costs)});
  }

  bool send(json head, const std::vector<Blob>& blobs = {}) {
    head["request"] = question_.request;
    return judge_.send(text_of(head), blobs);
  }

  const Arrived& question_;
  PortHost& host_;
  MessageSocket& judge_;
};

// Reads an answer with `read`, which reports what is wrong to the reader.
template <typename Read>
auto read_answer(const Arrived& arrived, Read read)
    -> Result<std::invoke_result_t<Read, JsonReader&>> {
  const json head = json_from(arrived.head);
  std::string error;
  JsonReader reader(head, error);
  if (const auto request = reader.count("request"); request != arrived.request) {
    reader.wrong("request", fmt::format("is {}, not {}", request, arrived.request));
  }
  auto answer = read(reader);
  if (arrived.blobs.left() > 0) reader.wrong("it has more data than its head says");
  if (!error.empty()) return fail(printable_part(error));
  return Result<decltype(answer)>(tl::in_place, std::move(answer));
}

// Reads the number of ticks of a flight or of a timing.
std::size_t ticks_from(JsonReader& head, const char* key, std::size_t all, bool may_end_early) {
  const auto ticks = static_cast<std::size_t>(head.count(key, all));
  if (ticks < all && !may_end_early) {
    head.wrong(key, fmt::format("is {} of {}, and the answer does not say why", ticks, all));
  }
  return ticks;
}

Trace flown_trace(const Arrived& arrived, JsonReader& head, Module module, std::size_t ticks) {
  Trace trace;
  trace.samples = objects_from<Sample>(arrived.blobs, ticks, "samples", head);
  trace.present = channels_of(module);
  return trace;
}

// Reads the first part of a flight: the trace of the unit that commands the motors.
void read_motors_unit(const Arrived& arrived, const FlightPlan& plan, JsonReader& head,
                      Flown& flown) {
  const bool is_cascade = plan.configuration.rate.attitude_unit.has_value();
  const std::size_t all = plan.timing.unit.size();
  const std::size_t ticks = ticks_from(head, "ticks", all, flown.fault || flown.divergence);
  flown.trace =
      flown_trace(arrived, head, is_cascade ? Module::rate_unit : Module::mc_att_control, ticks);
  flown.trace.parameters = changes_from(head, "parameters", all);
  flown.trace.plant = objects_from<PlantSample>(arrived.blobs, ticks, "samples of the plant", head);
}

void read_attitude_unit(const Arrived& arrived, const FlightPlan& plan, JsonReader& head,
                        Flown& flown) {
  const std::size_t all = plan.timing.attitude_unit.size();
  const std::size_t ticks =
      ticks_from(head, "attitude_ticks", all, flown.fault || flown.divergence);
  flown.attitude_trace = flown_trace(arrived, head, Module::attitude_unit, ticks);
  flown.attitude_trace->parameters = changes_from(head, "attitude_parameters", all);
}

}  // namespace

std::string drive_request(const ModuleUnderTest& subject, std::size_t ticks,
                          const std::vector<ParameterChange>& changes) {
  return text_of({{"do", "drive"},
                  {"subject", to_json(subject)},
                  {"ticks", ticks},
                  {"parameters", changes_json(changes)}});
}

std::string fly_request(const FlightPlan& plan) {
  return text_of({{"do", "fly"},
                  {"configuration", to_json(plan.configuration)},
                  {"ticks", plan.timing.unit.size()},
                  {"attitude_ticks", plan.timing.attitude_unit.size()},
                  {"from_one_period_on", plan.from_one_period_on}});
}

std::string time_request(const ModuleUnderTest& subject, const Trace& inputs, bool with_stack) {
  return text_of({{"do", "time"},
                  {"subject", to_json(subject)},
                  {"stack", with_stack},
                  {"ticks", inputs.samples.size()},
                  {"parameters", changes_json(inputs.parameters)}});
}

std::string supports_request(const std::string& profile) {
  return text_of({{"do", "supports"}, {"profile", profile}});
}

Result<Driven> read_driven(const Arrived& arrived, const ModuleUnderTest& subject,
                           std::size_t ticks) {
  const std::size_t size = ticks * info_of(subject.module).out.size;
  return read_answer(arrived, [&](JsonReader& head) {
    Driven driven;
    driven.outputs = objects_from<std::byte>(arrived.blobs, size, "outputs", head);
    driven.fault = fault_from(head, subject.part.first_tick + ticks, arrived.of_program);
    return driven;
  });
}

Result<Result<Flown>> read_flown(const Arrived& arrived, const FlightPlan& plan,
                                 Nanoseconds duration) {
  return read_answer(arrived, [&](JsonReader& head) -> Result<Flown> {
    if (head.has("error")) return error_in(head);
    const FlightTiming& timing = plan.timing;
    Flown flown;
    flown.fault = fault_from(head, std::max(timing.unit.size(), timing.attitude_unit.size()),
                             arrived.of_program);
    flown.divergence = divergence_from(head, duration);
    read_motors_unit(arrived, plan, head, flown);
    if (plan.configuration.rate.attitude_unit) read_attitude_unit(arrived, plan, head, flown);
    return flown;
  });
}

Result<Result<LiveFlight>> read_live(const Arrived& arrived, const LiveRequest& request) {
  return read_answer(arrived, [&](JsonReader& head) -> Result<LiveFlight> {
    if (head.has("error")) return error_in(head);
    return live_from(request, arrived.of_program, head, arrived.blobs);
  });
}

Result<Result<StepTimes>> read_times(const Arrived& arrived, std::size_t ticks, bool counts) {
  return read_answer(arrived, [&](JsonReader& head) -> Result<StepTimes> {
    if (head.has("error")) return error_in(head);
    StepTimes times;
    times.fault = fault_from(head, ticks, arrived.of_program);
    if (counts) {
      const std::size_t count = ticks_from(head, "costs", ticks, times.fault.has_value());
      times.costs = objects_from<StepCost>(arrived.blobs, count, "costs", head);
      return times;
    }
    const std::size_t count = ticks_from(head, "steps", ticks, times.fault.has_value());
    times.steps = objects_from<Nanoseconds>(arrived.blobs, count, "steps", head);
    const auto is_sane = [](Nanoseconds step) {
      return step >= Nanoseconds(0) && step <= std::chrono::hours(1);
    };
    if (!std::ranges::all_of(times.steps, is_sane)) {
      head.wrong("steps", "has a duration that is negative or longer than an hour");
    }
    constexpr std::int64_t second_ns = 1'000'000'000;
    times.clock = Nanoseconds(head.integer("clock_ns", 0, second_ns));
    if (head.has("stack")) times.stack_bytes = head.count("stack", PaintedStack::size);
    return times;
  });
}

Result<bool> read_supports(const Arrived& arrived) {
  return read_answer(arrived, [](JsonReader& head) { return head.flag("supports"); });
}

std::optional<PortFault> read_fault(const Arrived& arrived) {
  if (!arrived.of_program) return std::nullopt;
  const auto fault = read_answer(arrived, [&](JsonReader& head) {
    auto found = fault_from(head, 0, arrived.of_program);
    if (!found || found->kind < PortFault::Kind::protocol) head.wrong("no fault of a program");
    return found;
  });
  return fault ? *fault : std::nullopt;
}

Result<Result<Declarations>> read_greeting(const Arrived& arrived) {
  return read_answer(arrived, [&](JsonReader& head) -> Result<Declarations> {
    if (head.has("error")) return error_in(head);
    return declarations_from(head.object("says"), arrived.of_program);
  });
}

bool greet(const Declarations& says, MessageSocket& judge) {
  return judge.send(text_of({{"request", 0}, {"says", to_json(says)}}));
}

bool refuse(const Error& error, std::uint64_t request, MessageSocket& judge) {
  return judge.send(text_of({{"request", request}, {"error", attest::to_json(error)}}));
}

bool give_fault(const PortFault& fault, std::uint64_t request, MessageSocket& judge) {
  json head = {{"request", request}};
  set_end(fault, {}, head);
  return judge.send(text_of(head));
}

bool answer(const Arrived& question, PortHost& host, MessageSocket& judge) {
  return Answerer(question, host, judge).answer();
}

}  // namespace attest
