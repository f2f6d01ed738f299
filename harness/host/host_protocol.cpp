#include "harness/host/host_protocol.hpp"

#include <utility>

#include <nlohmann/json.hpp>

#include "harness/core/error_json.hpp"
#include "harness/core/json_text.hpp"

namespace attest {
namespace {

using nlohmann::json;

json to_json(const Subject& subject) {
  return {{"profile", subject.profile},
          {"module", subject.module},
          {"mixer", subject.mixer},
          {"instances", subject.instances},
          {"first_tick", subject.part.first_tick},
          {"is_last", subject.part.is_last}};
}

json to_json(const PortSays& says) {
  json out = {{"name", says.name},
              {"version", says.version},
              {"unsupported_groups", says.unsupported_groups},
              {"modules", says.modules.to_ulong()}};
  if (says.fraction_bits) out["fraction_bits"] = *says.fraction_bits;
  if (says.fixed_step) out["fixed_step"] = says.fixed_step->to_string();
  return out;
}

PortSays says_from(const json& in) {
  PortSays says{in.at("name").get<std::string>(),
                in.at("version").get<std::string>(),
                in.at("unsupported_groups").get<std::vector<std::string>>(),
                {},
                {},
                ModuleSet(in.at("modules").get<unsigned long>()),
                {}};
  if (in.contains("fraction_bits")) says.fraction_bits = in.at("fraction_bits").get<int>();
  if (const auto step = Rate::parse(in.value("fixed_step", ""))) says.fixed_step = *step;
  return says;
}

Subject subject_from(const json& in) {
  return {in.at("profile").get<std::string>(),
          in.at("module").get<Module>(),
          in.at("mixer").get<std::string>(),
          in.at("instances").get<Instances>(),
          {in.at("first_tick").get<std::size_t>(), in.at("is_last").get<bool>()}};
}

// Reads the trace of a request. The judge is trusted, so the samples are there.
Trace trace_from(const json& head, BlobReader& blobs) {
  Trace trace;
  trace.samples = blobs.read<Sample>(head.at("ticks").get<std::size_t>()).value();
  trace.parameters = changes_from(head.at("parameters"));
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
    if (what == "time") return time(head);
    return send({{"supports", host_.supports(head.at("profile").get<std::string>())}});
  }

 private:
  bool drive(const json& head) {
    Trace trace = trace_from(head, question_.blobs);
    json answer = json::object();
    set_end(host_.drive(subject_from(head.at("subject")), trace), {}, answer);
    return send(std::move(answer), {blob_of(trace.samples)});
  }

  bool fly(const json& head) {
    FlightPlan plan;
    plan.configuration.rate = LoopRate::parse(head.at("rate").get<std::string>()).value();
    plan.configuration.plant_configuration = PlantConfiguration{
        head.at("vehicle").get<std::string>(), head.at("plant").get<PlantKind>()};
    plan.timing.unit = ticks_from(head.at("ticks"));
    plan.timing.attitude_unit = ticks_from(head.at("attitude_ticks"));
    plan.from_one_period_on = head.at("from_one_period_on").get<bool>();
    const auto flown = host_.fly(plan);
    if (!flown) return refuse(flown.error(), question_.request, judge_);
    const Trace& trace = flown->trace;
    json answer = {{"source", trace.source},
                   {"ticks", trace.samples.size()},
                   {"parameters", changes_json(trace.parameters)}};
    set_end(flown->fault, flown->divergence, answer);
    std::vector<Blob> blobs{blob_of(trace.samples), blob_of(trace.plant)};
    if (const auto& attitude = flown->attitude_trace) {
      answer["attitude_ticks"] = attitude->samples.size();
      answer["attitude_parameters"] = changes_json(attitude->parameters);
      blobs.push_back(blob_of(attitude->samples));
    }
    return send(std::move(answer), blobs);
  }

  LoopTiming ticks_from(const json& count) {
    return question_.blobs.read<LoopTick>(count.get<std::size_t>()).value();
  }

  bool time(const json& head) {
    const Trace trace = trace_from(head, question_.blobs);
    const auto times =
        host_.time_steps(subject_from(head.at("subject")), trace, head.at("stack").get<bool>());
    if (!times) return refuse(times.error(), question_.request, judge_);
    json answer = {{"clock_ns", times->clock.count()}, {"steps", times->steps.size()}};
    if (times->stack_bytes) answer["stack"] = *times->stack_bytes;
    set_end(times->fault, {}, answer);
    return send(std::move(answer), {blob_of(times->steps)});
  }

  bool send(json head, const std::vector<Blob>& blobs = {}) {
    head["request"] = question_.request;
    return judge_.send(text_of(head), blobs);
  }

