#include "harness/host/port_process.hpp"

#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/core/own_arena.hpp"
#include "harness/host/answer_meter.hpp"
#include "harness/host/host_protocol.hpp"
#include "harness/host/in_process_host.hpp"
#include "harness/host/port_launcher.hpp"
#include "harness/host/recorded_host.hpp"
#include "harness/trace/trace_parts.hpp"

namespace attest {
namespace {

using Kind = Received::Kind;
using Clock = std::chrono::steady_clock;

// The fault of a request to a port that had `kind` before.
std::string not_run(PortFault::Kind kind) {
  return kind == PortFault::Kind::timeout
             ? "not run: the port had timed out before"
             : "not run: the port had crashed or broken the protocol before";
}

class PortProcess final : public PortHost {
 public:
  // `port` is empty if it is not started (HostOptions::hangs).
  PortProcess(const HostOptions& options, const Course& course, std::optional<PortChild> port)
      : options_(options), course_(course), port_(std::move(port)) {
    if (options.said) declarations_ = *options.said;
    if (!port_) fault_ = PortFault{PortFault::Kind::timeout, 0, options.hangs};
  }

  // Waits until the port is loaded. Errors: the port cannot be loaded.
  Result<void> greet() {
    if (!port_) return {};
    const auto greeted = answer_from("when it was loaded", patience(), read_greeting);
    if (!greeted) return {};
    if (!*greeted) {
      Error error = greeted->error();
      if (kind_of(options_.port).is_program) error.message += port_->child.last_printed();
      return tl::unexpected(std::move(error));
    }
    if (!options_.said) {
      declarations_ = **greeted;
    } else if (const std::string difference = change(declarations_, **greeted);
               !difference.empty()) {
      give_up(Kind::no_message, "", difference);
    }
    return {};
  }

  const Declarations& declarations() const override { return declarations_; }

  std::optional<PortFault> drive(const ModuleUnderTest& subject, Trace& trace) override {
    if (subject.part.first_tick == 0) begin_to_print();
    const std::span<Sample> samples = trace.samples;
    // New memory for all ticks of a long trace would cost the process more than its steps.
    const std::size_t most = subject.instances == Instances::one ? ticks_at_once : samples.size();
    std::optional<PortFault> fault;
    std::size_t first = 0;
    do {
      const auto part = samples.subspan(first, std::min(most, samples.size() - first));
      ModuleUnderTest of_part = subject;
      of_part.part.first_tick += first;
      of_part.part.is_last = subject.part.is_last && first + part.size() == samples.size();
      fault = drive_part(of_part, part, changes_in(trace.parameters, first, part.size()));
      first += part.size();
    } while (!fault && first < samples.size());
    return fault;
  }

  Result<Flown> fly(const FlightPlan& plan) override {
    begin_to_print();
    const std::vector<Blob> times{blob_of(plan.timing.unit), blob_of(plan.timing.attitude_unit)};
    const Rate& rate = plan.configuration.rate.motor_unit;
    // A flight that diverges does so before this time.
    const Nanoseconds longest = course_.the_case->duration.on(rate) + rate.tick(1);
    auto flown = ask(fly_request(plan), times,
                     [&](const Arrived& arrived) { return read_flown(arrived, plan, longest); });
    if (!flown) return without_answer<Flown>();
    if (!*flown) return *std::move(flown);
    (*flown)->fault = judged((*flown)->fault, course_.the_case->profile);
    (*flown)->trace.source = course_.the_case->id_at(plan.configuration);
    if (auto& attitude = (*flown)->attitude_trace) attitude->source = (*flown)->trace.source;
    return *std::move(flown);
  }

  Result<LiveFlight> fly_live(const LivePlan& plan, const LiveWatch& watch) override {
    const Case& the_case = *course_.the_case;
    const LoopRate& rate = plan.configuration.rate;
    const auto began = Clock::now();
    bool is_stopping = false;
    if (port_) port_->calls->begin_flight();
    const auto look = [&, shown = began]() mutable {
      is_stopping = is_stopping || watch.stop();
      if (is_stopping) port_->calls->ask_to_stop();
      const LiveProgress now = port_->calls->progress();
      if (now.time == Nanoseconds(0) || Clock::now() < shown) return;
      watch.progress(now);
      shown = Clock::now() + std::chrono::seconds(1);
    };
    const auto read = [&](const Arrived& arrived) {
      // The flight was after the request. A deadline can be one period after its end.
      const Nanoseconds period = rate.attitude_unit.value_or(rate.motor_unit).tick(1);
      const Nanoseconds longest = Clock::now() - began + std::max(period, rate.motor_unit.tick(1));
      return read_live(arrived, {the_case, plan, longest, is_stopping});
    };
    auto flown = ask(live_request(plan), {}, read, the_case.duration.on(rate.motor_unit), look);
    if (!flown) return without_answer<LiveFlight>();
    if (!*flown) return *std::move(flown);
    LiveFlight& flight = **flown;
    flight.fault = judged(flight.fault, the_case.profile);
    flight.unit.fault = judged(flight.unit.fault, the_case.profile);
    if (auto& attitude = flight.attitude_unit) {
      attitude->fault = judged(attitude->fault, the_case.profile);
    }
    return *std::move(flown);
  }

