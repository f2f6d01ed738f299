#include "harness/sweep/flights.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/compare/compare.hpp"
#include "harness/core/error_json.hpp"
#include "harness/golden/reference.hpp"
#include "harness/host/port_launcher.hpp"
#include "harness/process/pool.hpp"
#include "harness/verify/fixed_step.hpp"
#include "harness/verify/simulate.hpp"

namespace attest {
namespace {

// The samples of one piece of work. They take much longer than the start of a port launcher. They
// are few enough that all workers end at nearly the same time.
constexpr std::uint64_t samples_of_work = 32;

struct SimulatedSample {
  FlightResult result;
  Flown flown;
};

Result<SimulatedSample> simulate(const FlightSampler& sampler, const SampledFlight& sample,
                                 PortHost& host) {
  const RunConfiguration configuration{sampler.sweep().rate, sampler.nominal().plant_configuration};
  const auto plan = FlightPlan::as_scheduled(sample.the_case, configuration);
  auto flown = simulate_flight(sample.the_case, plan, host);
  if (!flown) return tl::unexpected(flown.error());
  auto& [result, flight] = *flown;
  if (flight.divergence) return SimulatedSample{{outcome_diverged, {}}, std::move(flight)};
  if (!is_judged(result.verdict)) {
    return fail(fmt::format("the port does not fly {}: {}", result.id(), result.reason));
  }
  SimulatedSample simulated;
  if (flight.trace.samples.empty()) {
    simulated.result.outcome = name_of(result.verdict);
    return simulated;
  }
  for (const MetricResult& metric : result.metrics) {
    simulated.result.metrics.push_back(metric.value);
  }
  simulated.flown = std::move(flight);
  return simulated;
}

// Whether the port has NaN or infinity in an output that is finite at all ticks of the reference.
bool is_non_finite(const Flown& port, const Flown& reference) {
  if (first_non_finite(port.trace, reference.trace)) return true;
  return port.attitude_trace && reference.attitude_trace &&
         first_non_finite(*port.attitude_trace, *reference.attitude_trace);
}

// A port with a fixed step flies the case with its first timestamp at one period. The reference
// then flies the same case.
SampledFlight for_reference(SampledFlight sample, const FlightsOptions& options) {
  const auto& said = options.host.said;
  if (options.with_port && said && has_fixed_step(*said, sample.the_case)) {
    sample.the_case = sample.the_case.from_one_period_on();
  }
  return sample;
}

Result<std::string> fly_sample(const FlightSampler& sampler, const SampledFlight& sample,
                               std::uint64_t index, const FlightsOptions& options) {
  const SampledFlight of_reference = for_reference(sample, options);
  std::vector<FlightResult> flights;
  const auto reference = open_reference({&of_reference.the_case, sample.vehicle_model.get()});
  auto flown = simulate(sampler, of_reference, *reference);
  if (flown && options.with_port) {
    const SimulatedSample by_reference = *std::move(flown);
    flights.push_back(by_reference.result);
    const auto host = start_host(options.host, {&sample.the_case, sample.vehicle_model.get()});
    if (!host) return tl::unexpected(host.error());
    flown = simulate(sampler, sample, **host);
    if (flown && is_non_finite(flown->flown, by_reference.flown)) {
      flown->result = {std::string(name_of(Verdict::non_finite)), {}};
    }
  }
  if (!flown) {
    Error error = flown.error();
    error.message = fmt::format("sample {}: {}", index, error.message);
    return tl::unexpected(std::move(error));
  }
  flights.push_back(std::move(flown->result));
  return columns_of(sampler, options.with_port).line(index, sample.drawn, flights);
}

// Puts the rows in the order of the samples.
class RowOrder {
 public:
  RowOrder(std::uint64_t next, const std::function<Result<void>(const std::string&)>& on_row)
      : next_(next), on_row_(on_row) {}