  const Arrived& question_;
  PortHost& host_;
  MessageSocket& judge_;
};

// Reads an answer with `read`. An exception means that there is no valid answer: a member is
// missing or of another type.
template <typename Read>
auto read_answer(const Arrived& arrived, Read read) -> decltype(read(json())) {
  const json head = json_from(arrived.head);
  if (!head.is_object()) return std::nullopt;
  try {
    if (head.at("request").get<std::uint64_t>() != arrived.request) return std::nullopt;
    auto answer = read(head);
    if (arrived.blobs.left() > 0) return std::nullopt;
    return answer;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

// Reads the trace of one unit of a flight, which must have `ticks` ticks.
std::optional<Trace> flown_trace(const Arrived& arrived, const json& head, Module module,
                                 std::size_t ticks) {
  auto samples = arrived.blobs.read<Sample>(ticks);
  if (!samples) return std::nullopt;
  Trace trace;
  trace.source = head.at("source").get<std::string>();
  trace.samples = *std::move(samples);
  trace.present = channels_of(module);
  return trace;
}

tl::unexpected<Error> error_in(const json& head) {
  auto error = error_from_json(head.at("error"));
  return tl::unexpected(error ? *std::move(error) : error.error());
}

}  // namespace

std::string drive_request(const Subject& subject, const Trace& trace) {
  return text_of({{"do", "drive"},
                  {"subject", to_json(subject)},
                  {"ticks", trace.samples.size()},
                  {"parameters", changes_json(trace.parameters)}});
}

std::string fly_request(const FlightPlan& plan) {
  return text_of({{"do", "fly"},
                  {"rate", plan.configuration.rate.to_string()},
                  {"vehicle", plan.configuration.plant_configuration->vehicle},
                  {"plant", plan.configuration.plant_configuration->plant},
                  {"ticks", plan.timing.unit.size()},
                  {"attitude_ticks", plan.timing.attitude_unit.size()},
                  {"from_one_period_on", plan.from_one_period_on}});
}

std::string time_request(const Subject& subject, const Trace& inputs, bool with_stack) {
  return text_of({{"do", "time"},
                  {"subject", to_json(subject)},
                  {"stack", with_stack},
                  {"ticks", inputs.samples.size()},
                  {"parameters", changes_json(inputs.parameters)}});
}

std::string supports_request(const std::string& profile) {
  return text_of({{"do", "supports"}, {"profile", profile}});
}

std::optional<Driven> read_driven(const Arrived& arrived, std::size_t ticks) {
  return read_answer(arrived, [&](const json& head) -> std::optional<Driven> {
    auto samples = arrived.blobs.read<Sample>(ticks);
    if (!samples) return std::nullopt;
    return Driven{*std::move(samples), fault_from(head, arrived.of_program)};
  });
}

std::optional<Result<Flown>> read_flown(const Arrived& arrived, const FlightPlan& plan) {
  using Answer = std::optional<Result<Flown>>;
  return read_answer(arrived, [&](const json& head) -> Answer {
    if (head.contains("error")) return error_in(head);
    Flown flown;
    flown.fault = fault_from(head, arrived.of_program);
    flown.divergence = divergence_from(head);
    const bool ends_early = flown.fault || flown.divergence;
    const FlightTiming& timing = plan.timing;
    const bool is_cascade = plan.configuration.rate.attitude_unit.has_value();
    const auto count_of = [&](const char* key, const LoopTiming& ticks) {
      const auto count = head.at(key).get<std::size_t>();
      const bool is_sane = count == ticks.size() || (count < ticks.size() && ends_early);
      return is_sane ? std::optional(count) : std::nullopt;
    };
    const auto count = count_of("ticks", timing.unit);
    if (!count) return std::nullopt;
    auto trace =
        flown_trace(arrived, head, is_cascade ? Module::rate_unit : Module::mc_att_control, *count);
    auto plant = trace ? arrived.blobs.read<PlantSample>(*count) : std::nullopt;
    if (!plant) return std::nullopt;
    flown.trace = *std::move(trace);
    flown.trace.parameters = changes_from(head.at("parameters"));
    flown.trace.plant = *std::move(plant);
    if (!is_cascade) return flown;
    const auto attitude_count = count_of("attitude_ticks", timing.attitude_unit);
    if (!attitude_count) return std::nullopt;
    flown.attitude_trace = flown_trace(arrived, head, Module::attitude_unit, *attitude_count);
    if (!flown.attitude_trace) return std::nullopt;
    flown.attitude_trace->parameters = changes_from(head.at("attitude_parameters"));
    return flown;
  });
}

std::optional<Result<StepTimes>> read_times(const Arrived& arrived, std::size_t ticks) {
  using Answer = std::optional<Result<StepTimes>>;
  return read_answer(arrived, [&](const json& head) -> Answer {
    if (head.contains("error")) return error_in(head);
    StepTimes times;
    times.fault = fault_from(head, arrived.of_program);
    const auto count = head.at("steps").get<std::size_t>();
    if (count > ticks || (count < ticks && !times.fault)) return std::nullopt;
    auto steps = arrived.blobs.read<Nanoseconds>(count);
    if (!steps) return std::nullopt;
    times.steps = *std::move(steps);
    times.clock = Nanoseconds(head.at("clock_ns").get<std::int64_t>());
    if (head.contains("stack")) times.stack_bytes = head.at("stack").get<std::size_t>();
    return times;
  });
}

std::optional<bool> read_supports(const Arrived& arrived) {
  return read_answer(arrived, [&](const json& head) -> std::optional<bool> {
    return head.at("supports").get<bool>();
  });
}

std::optional<PortFault> read_fault(const Arrived& arrived) {
  return read_answer(arrived, [&](const json& head) -> std::optional<PortFault> {
    constexpr std::size_t request_and_fault = 2;
    return head.size() == request_and_fault ? fault_from(head, arrived.of_program) : std::nullopt;
  });
}

std::optional<Result<PortSays>> read_greeting(const Arrived& arrived) {
  using Answer = std::optional<Result<PortSays>>;
  return read_answer(arrived, [&](const json& head) -> Answer {
    if (head.contains("error")) return error_in(head);
    return says_from(head.at("says"));
  });
}

bool greet(const PortSays& says, MessageSocket& judge) {
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