  Result<StepTimes> time_steps(const ModuleUnderTest& subject, const Trace& inputs,
                               bool with_stack) override {
    const auto sent = info_of(subject.module).all_inputs().copy(inputs.samples);
    auto times = ask(
        time_request(subject, inputs, with_stack), {blob_of(sent)}, [&](const Arrived& arrived) {
          return read_times(arrived, inputs.samples.size(), declarations_.cost.has_value());
        });
    if (!times) return without_answer<StepTimes>();
    if (*times) (*times)->fault = judged((*times)->fault, subject.profile);
    return *std::move(times);
  }

  std::optional<Nanoseconds> cpu_time() const override {
    return port_ ? std::optional<Nanoseconds>(port_->child.usage().running) : std::nullopt;
  }

  bool supports(const std::string& profile) override {
    const auto supports = ask(supports_request(profile), {}, read_supports);
    return supports && *supports;
  }

  bool is_spent() const override { return fault_ && fault_->kind != PortFault::Kind::timeout; }

  const std::optional<PortFault>& fault() const { return fault_; }

  std::string last_words() const override {
    return port_ ? port_->child.last_words(printed_before_) : "";
  }

 private:
  void begin_to_print() { printed_before_ = port_ ? port_->child.printed() : 0; }

  std::optional<PortFault> drive_part(const ModuleUnderTest& subject, std::span<Sample> samples,
                                      const std::vector<ParameterChange>& changes) {
    const ModuleInfo& module = info_of(subject.module);
    const std::vector<std::byte> inputs = module.all_inputs().copy(samples);
    const auto driven =
        ask(drive_request(subject, samples.size(), changes), {blob_of(inputs)},
            [&](const Arrived& arrived) { return read_driven(arrived, subject, samples.size()); });
    if (!driven) return fault_;
    module.out.paste(driven->outputs, samples);
    return judged(driven->fault, subject.profile);
  }

  template <typename R>
  R without_answer() const {
    R result;
    result.fault = fault_;
    return result;
  }

  // An error after a fault of the port, in this request or before; fault_ has it. `duration`: of a
  // live flight. `look` is called while the answer is awaited.
  template <typename Read>
  auto ask(const std::string& question, const std::vector<Blob>& blobs, Read read,
           Nanoseconds duration = {}, const std::function<void()>& look = {})
      -> std::invoke_result_t<Read, const Arrived&> {
    const bool was_asked = std::exchange(was_asked_, true);
    if (fault_) {
      if (was_asked) fault_->what = not_run(fault_->kind);
      return fail(fault_->what);
    }
    ++request_;
    const Patience limit = patience(duration, look);
    // If the request cannot be sent, the wait for the answer finds out why.
    port_->child.socket().send(question, blobs, limit);
    return answer_from("", limit, std::move(read));
  }

  Patience patience(Nanoseconds duration = {}, const std::function<void()>& look = {}) {
    AnswerMeter of_answer(*port_, options_.timeout_s, kind_of(options_.port).is_program, duration);
    Patience limit;
    limit.given_up = [this, look, meter = of_answer]() mutable {
      if (look) look();
      exceeded_ = meter.exceeded();
      return exceeded_ != AnswerMeter::Limit::none || options_.stop();
    };
    return limit;
  }

  // The fault of an answer, by the declarations that this process keeps.
  std::optional<PortFault> judged(std::optional<PortFault> fault,
                                  const std::string& profile) const {
    return with_words(held_to(declarations_, profile, std::move(fault)), port_->child,
                      kind_of(options_.port).is_program);
  }

  template <typename Read>
  auto answer_from(const std::string& when, const Patience& patience, Read read)
      -> std::invoke_result_t<Read, const Arrived&> {
    const Received received = port_->child.receive(patience);
    Kind kind = received.kind;
    std::string wrong;
    if (kind == Kind::message) {
      BlobReader blobs(received.blobs, [&](void* place, std::size_t size) {
        const Kind came = port_->child.receive_blob(place, size, patience);
        if (came != Kind::message) kind = came;
        return came == Kind::message;
      });
      const Arrived arrived{received.head, blobs, request_, kind_of(options_.port).is_program};
      auto answer = read(arrived);
      if (answer) return answer;
      wrong = answer.error().message;
      if (auto fault = read_fault(arrived)) {
        fault_ = with_words(std::move(fault), port_->child, true);
        return fail(fault_->what);
      }
    }
    give_up(kind, when, wrong);
    return fail(fault_->what);
  }

