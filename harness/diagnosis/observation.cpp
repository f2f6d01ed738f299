#include "harness/diagnosis/observation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

#include "harness/core/agreement.hpp"
#include "harness/diagnosis/conditions.hpp"

namespace attest {
namespace {

// A change of an integral counts as deviating from this share of the largest deviation of the
// vector on. So rounding does not count.
constexpr double least_share = 0.02;

// A quotient of values below this many tolerances says little.
constexpr double least_for_quotient = 50;

int axis_of(const Channel& channel) {
  const std::string_view field = channel.field();
  const bool is_thrust =
      field.starts_with("thrust") || channel.topic() == "vehicle_thrust_setpoint";
  if (is_thrust || channel.quantity == Quantity::quaternion) return -1;
  if (field.starts_with("roll") || field.ends_with("[0]")) return 0;
  if (field.starts_with("pitch") || field.ends_with("[1]")) return 1;
  if (field.starts_with("yaw") || field.ends_with("[2]")) return 2;
  return -1;
}

// An output, its values at each tick, and what a step adds to their deviation.
struct Compared {
  Channel channel;
  int axis = -1;
  Tolerance tolerance;
  std::vector<double> port, expected;
  std::vector<double> added;  // NaN if a value is not finite
  std::vector<bool> deviates;
};

Compared values_of(std::size_t index, const Outputs& port, const Outputs& expected,
                   const Tolerances& tolerances) {
  const Channel& channel = channels()[index];
  Compared output{channel, axis_of(channel), tolerances.of(index), {}, {}, {}, {}};
  for (std::size_t tick = 0; tick < port.size(); ++tick) {
    output.port.push_back(value_of(channel, port[tick].sample()));
    output.expected.push_back(value_of(channel, expected[tick].sample()));
  }
  return output;
}

bool differs(const Compared& output, std::size_t tick) {
  const double port = output.port[tick], expected = output.expected[tick];
  if (output.channel.type != ChannelType::f32) return (port != 0) != (expected != 0);
  return !agree(static_cast<float>(port), static_cast<float>(expected),
                output.tolerance.at(expected));
}

// An integral's deviation stays, so only its change is that of the step.
void find_changes(Compared& output) {
  double largest = 0, before = 0;
  bool fails = false;
  for (std::size_t tick = 0; tick < output.port.size(); ++tick) {
    const double now = output.port[tick] - output.expected[tick];
    output.added.push_back(now - before);
    before = now;
    fails = fails || differs(output, tick);
    if (std::isfinite(output.added.back())) {
      largest = std::max(largest, std::abs(output.added.back()));
    }
  }
  for (std::size_t tick = 0; tick < output.added.size(); ++tick) {
    const double added = output.added[tick];
    const bool is_large = !(std::abs(added) <= least_share * largest);
    output.deviates.push_back(fails && (std::isfinite(added) ? is_large : differs(output, tick)));
  }
}

// The integral of the step before is part of a torque.
void find_additions(const Compared* integral, Compared& output) {
  for (std::size_t tick = 0; tick < output.port.size(); ++tick) {
    const double carried =
        integral && tick > 0 ? integral->port[tick - 1] - integral->expected[tick - 1] : 0;
    const double added = output.port[tick] - output.expected[tick] - carried;
    output.added.push_back(added);
    const bool is_carried =
        std::isfinite(added) && std::abs(added) <= output.tolerance.at(output.expected[tick]);
    output.deviates.push_back(differs(output, tick) && !is_carried);
  }
}

bool is_integral(const Compared& output) { return output.channel.quantity == Quantity::integral; }

std::vector<Compared> compared_outputs(Module module, const Outputs& port, const Outputs& expected,
                                       const Tolerances& tolerances) {
  std::vector<Compared> outputs;
  const ChannelSet of_module = channels_of(module, "out/");
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (of_module[i]) outputs.push_back(values_of(i, port, expected, tolerances));
  }
  for (Compared& output : outputs) {
    if (is_integral(output)) {
      find_changes(output);
      continue;
    }
    const auto integral = std::find_if(outputs.begin(), outputs.end(), [&](const Compared& one) {
      return is_integral(one) && one.axis == output.axis && output.axis >= 0 &&
             output.channel.stage == Stage::rate_law;
    });
    find_additions(integral == outputs.end() ? nullptr : &*integral, output);
  }
  return outputs;
}

// Whether the topic of the output is published at each tick; empty if it has no such flag.
std::optional<std::size_t> published_flag(const std::vector<Compared>& outputs,
                                          const Compared& output) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const Channel& channel = outputs[i].channel;
    if (channel.is_published_flag() && channel.topic() == output.channel.topic()) return i;
  }
  return std::nullopt;
}

