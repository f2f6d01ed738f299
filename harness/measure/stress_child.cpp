// The child process of a stress run, and the parent that listens to it. The child sends some
// messages of the first kind, and then one of another kind:
//
//     {"progress": {"time_ns": ..., "deadlines": ..., "missed": ..., "idle": false}}
//     {"units": [{"stress": {...}, ...}, ...], ...}   the flight. For each unit three blobs follow:
//                                                     samples, ticks, LoopTick::commanded
//     {"refused": true, ...}                          the port did not make all units; its fault
//     {"error": {...}}
//
// The port's code runs in the child, so the parent accepts no verdict from the child. A port can
// forge the measurements, such as its own execution time. It cannot forge the verdict on its
// outputs, because the parent judges them.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/error_json.hpp"
#include "harness/core/json_text.hpp"
#include "harness/host/port_calls.hpp"
#include "harness/host/trace_message.hpp"
#include "harness/measure/stress.hpp"
#include "harness/measure/stress_json.hpp"
#include "harness/process/child.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/judge.hpp"

namespace attest {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr auto report_every = std::chrono::seconds(1);

std::atomic<bool> asked_to_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // written by a signal handler

using Times = std::vector<std::optional<Nanoseconds>>;

void send_measured(const StressMeasurement& measured, MessageSocket& parent) {
  if (!measured.flight) {
    json refused = {{"refused", true}};
    set_end(measured.refusal, std::nullopt, refused);
    parent.send(text_of(refused));
    return;
  }
  const LiveFlight& flight = *measured.flight;
  json head = {{"units", json::array()}};
  std::vector<Blob> blobs;
  const auto add = [&](const StressResult& stress, const LiveUnitRecord& unit,
                       const Times& commanded) {
    json of_unit = {{"stress", to_json(stress)},
                    {"ticks", unit.ticks.size()},
                    {"samples", unit.samples.size()},
                    {"commanded", commanded.size()},
                    {"parameters", changes_json(unit.changes)}};
    set_end(unit.fault, std::nullopt, of_unit);
    head["units"].push_back(std::move(of_unit));
    blobs.insert(blobs.end(), {blob_of(unit.samples), blob_of(unit.ticks), blob_of(commanded)});
  };
  add(measured.stress, flight.unit, flight.plant.commanded);
  if (flight.attitude_unit) {
    add(*measured.attitude_unit, *flight.attitude_unit, flight.unit.setpoints_received);
  }
  set_end(std::nullopt, flight.plant.divergence, head);
  parent.send(text_of(head), blobs);
}

// The next blob, of `count` objects. Empty if there are more than `most`, or if it does not arrive.
template <typename T>
std::optional<std::vector<T>> read_some(const json& count, std::size_t most, BlobReader& blobs) {
  const auto wanted = count.get<std::size_t>();
  return wanted <= most ? blobs.read<T>(wanted) : std::nullopt;
}

struct MeasuredUnit {
  StressResult stress;
  LiveUnitRecord record;
  Times commanded;
  std::size_t most = 0;  // the most ticks that the unit can have

