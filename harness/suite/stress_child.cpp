// The child process of a stress run, and the parent that listens to it.
//
//     {"progress": {"time_ns": ..., "deadlines": ..., "missed": ..., "idle": false}}
//     {"stress": {...}} or {"error": {...}}
#include <atomic>
#include <chrono>
#include <csignal>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <poll.h>

#include "harness/process/child.hpp"
#include "harness/suite/error_json.hpp"
#include "harness/suite/evaluate.hpp"
#include "harness/suite/stress.hpp"
#include "harness/suite/stress_json.hpp"

namespace attest {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr auto report_every = std::chrono::seconds(1);

std::atomic<bool> asked_to_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // written by a signal handler

std::string repaired(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

void work(const StressTask& task, const std::string& specification, const SendLine& send) {
  std::signal(SIGTERM, [](int) { asked_to_stop.store(true); });
  auto port = open_port(specification);
  if (!port) return send(repaired({{"error", to_json(port.error())}}));
  Clock::time_point reported{};
  const auto progress = [&](const StressProgress& now) {
    if (!now.idle && Clock::now() - reported < report_every) return;
    reported = Clock::now();
    send(repaired({{"progress",
                    {{"time_ns", now.live.time.count()},
                     {"deadlines", now.live.deadlines},
                     {"missed", now.live.missed},
                     {"idle", now.idle}}}}));
  };
  const auto stress = stress_here(
      task, **port, [] { return asked_to_stop.load(); }, progress);
  send(repaired(stress ? json{{"stress", to_json(*stress)}}
                       : json{{"error", to_json(stress.error())}}));
}

std::optional<StressProgress> progress_from(const json& line) {
  const json& in = line["progress"];
  const bool complete = in.is_object() && in.contains("time_ns") && in["time_ns"].is_number();
  if (!complete) return std::nullopt;
  return StressProgress{
      {Nanoseconds(in["time_ns"].get<std::int64_t>()), in.value("deadlines", std::uint64_t{0}),
       in.value("missed", std::uint64_t{0})},
      in.value("idle", false)};
}

StressResult gone_wrong(const StressTask& task, Verdict verdict, std::string reason) {
  StressResult stress;
  stress.result = unjudged(task.the_case, task.setup);
  stress.result.verdict = verdict;
  stress.result.reason = std::move(reason);
  return stress;
}

// Listens until the child has said how it went, died, or hangs.
class Listener {
 public:
  Listener(const StressTask& task, Child& child,
           const std::function<void(const StressProgress&)>& progress)
      : task_(task), child_(child), progress_(progress) {}

  Result<StressResult> listen(const std::function<bool()>& stop) {
    bool ended = false, stopping = false;
    while (!ended && !hangs()) {
      if (!stopping && stop()) {
        child_.ask_to_stop();
        stopping = true;
      }
      pollfd readable{child_.descriptor(), POLLIN, 0};
      if (::poll(&readable, 1, 100) <= 0) continue;
      for (const std::string& line : child_.read_lines(ended)) {
        if (auto answer = answer_of(line)) return std::move(*answer);
      }
    }
    if (!ended) {
      child_.kill();
      return gone_wrong(task_, Verdict::timeout, how_it_hangs());
    }
    const std::string how = child_.end(), words = child_.last_words();
    return gone_wrong(
        task_, Verdict::crash,
        fmt::format("the process {}{}", how, words.empty() ? "" : "; its last words: " + words));
  }

 private:
  bool hangs() const {
    const Nanoseconds duration(static_cast<std::int64_t>(task_.the_case.duration.amount * 1e9));
    // A child that says nothing for so long, or flies on so long after the end, hangs.
    const Nanoseconds limit = report_every + task_.timeout;
    return Clock::now() - heard_ > (idle_ ? task_.idle_duration + limit : limit) ||
           flown_ > duration + limit;
  }

  std::string how_it_hangs() const {
    const double limit_s = in_seconds(task_.timeout);
    const double flown_s = in_seconds(flown_);
    return is_made_
               ? fmt::format("the port did not come back {:.3f} s into the flight, within {:g} s",
                             flown_s, limit_s)
               : fmt::format("no answer within {:g} s, when it was loaded and created", limit_s);
  }

  std::optional<Result<StressResult>> answer_of(const std::string& line) {
    heard_ = Clock::now();
    const json message = json::parse(line, nullptr, false);
    if (!message.is_object()) return std::nullopt;
    if (message.contains("stress")) return stress_from_json(message["stress"]);
    if (message.contains("error")) {
      auto error = error_from_json(message["error"]);
      return Result<StressResult>(tl::unexpected(error ? *error : error.error()));
    }
    if (!message.contains("progress")) return std::nullopt;
    if (const auto progress = progress_from(message)) {
      is_made_ = true;
      idle_ = progress->idle;
      flown_ = progress->live.time;
      progress_(*progress);
    }
    return std::nullopt;
  }

  const StressTask& task_;
  Child& child_;
  const std::function<void(const StressProgress&)>& progress_;
  Clock::time_point heard_ = Clock::now();
  bool is_made_ = false;  // the unit: the first progress comes after that
  bool idle_ = true;
  Nanoseconds flown_{0};
};

}  // namespace

Result<StressResult> run_stress(const StressTask& task, const std::string& port,
                                const std::function<bool()>& stop,
                                const std::function<void(const StressProgress&)>& progress) {
  auto child = Child::spawn([&](const SendLine& send) { work(task, port, send); });
  if (!child) return tl::unexpected(child.error());
  return Listener(task, *child, progress).listen(stop);
}

}  // namespace attest
