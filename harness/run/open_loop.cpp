#include "harness/run/open_loop.hpp"

#include <memory>
#include <span>

#include <fmt/format.h>

namespace attest {
namespace {

template <typename PartUnit>
std::optional<PortFault> drive_part(PartUnit& unit, Trace& trace) {
  PartDriver<PartUnit> driver(unit);
  std::span<const ParameterChange> changes = trace.parameters;
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    std::size_t now = 0;
    while (now < changes.size() && changes[now].tick == tick) ++now;
    if (auto fault = driver.step(tick, changes.first(now), trace.samples[tick])) return fault;
    changes = changes.subspan(now);
  }
  return std::nullopt;
}

template <typename PartUnit>
std::optional<PortFault> drive_created(std::unique_ptr<PartUnit> unit, const Subject& subject,
                                       Trace& trace) {
  if (unit) return drive_part(*unit, trace);
  if (subject.part == Part::mixer) {
    return PortFault{
        PortFault::Kind::unsupported, 0,
        fmt::format("the port makes no mixer `{}` of profile {}", subject.mixer, subject.profile)};
  }
  return PortFault{PortFault::Kind::profile, 0,
                   fmt::format("the port does not support profile {}", subject.profile)};
}

PortFault without(std::string_view part, const char* extension) {
  return {PortFault::Kind::unsupported, 0,
          fmt::format("the port has no {} (extension {})", part, extension)};
}

}  // namespace

std::optional<PortFault> drive(Unit& unit, Trace& trace) { return drive_part(unit, trace); }

Subject subject_of(const Case& the_case) {
  return {the_case.profile, the_case.part, the_case.mixer};
}

std::optional<PortFault> drive(Port& port, const Subject& subject, Trace& trace) {
  switch (subject.part) {
    case Part::mixer:
      if (!port.has_mixer()) return without("mixer", ATTEST_EXTENSION_MIXER);
      return drive_created(port.create_mixer(subject.profile, subject.mixer), subject, trace);
    case Part::battery_status:
      if (!port.has_battery_status()) {
        return without("battery estimate", ATTEST_EXTENSION_BATTERY_STATUS);
      }
      return drive_created(port.create_battery_status(subject.profile), subject, trace);
    default:
      return drive_created(port.create(subject.profile), subject, trace);
  }
}

}  // namespace attest
