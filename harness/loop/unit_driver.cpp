#include "harness/loop/unit_driver.hpp"

#include <cstring>
#include <vector>

#include <fmt/format.h>

namespace attest {
namespace {

using Kind = PortFault::Kind;
constexpr unsigned char canary = 0xa5;

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

// Runs `work`, and turns a PortBroke into a fault at `tick`. In a batch a later tick may have
// caused it: `or_later` is the text that says so.
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

UnitDriver::UnitDriver(Unit& unit, Module module) : unit_(unit), info_(info_of(module)) {
  std::memset(exchange_.in.data() + info_.in.size, canary, margin);
  std::memset(exchange_.out.data() + info_.out.size, canary, margin);
}

std::optional<PortFault> UnitDriver::step(std::size_t tick,
                                          std::span<const ParameterChange> changes, Sample& sample,
                                          std::optional<std::uint64_t> timestamp_sample_us) {
  return unless_broken(tick, "", [&]() -> std::optional<PortFault> {
    if (auto fault = set_parameters(tick, changes)) return fault;
    return step_once(tick, sample, timestamp_sample_us);
  });
}

std::optional<PortFault> UnitDriver::batch(std::size_t tick,
                                           std::span<const ParameterChange> changes,
                                           std::span<Sample> samples) {
  return unless_broken(tick, " or later", [&]() -> std::optional<PortFault> {
    if (auto fault = set_parameters(tick, changes)) return fault;
    return step_all(tick, samples);
  });
}

std::optional<PortFault> UnitDriver::set_parameters(std::size_t tick,
                                                    std::span<const ParameterChange> changes) {
  for (const ParameterChange& change : changes) {
    const int code = unit_.set_parameter(change.name, change.value);
    auto fault =
        fault_of(code, tick, fmt::format("set_parameter({}) at tick {}", change.name, tick));
    if (fault && code == ATTEST_INVALID) fault->kind = Kind::refused;
    if (fault) return fault;
  }
  return std::nullopt;
}

std::optional<PortFault> UnitDriver::step_all(std::size_t tick, std::span<Sample> samples) {
  std::vector<Sample> given(samples.begin(), samples.end());
  std::vector<std::uint64_t> timestamps_us;
  for (const Sample& sample : given) timestamps_us.push_back(sample.in.timestamp);
  std::memcpy(info_.out.in(given.front()), exchange_.out.data(), info_.out.size);
  const Batched batched = unit_.batch(given, timestamps_us);
  for (std::size_t i = 0; i < batched.done; ++i) samples[i].copy_outputs(given[i]);
  if (batched.done > 0) {
    std::memcpy(exchange_.out.data(), info_.out.in(samples[batched.done - 1]), info_.out.size);
  }
  const std::size_t next = tick + batched.done;
  return fault_of(batched.result, next, fmt::format("step at tick {}", next));
}

std::optional<PortFault> UnitDriver::step_once(std::size_t tick, Sample& sample,
                                               std::optional<std::uint64_t> timestamp_sample_us) {
  std::memcpy(exchange_.in.data(), info_.in.in(sample), info_.in.size);
  const int code_of_time =
      unit_.set_timestamp_sample(timestamp_sample_us.value_or(sample.in.timestamp));
  if (code_of_time != ATTEST_OK) {
    return fault_of(code_of_time, tick, fmt::format("set_timestamp_sample at tick {}", tick));
  }
  const int code = unit_.step_structs(exchange_.in.data(), exchange_.out.data());
  if (code != ATTEST_OK) return fault_of(code, tick, fmt::format("step at tick {}", tick));
  if (auto fault = broken_rule(sample, tick)) return fault;
  std::memcpy(info_.out.in(sample), exchange_.out.data(), info_.out.size);
  return std::nullopt;
}

std::optional<PortFault> UnitDriver::broken_rule(const Sample& given, std::size_t tick) const {
  // The margin is intact if its first byte is, and each byte equals the one before it.
  const auto is_intact = [](const auto& bytes, std::size_t end) {
    const unsigned char* const begin = bytes.data() + end;
    return *begin == canary && std::memcmp(begin, begin + 1, margin - 1) == 0;
  };
  if (!is_intact(exchange_.in, info_.in.size) || !is_intact(exchange_.out, info_.out.size)) {
    return PortFault{Kind::protocol, tick,
                     fmt::format("step wrote outside its outputs at tick {}; was the port "
                                 "compiled with another attest_unit.h?",
                                 tick)};
  }
  if (std::memcmp(exchange_.in.data(), info_.in.in(given), info_.in.size) != 0) {
    return PortFault{Kind::protocol, tick,
                     fmt::format("step changed its inputs at tick {}; they are const", tick)};
  }
  return std::nullopt;
}

}  // namespace attest