  // Calls on_row for the rows whose turn has come. False if on_row had an error.
  bool take(std::uint64_t index, std::string row) {
    waiting_.emplace(index, std::move(row));
    for (auto first = waiting_.begin(); first != waiting_.end() && first->first == next_;
         first = waiting_.erase(first)) {
      if (auto taken = on_row_(first->second); !taken) {
        error_ = taken.error();
        return false;
      }
      ++next_;
    }
    return true;
  }

  std::uint64_t next() const { return next_; }
  const std::optional<Error>& error() const { return error_; }

 private:
  std::uint64_t next_;
  const std::function<Result<void>(const std::string&)>& on_row_;
  std::map<std::uint64_t, std::string> waiting_;
  std::optional<Error> error_;
};

// Flies the samples of one piece of work. The port launcher starts before the reference flies them.
// So no process of the port has the reference's flights of these samples in its memory.
void fly_piece(const FlightSampler& sampler, const SampleRange& piece,
               const FlightsOptions& options, const Work::Done& done) {
  std::vector<Result<SampledFlight>> samples;
  for (std::uint64_t i = piece.begin; i < piece.end; ++i) samples.push_back(sampler.sample(i));
  if (options.with_port) {
    if (const auto started = start_port_launcher(*options.host.barrier); !started) {
      return done(encode(Result<nlohmann::json>(tl::unexpected(started.error()))), piece.size());
    }
  }
  for (std::uint64_t i = piece.begin; i < piece.end; ++i) {
    const auto row = samples[i - piece.begin].and_then(
        [&](const SampledFlight& sample) { return fly_sample(sampler, sample, i, options); });
    done(encode(row.map([&](const std::string& text) {
           return nlohmann::json{{"sample", i}, {"row", text}};
         })),
         row ? 1 : piece.end - i);
    if (!row) return;
  }
}

std::vector<Work> work_of(const FlightSampler& sampler, const SampleRange& range,
                          const FlightsOptions& options) {
  std::vector<Work> all;
  for (std::uint64_t begin = range.begin; begin < range.end; begin += samples_of_work) {
    const SampleRange piece{begin, std::min(begin + samples_of_work, range.end)};
    Work work;
    work.tasks = piece.size();
    work.run = [&sampler, &options, piece](const Work::Done& done) {
      fly_piece(sampler, piece, options, done);
    };
    all.push_back(std::move(work));
  }
  return all;
}

}  // namespace

SampleColumns columns_of(const FlightSampler& sampler, bool with_port) {
  SampleColumns columns;
  for (const auto& dispersion : sampler.sweep().dispersions) {
    columns.dispersions.push_back(dispersion.name);
  }
  for (const Metric& metric : sampler.nominal().the_case.flight->metrics) {
    columns.metrics.push_back(metric.name);
  }
  columns.with_port = with_port;
  return columns;
}

Result<void> fly_samples(const FlightSampler& sampler, const SampleRange& range,
                         const FlightsOptions& options,
                         const std::function<Result<void>(const std::string& row)>& on_row) {
  RowOrder order(range.begin, on_row);
  std::map<std::size_t, Error> errors;  // by the index of the piece of work
  PoolOptions pool;
  pool.processes = options.processes;
  pool.stop = [&] { return options.stop() || order.error().has_value(); };
  pool.on_answer = [&](std::size_t work, const std::string& text) {
    const auto answer = decode(text);
    if (!answer) errors.emplace(work, answer.error());
    return answer && order.take(answer->at("sample").get<std::uint64_t>(),
                                answer->at("row").get<std::string>());
  };
  pool.on_error = [&](std::size_t work, const Error& error) {
    errors.emplace(work, error);
    return false;
  };
  run_in_workers(work_of(sampler, range, options), pool);
  if (order.error()) return tl::unexpected(*order.error());
  if (!errors.empty()) return tl::unexpected(errors.begin()->second);
  return {};
}

}  // namespace attest