  bool is_whole() const { return record.ticks.size() + stress.misses.skipped >= most; }
};

// Reads the part for one unit from the message of a flight. Empty, or json::exception: it is
// invalid.
std::optional<MeasuredUnit> unit_from(const json& head, std::size_t most, bool of_program,
                                      BlobReader& blobs) {
  auto stress = stress_from_json(head.at("stress"));
  if (!stress) return std::nullopt;
  auto samples = read_some<Sample>(head.at("samples"), most, blobs);
  auto ticks = samples ? read_some<LiveTick>(head.at("ticks"), most, blobs) : std::nullopt;
  using Time = Times::value_type;
  auto commanded = ticks ? read_some<Time>(head.at("commanded"), most, blobs) : std::nullopt;
  const bool fits = commanded && commanded->size() >= ticks->size() &&
                    ticks->size() == stress->ticks &&
                    samples->size() == std::min(ticks->size(), checked_ticks);
  if (!fits) return std::nullopt;
  MeasuredUnit unit;
  unit.stress = *std::move(stress);
  unit.commanded = *std::move(commanded);
  unit.most = most;
  unit.record.samples = *std::move(samples);
  unit.record.ticks = *std::move(ticks);
  unit.record.changes = changes_from(head.at("parameters"));
  unit.record.fault = fault_from(head, of_program);
  return unit;
}

// Reads the message of a flight. Empty, or json::exception: it is not one that attest's code in the
// child would send. For example, a flight may be shorter than its case only after a request to
// stop, a fault or a divergence, or with a unit that the estimator triggers.
std::optional<StressMeasurement> measurement_from(const StressTask& task, bool of_program,
                                                  bool was_asked_to_stop, const json& head,
                                                  BlobReader& blobs) {
  const LoopRate& rate = task.configuration.rate;
  std::vector<Rate> rates{rate.unit};
  if (task.the_case.attitude_loop) rates.push_back(*rate.attitude_unit);
  const json& heads = head.at("units");
  if (!heads.is_array() || heads.size() != rates.size()) return std::nullopt;
  std::vector<MeasuredUnit> units;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const auto most = static_cast<std::size_t>(tick_count(task.the_case.duration, rates[i]));
    auto unit = unit_from(heads[i], most, of_program, blobs);
    if (!unit) return std::nullopt;
    units.push_back(*std::move(unit));
  }
  if (blobs.left() != 0) return std::nullopt;
  StressMeasurement measured;
  LiveFlight& flight = measured.flight.emplace();
  flight.plant.divergence = divergence_from(head);
  const bool has_fault = std::any_of(units.begin(), units.end(), [](const MeasuredUnit& unit) {
    return unit.record.fault.has_value();
  });
  const bool may_be_short =
      was_asked_to_stop || has_fault || flight.plant.divergence || task.the_case.unit.on_estimate;
  const bool is_whole =
      std::all_of(units.begin(), units.end(), std::mem_fn(&MeasuredUnit::is_whole));
  if (!is_whole && !may_be_short) return std::nullopt;
  measured.stress = std::move(units.front().stress);
  flight.unit = std::move(units.front().record);
  flight.plant.commanded = std::move(units.front().commanded);
  if (units.size() == 1) return measured;
  measured.attitude_unit = std::move(units.back().stress);
  flight.attitude_unit = std::move(units.back().record);
  flight.unit.setpoints_received = std::move(units.back().commanded);
  return measured;
}

void work(const StressTask& task, const std::string& specification, const PortCalls& calls,
          MessageSocket& parent) {
  std::signal(SIGTERM, [](int) { asked_to_stop.store(true); });
  auto port = open_port(specification);
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
  if (step && (*step != rate.unit || *step != rate.attitude_unit.value_or(rate.unit))) {
    stress.result.verdict = Verdict::unsupported;
    stress.result.reason = fmt::format("the port has a fixed step of {} Hz", step->to_string());
    return StressResults{stress};
  }
  if (!declines(task.port, stress.result)) return std::nullopt;
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
    return forged();
  }

  StressResults forged() {
    child_.kill();
    return gone_wrong(task_, Verdict::protocol,
                      "the port wrote on the socket on which its process answers");
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
    if (!head.is_object()) return forged();
    if (head.contains("error")) {
      auto error = error_from_json(head["error"]);
      return Result<StressResults>(tl::unexpected(error ? *error : error.error()));
    }
    try {
      if (head.contains("refused")) {
        StressMeasurement measured;
        measured.refusal = fault_from(head, of_program_);
        return judge_live(task_, std::move(measured));
      }
      if (head.contains("units")) {
        auto kind = Received::Kind::no_message;
        BlobReader blobs(received.blobs, [&](void* place, std::size_t size) {
          const auto came = child_.receive_blob(place, size, patience);
          if (came != Received::Kind::message) kind = came;
          return came == Received::Kind::message;
        });
        auto measured = measurement_from(task_, of_program_, is_stopping_, head, blobs);
        if (!measured) return end_of(kind);
        return judge_live(task_, *std::move(measured));
      }
      take_progress(head.at("progress"));
    } catch (const json::exception&) {
      return forged();
    }
    return std::nullopt;
  }

  void take_progress(const json& now) {
    const StressProgress progress{
        {Nanoseconds(now.at("time_ns").get<std::int64_t>()),
         now.at("deadlines").get<std::uint64_t>(), now.at("missed").get<std::uint64_t>()},
        now.at("idle").get<bool>()};
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
      Child::Runs::code_of_others,
      [&](MessageSocket& parent) { work(task, host.port, *calls, parent); }, *host.barrier);
  if (!child) return tl::unexpected(child.error());
  return Listener(task, is_program(host.port), *calls, *child, progress).listen(stop);
}

}  // namespace attest
