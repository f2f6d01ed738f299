#include "harness/compare/misrecording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/agreement.hpp"

namespace attest {
namespace {

using Values = std::vector<double>;  // of a channel, tick by tick

struct Signal {
  std::string name;
  Values got, want;
};

// The outputs of a topic that are numbers: "out/vehicle_rates_setpoint".
using Topics = std::map<std::string, std::vector<Signal>>;

Topics topics_of(const Trace& got, const Trace& want) {
  Topics topics;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (!got.present[i] || !want.present[i] || !channel.is_output()) continue;
    if (channel.type != ChannelType::f32) continue;
    Signal signal{std::string(channel.name), {}, {}};
    for (const Sample& sample : got.samples) signal.got.push_back(value_of(channel, sample));
    for (const Sample& sample : want.samples) signal.want.push_back(value_of(channel, sample));
    topics[fmt::format("out/{}", channel.topic())].push_back(std::move(signal));
  }
  return topics;
}

bool is_near(double got, double want) {
  constexpr double relative = 1e-3, absolute = 1e-5;
  return agree(got, want, absolute + relative * std::abs(want));
}

bool are_near(const Values& got, const Values& want, double factor) {
  for (std::size_t i = 0; i < got.size(); ++i) {
    if (!is_near(got[i] * factor, want[i])) return false;
  }
  return true;
}

// Far enough from zero that a factor shows.
bool is_large(const Values& values) {
  constexpr double least = 1e-3;
  return std::any_of(values.begin(), values.end(),
                     [](double value) { return std::abs(value) > least; });
}

struct Unit {
  double factor;  // that makes the recorded value the expected one
  const char* what;
};

constexpr double degrees = 180 / 3.14159265358979323846;
constexpr std::array units{
    Unit{1 / degrees, "57.3 times the expected values: in degrees; write radians"},
    Unit{degrees, "the expected values divided by 57.3: converted to radians twice?"},
    Unit{1e-3, "1000 times the expected values; write them in their own unit"},
    Unit{1e3, "a thousandth of the expected values; write them in their own unit"},
    Unit{1e-2, "100 times the expected values: in percent; write 0..1"},
    Unit{1e2, "a hundredth of the expected values"},
    Unit{-1, "the expected values with the other sign"},
};

// Names the signals of a topic that do not agree, if all of them are large and one factor makes
// them agree.
std::string other_unit(const std::string& topic, const std::vector<Signal>& signals) {
  for (const Unit& unit : units) {
    std::vector<std::string> wrong;
    bool fits = true;
    for (const Signal& signal : signals) {
      if (are_near(signal.got, signal.want, 1)) continue;
      fits = fits && is_large(signal.want) && are_near(signal.got, signal.want, unit.factor);
      wrong.push_back(signal.name);
    }
    if (!fits || wrong.empty()) continue;
    const bool are_all = wrong.size() == signals.size();
    return fmt::format("{} looks like {}",
                       are_all ? topic : fmt::format("{}", fmt::join(wrong, ", ")), unit.what);
  }
  return "";
}

// "out/vehicle_rates_setpoint.roll has the values expected of out/vehicle_rates_setpoint.pitch"
std::string exchanged(const std::vector<Signal>& signals) {
  std::vector<std::string> pairs;
  for (const Signal& signal : signals) {
    if (are_near(signal.got, signal.want, 1)) continue;
    const auto other = std::find_if(signals.begin(), signals.end(), [&](const Signal& candidate) {
      return is_large(candidate.want) && are_near(signal.got, candidate.want, 1);
    });
    if (other == signals.end()) return "";
    pairs.push_back(fmt::format("{} has the values expected of {}", signal.name, other->name));
  }
  return fmt::format("{}", fmt::join(pairs, ", "));
}

// Whether every signal agrees when tick `i` of the recording is compared with tick `want_of(i)`,
// and at least one signal does not agree without this.
bool fits_at(const Topics& topics, const std::function<std::size_t(std::size_t)>& want_of) {
  bool is_shown = false;
  for (const auto& [topic, signals] : topics) {
    for (const Signal& signal : signals) {
      for (std::size_t i = 0; i < signal.got.size(); ++i) {
        const std::size_t j = want_of(i);
        if (j >= signal.want.size()) continue;
        if (!is_near(signal.got[i], signal.want[j])) return false;
      }
      is_shown = is_shown || !are_near(signal.got, signal.want, 1);
    }
  }
  return is_shown;
}

std::string other_order(const Topics& topics, std::size_t ticks) {
  if (fits_at(topics, [](std::size_t i) { return i - 1; })) {
    return "every output looks a tick late: row n has what tick n-1 should have";
  }
  if (fits_at(topics, [](std::size_t i) { return i + 1; })) {
    return "every output looks a tick early: row n has what tick n+1 should have";
  }
  if (fits_at(topics, [ticks](std::size_t i) { return ticks - 1 - i; })) {
    return "the rows look reversed: the last tick comes first";
  }
  return "";
}

}  // namespace

std::string misrecording(const Trace& got, const Trace& want) {
  const Topics topics = topics_of(got, want);
  // With few ticks, a shift may agree by chance.
  constexpr std::size_t enough_ticks = 4;
  if (got.samples.size() >= enough_ticks) {
    if (std::string order = other_order(topics, got.samples.size()); !order.empty()) return order;
  }
  std::vector<std::string> found;
  for (const auto& [topic, signals] : topics) {
    std::string what = other_unit(topic, signals);
    if (what.empty()) what = exchanged(signals);
    if (!what.empty()) found.push_back(std::move(what));
  }
  return fmt::format("{}", fmt::join(found, "; "));
}

}  // namespace attest
