// The child process of a stress run, and the parent that listens to it. The child sends some
// messages of the first kind, and then one of another kind:
//
//     {"progress": {"time_ns": ..., "deadlines": ..., "missed": ..., "idle": false}}
//     {"units": [...], ...}                           the flight (stress_message.hpp)
//     {"refused": true, ...}                          the port did not make all units; its fault
//     {"error": {...}}
//
// The port's code runs in the child, so the parent accepts no verdict from the child, and checks
// the type and the range of each member where it arrives. A port can forge the measurements, such
// as its own execution time. It cannot forge the verdict on its outputs, because the parent judges
// them.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/error_json.hpp"
#include "harness/core/json_reader.hpp"
#include "harness/core/json_text.hpp"
#include "harness/host/port_calls.hpp"
#include "harness/host/trace_message.hpp"
#include "harness/measure/stress.hpp"
#include "harness/measure/stress_message.hpp"
#include "harness/process/child.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/judge.hpp"

namespace attest {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

std::atomic<bool> asked_to_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // written by a signal handler

void work(const StressTask& task, const HostOptions& host, const PortCalls& calls,
          MessageSocket& parent) {
  std::signal(SIGTERM, [](int) { asked_to_stop.store(true); });
  auto port = open_port(host.port, host.files.get());
  if (!port) {
    parent.send(text_of({{"error", to_json(port.error())}}));
    return;
  }
  const std::unique_ptr<Port> noted = calls.noted(**port);
  Clock::time_point reported{};
  const auto progress = [&](const StressProgress& now) {
    if (!now.idle && Clock::now() - reported < report_every) return;
    reported = Clock::now();
    parent.send(text_of({{"progress",
                          {{"time_ns", now.live.time.count()},
                           {"deadlines", now.live.deadlines},
                           {"missed", now.live.missed},
                           {"idle", now.idle}}}}));
  };
  const auto measured = measure_live(
      task, *noted, [] { return asked_to_stop.load(); }, progress);
  (*port)->finish();
  if (measured) {
    send_measured(*measured, parent);
  } else {
    parent.send(text_of({{"error", to_json(measured.error())}}));
  }
}

// The result if the port's declarations before the run exclude the task; else empty.
std::optional<StressResults> declined(const StressTask& task) {
  StressResult stress;
  stress.result = result_for(task.the_case, task.configuration);
  const auto& step = task.port.fixed_step;
  const LoopRate& rate = task.configuration.rate;
  if (step && (*step != rate.motor_unit || *step != rate.attitude_unit.value_or(rate.motor_unit))) {
    stress.result.verdict = Verdict::unsupported;
    stress.result.reason = fmt::format("the port has a fixed step of {} Hz", step->to_string());
    return StressResults{stress};
  }
  if (!marks_declined(task.port, stress.result)) return std::nullopt;
  return StressResults{stress};
}

StressResults gone_wrong(const StressTask& task, Verdict verdict, std::string reason) {
  StressResult stress;
  stress.result = result_for(task.the_case, task.configuration);
  stress.result.verdict = verdict;
  stress.result.reason = std::move(reason);
  return {stress};
}

// Listens until the child has sent its last message, has died, or hangs.
class Listener {
 public:
  Listener(const StressTask& task, bool of_program, const PortCalls& calls, Child& child,
           const std::function<void(const StressProgress&)>& progress)
      : task_(task), of_program_(of_program), calls_(calls), child_(child), progress_(progress) {}

  Result<StressResults> listen(const std::function<bool()>& stop) {
    Patience patience;
    patience.given_up = [&] {
      if (!is_stopping_ && stop()) {
        child_.ask_to_stop();
        is_stopping_ = true;
      }
      return hangs();
    };
    while (true) {
      const Received received = child_.receive(patience);
      if (received.kind != Received::Kind::message) return end_of(received.kind);
      if (auto answer = answer_of(received, patience)) return *std::move(answer);
    }
  }

 private:
  // The result if the last message did not come, or is invalid.
  StressResults end_of(Received::Kind why) {
    if (why == Received::Kind::ended) {
      const std::string how = child_.end(), words = child_.last_words();
      return gone_wrong(
          task_, Verdict::crash,
          fmt::format("the process {}{}{}", how, calls_.current(), child_.last_printed()));
    }
    child_.kill();
    if (why == Received::Kind::too_late || why == Received::Kind::given_up) {
      return gone_wrong(task_, Verdict::timeout, how_it_hangs());
    }
    return forged("it is no message");
  }

