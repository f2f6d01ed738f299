#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "harness/report/flight_document.hpp"

namespace attest {
namespace {

// The times at which the signal steps, or a ramp begins. A signal that varies all the time has
// none.
std::vector<Span> changes_of(const Signal& signal) {
  if (const auto* step = std::get_if<Step>(&signal)) return {step->at};
  if (const auto* ramp = std::get_if<Ramp>(&signal)) return {ramp->start};
  const auto* samples = std::get_if<Samples>(&signal);
  if (!samples) return {};
  std::vector<Span> changes;
  for (std::size_t i = 1; i < samples->values.size(); ++i) {
    const bool is_held = samples->linear && samples->values[i] == samples->values[i - 1];
    if (!is_held) changes.push_back(samples->times[samples->linear ? i - 1 : i]);
  }
  return changes;
}

}  // namespace

std::vector<PlotMark> marks_of(const Case& the_case, const SimulatedFlight& simulated) {
  const Flight& flight = *the_case.flight;
  std::vector<PlotMark> marks;
  const auto add = [&](const Span& at, const std::string& what) {
    const PlotMark mark{in_seconds(at.on(simulated.result.rate.motor_unit)), what, true};
    const bool is_known = std::ranges::any_of(
        marks, [&](const PlotMark& one) { return one.x == mark.x && one.text == mark.text; });
    if (!is_known) marks.push_back(mark);
  };
  for (const auto& [signals, what] : {std::pair(&flight.wind_m_s, "wind"),
                                      std::pair(&flight.centre_of_mass_of_arm, "load moves")}) {
    for (const Signal& signal : *signals) {
      for (const Span& at : changes_of(signal)) add(at, what);
    }
  }
  if (flight.motor_failure) {
    add(flight.motor_failure->at, fmt::format("motor {} fails", flight.motor_failure->rotor));
  }
  if (flight.estimator.reset) add(flight.estimator.reset->at, "estimator reset");
  if (const auto& first = simulated.result.first) {
    const std::uint64_t begin_us = simulated.flown.trace.samples.front().in.timestamp;
    const double elapsed_us = static_cast<double>(first->timestamp_us - begin_us);
    marks.push_back(
        {1e-6 * elapsed_us, fmt::format("first deviation: {}", channels()[first->channel].name)});
  }
  std::ranges::stable_sort(marks, {}, &PlotMark::x);
  return marks;
}

}  // namespace attest