Relations relations_of(const Compared& output, const Compared* published, std::size_t tick) {
  Relations one;
  one.values = 1;
  const bool is_integral_output = is_integral(output) && tick > 0;
  const double port = output.port[tick] - (is_integral_output ? output.port[tick - 1] : 0);
  const double expected =
      output.expected[tick] - (is_integral_output ? output.expected[tick - 1] : 0);
  const double allowed = output.tolerance.at(expected);
  const auto same = [allowed](double a, double b) { return std::abs(a - b) <= allowed; };
  const bool is_published = !published || published->expected[tick] != 0;
  one.cleared = output.port[tick] == 0 && !is_published ? 1 : 0;
  one.zero = output.port[tick] == 0 && is_published ? 1 : 0;
  one.reversed = same(port, -expected) ? 1 : 0;
  one.late = tick > 0 && same(output.port[tick], output.expected[tick - 1]) ? 1 : 0;
  if (std::isfinite(port) && port * expected > 0 && std::abs(port) < std::abs(expected)) {
    one.smaller = 1;
    one.smaller_from = one.smaller_to = std::abs(port);
  }
  const double least = is_integral_output ? 1e-6 : least_for_quotient * allowed;
  if (std::isfinite(port) && std::abs(expected) > least) {
    one.quotients = 1;
    one.quotient_from = one.quotient_to = port / expected;
  }
  return one;
}

void add_to(std::vector<Where>& all, const Where& added) {
  const auto known = std::ranges::find(all, added.condition, &Where::condition);
  if (known == all.end()) return all.push_back(added);
  known->tally.deviating += added.tally.deviating;
  known->tally.agreeing += added.tally.agreeing;
}

void count(bool deviates, Tally& tally) { ++(deviates ? tally.deviating : tally.agreeing); }

}  // namespace

void Relations::add(const Relations& other) {
  values += other.values;
  cleared += other.cleared;
  zero += other.zero;
  reversed += other.reversed;
  late += other.late;
  smaller += other.smaller;
  smaller_from = std::min(smaller_from, other.smaller_from);
  smaller_to = std::max(smaller_to, other.smaller_to);
  quotients += other.quotients;
  quotient_from = std::min(quotient_from, other.quotient_from);
  quotient_to = std::max(quotient_to, other.quotient_to);
}

void Observed::add(const Observed& other) {
  all.deviating += other.all.deviating;
  all.agreeing += other.all.agreeing;
  for (const Where& one : other.where) add_to(where, one);
  relations.add(other.relations);
}

Observation observe(const Trace& given, const Outputs& port, const Outputs& expected,
                    const ModuleUnderTest& subject, const Tolerances& tolerances) {
  const Trace right = with_outputs(given, expected);
  const std::vector<Condition> conditions = conditions_of(right, subject);
  Observation observation;
  const std::vector<Compared> outputs =
      compared_outputs(subject.module, port, expected, tolerances);
  for (const Compared& output : outputs) {
    Observed& observed = observation[{output.channel.stage, output.axis}];
    const auto published = published_flag(outputs, output);
    for (std::size_t tick = 0; tick < port.size(); ++tick) {
      count(output.deviates[tick], observed.all);
      if (!output.deviates[tick]) continue;
      observed.relations.add(
          relations_of(output, published ? &outputs[*published] : nullptr, tick));
    }
    for (const Condition& condition : conditions) {
      Tally tally;
      for (std::size_t tick = 0; tick < port.size(); ++tick) {
        if (condition.holds(tick, output.axis)) count(output.deviates[tick], tally);
      }
      if (tally.deviating + tally.agreeing == 0) continue;
      add_to(observed.where, {condition.text, tally, condition.kind});
    }
  }
  return observation;
}

nlohmann::json to_json(const Observation& observation) {
  nlohmann::json rows = nlohmann::json::array();
  for (const auto& [of, observed] : observation) {
    nlohmann::json where = nlohmann::json::array();
    for (const Where& one : observed.where) {
      where.push_back(nlohmann::json::array(
          {one.condition, one.tally.deviating, one.tally.agreeing, static_cast<int>(one.kind)}));
    }
    const Relations& r = observed.relations;
    rows.push_back({static_cast<int>(of.stage), of.axis, observed.all.deviating,
                    observed.all.agreeing, where,
                    nlohmann::json::array({r.values, r.cleared, r.zero, r.reversed, r.late,
                                           r.smaller, r.smaller_from, r.smaller_to, r.quotients,
                                           r.quotient_from, r.quotient_to})});
  }
  return rows;
}

Observation observation_from(const nlohmann::json& in) {
  Observation observation;
  for (const auto& row : in) {
    Observed& observed =
        observation[{static_cast<Stage>(row.at(0).get<int>()), row.at(1).get<int>()}];
    observed.all = {row.at(2).get<std::size_t>(), row.at(3).get<std::size_t>()};
    for (const auto& one : row.at(4)) {
      observed.where.push_back({one.at(0).get<std::string>(),
                                {one.at(1).get<std::size_t>(), one.at(2).get<std::size_t>()},
                                static_cast<ConditionKind>(one.at(3).get<int>())});
    }
    const auto& numbers = row.at(5);
    const auto count = [&](std::size_t i) { return numbers.at(i).get<std::size_t>(); };
    const auto value = [&](std::size_t i) { return numbers.at(i).get<double>(); };
    observed.relations = {count(0), count(1), count(2), count(3), count(4), count(5),
                          value(6), value(7), count(8), value(9), value(10)};
  }
  return observation;
}

}  // namespace attest