  StressResults forged(const std::string& wrong) {
    child_.kill();
    return gone_wrong(
        task_, Verdict::protocol,
        fmt::format("the port wrote on the socket on which its process answers: {}", wrong));
  }

  bool hangs() const {
    const Nanoseconds duration(static_cast<std::int64_t>(task_.the_case.duration.amount * 1e9));
    // A child hangs if it sends no message for this time, or flies for this time beyond the end of
    // the case. While it measures the idle machine it sends no messages.
    const Nanoseconds limit = report_every + task_.timeout;
    return Clock::now() - heard_ > (idle_ ? task_.idle_duration + limit : limit) ||
           flown_ > duration + limit ||
           // An upper bound for a port that forges progress messages.
           Clock::now() - began_ > task_.timeout + task_.idle_duration + duration + 2 * limit;
  }

  std::string how_it_hangs() const {
    const double limit_s = in_seconds(task_.timeout);
    const double flown_s = in_seconds(flown_);
    return is_made_
               ? fmt::format("the port did not return{} within {:g} s, {:.3f} s into the flight",
                             calls_.current(), limit_s, flown_s)
               : fmt::format("no answer{} within {:g} s, when it was loaded and created",
                             calls_.current(), limit_s);
  }

  // The result if this is the last message; empty if it is a progress message. The port shares the
  // child's process and could have forged the message, so its form is checked.
  std::optional<Result<StressResults>> answer_of(const Received& received,
                                                 const Patience& patience) {
    heard_ = Clock::now();
    const json head = json_from(received.head);
    std::string error;
    JsonReader reader(head, error);
    if (reader.has("error")) return Result<StressResults>(error_in(reader));
    if (reader.has("refused")) {
      StressMeasurement measured;
      measured.refusal = fault_from(reader, 0, of_program_);
      if (!error.empty()) return forged(error);
      return judge_live(task_, std::move(measured));
    }
    if (!reader.has("units")) {
      take_progress(reader.object("progress"));
      return error.empty() ? std::nullopt : std::optional<Result<StressResults>>(forged(error));
    }
    auto kind = Received::Kind::message;
    BlobReader blobs(received.blobs, [&](void* place, std::size_t size) {
      kind = child_.receive_blob(place, size, patience);
      return kind == Received::Kind::message;
    });
    auto measured = measurement_from(task_, of_program_, is_stopping_, reader, blobs);
    if (kind != Received::Kind::message) return end_of(kind);
    if (!error.empty()) return forged(error);
    LiveFlight& flight = *measured.flight;
    flight.unit.fault = with_words(std::move(flight.unit.fault), child_, of_program_);
    if (auto& attitude = flight.attitude_unit) {
      attitude->fault = with_words(std::move(attitude->fault), child_, of_program_);
    }
    return judge_live(task_, std::move(measured));
  }

  void take_progress(JsonReader now) {
    const Nanoseconds time(now.integer("time_ns", 0, longest_of(task_).count()));
    const StressProgress progress{
        {time, now.count("deadlines", INT64_MAX), now.count("missed", INT64_MAX)},
        now.flag("idle")};
    is_made_ = true;
    idle_ = progress.idle;
    flown_ = progress.live.time;
    progress_(progress);
  }

  const StressTask& task_;
  bool of_program_;
  const PortCalls& calls_;
  Child& child_;
  const std::function<void(const StressProgress&)>& progress_;
  const Clock::time_point began_ = Clock::now();
  Clock::time_point heard_ = Clock::now();
  bool is_stopping_ = false;
  bool is_made_ = false;  // the units were made; the first progress message comes after that
  bool idle_ = true;
  Nanoseconds flown_{0};
};

}  // namespace

Result<StressResults> run_stress(const StressTask& task, const HostOptions& host,
                                 const std::function<bool()>& stop,
                                 const std::function<void(const StressProgress&)>& progress) {
  if (auto unsupported = declined(task)) return *std::move(unsupported);
  const auto calls = PortCalls::make();
  if (!calls) return tl::unexpected(calls.error());
  auto child = Child::spawn(
      Child::Runs::code_of_others, [&](MessageSocket& parent) { work(task, host, *calls, parent); },
      *host.barrier);
  if (!child) return tl::unexpected(child.error());
  return Listener(task, kind_of(host.port).is_program, *calls, *child, progress).listen(stop);
}

}  // namespace attest