  // `wrong`: what is wrong with a message that arrived.
  void give_up(Kind why, const std::string& when, const std::string& wrong) {
    if (why != Kind::ended) port_->child.kill();
    const std::string how = port_->child.end();
    const std::string where = when.empty() ? port_->calls->current() : ", " + when;
    const std::string words = port_->child.last_printed();
    const auto set_fault = [&](PortFault::Kind kind, const std::string& what) {
      fault_ = PortFault{kind, 0, what};
    };
    if (exceeded_ == AnswerMeter::Limit::memory) {
      set_fault(PortFault::Kind::crash,
                fmt::format("the port's processes used more than {} GiB of memory{}{}",
                            max_memory_gib, where, words));
    } else if (why == Kind::ended) {
      set_fault(PortFault::Kind::crash, "the port's process " + how + where + words);
    } else if (why == Kind::too_late || why == Kind::given_up) {
      const std::string limit = text_of(exceeded_, options_.timeout_s);
      set_fault(PortFault::Kind::timeout, "no answer within " + limit + where + words);
    } else {
      set_fault(PortFault::Kind::protocol,
                fmt::format("the port wrote on the socket on which its process answers{}{}",
                            wrong.empty() ? "" : ": ", wrong));
    }
  }

  HostOptions options_;
  Course course_;
  std::optional<PortChild> port_;
  Declarations declarations_;
  std::uint64_t request_ = 0;
  std::size_t printed_before_ = 0;  // before the trace or flight
  AnswerMeter::Limit exceeded_ = AnswerMeter::Limit::none;
  bool was_asked_ = false;          // by a request; after a fault, later ones are `not run`
  std::optional<PortFault> fault_;  // permanent
};

Result<std::unique_ptr<PortProcess>> start_process(const HostOptions& options,
                                                   const Course& course) {
  std::optional<PortChild> port;
  if (options.hangs.empty()) {
    auto launched = launch_port(options, course);
    if (!launched) return tl::unexpected(launched.error());
    port = *std::move(launched);
  }
  auto host = std::make_unique<PortProcess>(options, course, std::move(port));
  if (auto greeted = host->greet(); !greeted) return tl::unexpected(greeted.error());
  return host;
}

Result<PortDescription> describe_callable(const HostOptions& options,
                                          const std::vector<std::string>& profiles) {
  PortDescription description;
  auto host = start_process(options, {});
  if (!host) return tl::unexpected(host.error());
  if (const auto& fault = (*host)->fault()) {
    if (fault->kind != PortFault::Kind::timeout) return fail_at(options.port, fault->what);
    description.hangs = fault->what;
    return description;
  }
  static_cast<Declarations&>(description) = (*host)->declarations();
  for (const std::string& profile : profiles) {
    host->reset();  // one process of the port at a time
    host = start_process(options, {});
    if (!host) return tl::unexpected(host.error());
    const bool supports = (*host)->supports(profile);
    if (const auto& fault = (*host)->fault()) {
      description.goes_wrong = fmt::format("profile {}: {}", profile, fault->what);
      break;
    }
    if (std::string changed = change(description, (*host)->declarations()); !changed.empty()) {
      description.goes_wrong = fmt::format("profile {}: {}", profile, changed);
      break;
    }
    if (supports) description.profiles.push_back(profile);
    if (!supports) description.refusals[profile] = (*host)->last_words();
  }
  return description;
}

}  // namespace

Result<std::unique_ptr<PortHost>> start_host(const HostOptions& options, const Course& course) {
  if (options.start) return options.start(options, course);
  if (!kind_of(options.port).is_callable()) return open_recorded_host(argument_of(options.port));
  if (options.in_process) {
    return open_in_process_host(options.port, options.said, course, nullptr, options.files.get());
  }
  return start_process(options, course);
}

Result<void> ensure_host(std::unique_ptr<PortHost>& host, const HostOptions& options) {
  if (host && !host->is_spent()) return {};
  return start_host(options).map([&](auto started) { host = std::move(started); });
}

Result<PortDescription> describe_port(const HostOptions& options,
                                      const std::vector<std::string>& profiles) {
  if (!kind_of(options.port).is_callable()) {
    return open_recorded_host(argument_of(options.port)).map([](const auto& host) {
      PortDescription description;
      static_cast<Declarations&>(description) = host->declarations();
      return description;
    });
  }
  Result<PortDescription> described;
  in_own_arena([&] { described = describe_callable(options, profiles); });
  return described;
}

}  // namespace attest
