#include "harness/run/open_loop.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

namespace attest {
namespace {

using Kind = PortFault::Kind;

// What the unit gets, with a margin behind it that must stay as it was: a port compiled with
// another layout writes there first.
struct Exchange {
  attest_inputs in{};
  std::array<unsigned char, 64> behind_in;
  attest_outputs out{};
  std::array<unsigned char, 64> behind_out;

  static constexpr unsigned char untouched = 0xa5;

  Exchange() {
    behind_in.fill(untouched);
    behind_out.fill(untouched);
  }
  bool margins_are_untouched() const {
    const auto is_untouched = [](unsigned char byte) { return byte == untouched; };
    return std::all_of(behind_in.begin(), behind_in.end(), is_untouched) &&
           std::all_of(behind_out.begin(), behind_out.end(), is_untouched);
  }
};

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

std::optional<PortFault> broken_rule(const Exchange& exchange, const attest_inputs& given,
                                     std::size_t tick) {
  if (!exchange.margins_are_untouched()) {
    return PortFault{Kind::protocol, tick,
                     fmt::format("step wrote outside attest_outputs at tick {}; was the port "
                                 "compiled with another attest_unit.h?",
                                 tick)};
  }
  if (std::memcmp(&exchange.in, &given, sizeof given) != 0) {
    return PortFault{Kind::protocol, tick,
                     fmt::format("step changed its inputs at tick {}; they are const", tick)};
  }
  return std::nullopt;
}

}  // namespace

std::optional<PortFault> drive(Unit& unit, Trace& trace) {
  Exchange exchange;
  auto change = trace.parameters.begin();
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    for (; change != trace.parameters.end() && change->tick == tick; ++change) {
      const int code = unit.set_parameter(change->name, change->value);
      if (code == ATTEST_OK) continue;
      return fault_of(code, tick, fmt::format("set_parameter({}) at tick {}", change->name, tick));
    }
    Sample& sample = trace.samples[tick];
    exchange.in = sample.in;
    if (const int code = unit.step(exchange.in, exchange.out); code != ATTEST_OK) {
      return fault_of(code, tick, fmt::format("step at tick {}", tick));
    }
    if (auto fault = broken_rule(exchange, sample.in, tick)) return fault;
    sample.out = exchange.out;
  }
  return std::nullopt;
}

}  // namespace attest
