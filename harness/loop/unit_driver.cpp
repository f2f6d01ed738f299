#include "harness/loop/unit_driver.hpp"

#include <cstring>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "harness/port/module_place.hpp"

namespace attest {
namespace {

using Kind = PortFault::Kind;
using Margin = std::array<unsigned char, 64>;

constexpr Margin canary = [] {
  Margin margin{};
  margin.fill(0xa5);
  return margin;
}();

std::optional<PortFault> fault_of(int code, std::size_t tick, const std::string& call) {
  switch (code) {
    case ATTEST_OK:
      return std::nullopt;
    case ATTEST_UNSUPPORTED:
      return PortFault{Kind::unsupported, tick,
                       fmt::format("{} returned ATTEST_UNSUPPORTED", call)};
    case ATTEST_INVALID:
      return PortFault{Kind::failed, tick, fmt::format("{} returned ATTEST_INVALID", call)};
    case ATTEST_FAILED:
      return PortFault{Kind::failed, tick, fmt::format("{} returned ATTEST_FAILED", call)};
    default:
      return PortFault{Kind::protocol, tick,
                       fmt::format("{} returned {}, which is no ATTEST_ result", call, code)};
  }
}

// Runs `work`. The end of a program, or an answer that breaks the rules, is a fault at `tick`. In a
// batch it may belong to a later tick.
template <typename Work>
std::optional<PortFault> unless_broken(std::size_t tick, std::string_view or_later, Work work) {
  try {
    return work();
  } catch (const PortBroke& broke) {
    PortFault fault = fault_of(broke);
    fault.tick = tick;
    fault.what = fmt::format("at tick {}{}: {}", tick, or_later, broke.what());
    return fault;
  }
}

}  // namespace

PortFault fault_of(const PortBroke& broke) {
  const bool has_ended = broke.how() == PortBroke::How::ended;
  return {has_ended ? Kind::crash : Kind::protocol, 0, broke.what()};
}

template <typename ModuleUnit>
ModuleDriver<ModuleUnit>::ModuleDriver(ModuleUnit& unit) : unit_(unit) {
  exchange_.canary_in = canary;
  exchange_.canary_out = canary;
}

template <typename ModuleUnit>
std::optional<PortFault> ModuleDriver<ModuleUnit>::step(
    std::size_t tick, std::span<const ParameterChange> changes, Sample& sample,
    std::optional<std::uint64_t> timestamp_sample_us) {
  return unless_broken(tick, "", [&]() -> std::optional<PortFault> {
    if (auto fault = set_parameters(tick, changes)) return fault;
    return step_once(tick, sample, timestamp_sample_us);
  });
}

template <typename ModuleUnit>
std::optional<PortFault> ModuleDriver<ModuleUnit>::batch(std::size_t tick,
                                                         std::span<const ParameterChange> changes,
                                                         std::span<Sample> samples) {
  return unless_broken(tick, " or later", [&]() -> std::optional<PortFault> {
    if (auto fault = set_parameters(tick, changes)) return fault;
    return step_all(tick, samples);
  });
}

template <typename ModuleUnit>
std::optional<PortFault> ModuleDriver<ModuleUnit>::set_parameters(
    std::size_t tick, std::span<const ParameterChange> changes) {
  for (const ParameterChange& change : changes) {
    const int code = unit_.set_parameter(change.name, change.value);
    if (code == ATTEST_OK) continue;
    return fault_of(code, tick, fmt::format("set_parameter({}) at tick {}", change.name, tick));
  }
  return std::nullopt;
}

template <typename ModuleUnit>
std::optional<PortFault> ModuleDriver<ModuleUnit>::step_all(std::size_t tick,
                                                            std::span<Sample> samples) {
  std::vector<Inputs> in;
  std::vector<std::uint64_t> timestamps_us;
  for (const Sample& sample : samples) {
    in.push_back(sample.*ModulePlace<ModuleUnit>::in);
    timestamps_us.push_back(sample.in.timestamp);
  }
  std::vector<Outputs> out(samples.size());
  out.front() = exchange_.out;
  const Batched batched = unit_.batch(in, out, timestamps_us);
  for (std::size_t i = 0; i < batched.done; ++i) samples[i].*ModulePlace<ModuleUnit>::out = out[i];
  if (batched.done > 0) exchange_.out = out[batched.done - 1];
  const std::size_t next = tick + batched.done;
  return fault_of(batched.result, next, fmt::format("step at tick {}", next));
}

template <typename ModuleUnit>
std::optional<PortFault> ModuleDriver<ModuleUnit>::step_once(
    std::size_t tick, Sample& sample, std::optional<std::uint64_t> timestamp_sample_us) {
  const Inputs& given = sample.*ModulePlace<ModuleUnit>::in;
  exchange_.in = given;
  if (const int code = tell_time(given, timestamp_sample_us); code != ATTEST_OK) {
    return fault_of(code, tick, fmt::format("set_timestamp_sample at tick {}", tick));
  }
  if (const int code = unit_.step(exchange_.in, exchange_.out); code != ATTEST_OK) {
    return fault_of(code, tick, fmt::format("step at tick {}", tick));
  }
  if (auto fault = broken_rule(given, tick)) return fault;
  sample.*ModulePlace<ModuleUnit>::out = exchange_.out;
  return std::nullopt;
}

template <typename ModuleUnit>
int ModuleDriver<ModuleUnit>::tell_time(const Inputs& given,
                                        std::optional<std::uint64_t> timestamp_sample_us) {
  if constexpr (std::is_same_v<ModuleUnit, Unit>) {
    return unit_.set_timestamp_sample(timestamp_sample_us.value_or(given.timestamp));
  }
  return ATTEST_OK;
}

template <typename ModuleUnit>
std::optional<PortFault> ModuleDriver<ModuleUnit>::broken_rule(const Inputs& given,
                                                               std::size_t tick) const {
  if (exchange_.canary_in != canary || exchange_.canary_out != canary) {
    return PortFault{Kind::protocol, tick,
                     fmt::format("step wrote outside its outputs at tick {}; was the port "
                                 "compiled with another attest_unit.h?",
                                 tick)};
  }
  if (std::memcmp(&exchange_.in, &given, sizeof given) != 0) {
    return PortFault{Kind::protocol, tick,
                     fmt::format("step changed its inputs at tick {}; they are const", tick)};
  }
  return std::nullopt;
}

template class ModuleDriver<Unit>;
template class ModuleDriver<MixerUnit>;
template class ModuleDriver<BatteryUnit>;

}  // namespace attest
