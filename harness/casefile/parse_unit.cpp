#include "harness/casefile/parse_unit.hpp"

#include <cmath>
#include <iterator>
#include <set>
#include <string>

#include <fmt/format.h>

#include "harness/casefile/parse_signal.hpp"

namespace attest {
namespace {

UnitStall parse_stall(const TomlTable& table) {
  UnitStall stall{parse_span(table, "every"), parse_span(table, "for"),
                  table.boolean("catches_up", false)};
  if (!(stall.every.amount > 0)) table.error(span_key(table, "every"), "must be positive");
  if (!(stall.length.amount > 0)) table.error(span_key(table, "for"), "must be positive");
  return stall;
}

}  // namespace

UnitTiming parse_unit(const TomlTable& root) {
  UnitTiming unit;
  if (!root.has("unit")) return unit;
  const TomlTable table = root.table("unit");
  unit.start.amount = table.number("start_s", unit.start.amount);
  // A double holds 285 years (9e9 s) of whole microseconds. The longest case lasts 1e9 s.
  if (!(unit.start.amount >= 0 && unit.start.amount <= 8e9)) {
    table.error("start_s", "must be from 0 up to 8e9");
  }
  unit.jitter = table.number("jitter", 0);
  if (!(unit.jitter >= 0 && unit.jitter < 1)) {
    table.error("jitter", "is a fraction of a period: must be 0 or more, and less than 1");
  }
  const std::string shape = table.text("jitter_shape", "uniform");
  unit.heavy_tail = shape == "heavy";
  if (shape != "uniform" && shape != "heavy") {
    table.error("jitter_shape", "must be uniform or heavy");
  }
  unit.seed = static_cast<std::uint64_t>(table.integer("seed", 1));
  if (table.has("drop_ticks")) unit.drop_ticks = table.integers("drop_ticks");
  unit.drop_every = table.integer("drop_every", 0);
  if (table.has("drop_every") && unit.drop_every < 2) {
    table.error("drop_every", "must be 2 or more: the last of each so many ticks is left out");
  }
  if (table.has("stall")) unit.stall = parse_stall(table.table("stall"));
  if (table.has("trigger")) {
    unit.on_estimate = table.text("trigger") == "estimator";
    if (!unit.on_estimate) table.error("trigger", "must be \"estimator\"");
    if (!root.has("flight")) table.error("trigger", "needs a [flight], which has an estimator");
  }
  return unit;
}

void check_unit(const TomlTable& root, const Case& parsed) {
  const bool is_known = parsed.duration.amount > 0 && !parsed.rates.empty();
  if (!root.has("unit") || !is_known) return;
  const TomlTable table = root.table("unit");
  const Rate& slowest = parsed.rates.front();
  const Rate& fastest = parsed.rates.back();
  // Jitter reduces the time between ticks, and timestamps (us) must increase.
  if (!parsed.unit.heavy_tail && parsed.unit.jitter > 0 &&
      (1 - parsed.unit.jitter) * fastest.period_s() < 1e-6) {
    table.error("jitter",
                fmt::format("leaves less than 1 us between ticks at {} Hz", fastest.to_string()));
  }
  if (const auto& stall = parsed.unit.stall;
      stall && !(stall->length.on(slowest) < stall->every.on(slowest) &&
                 stall->length.on(fastest) < stall->every.on(fastest))) {
    table.error("stall", "must end before the next one begins: `for` must be less than `every`");
  }
  const std::set<std::int64_t> drops(parsed.unit.drop_ticks.begin(), parsed.unit.drop_ticks.end());
  if (drops.empty()) return;
  const std::int64_t last = tick_count(parsed.duration, fastest) - 1;
  if (*drops.begin() < 0 || *drops.rbegin() > last) {
    table.error("drop_ticks", fmt::format("must be ticks of the case: from 0 to {}", last));
    return;
  }
  const std::int64_t fewest = tick_count(parsed.duration, slowest);
  if (std::distance(drops.begin(), drops.lower_bound(fewest)) == fewest) {
    table.error("drop_ticks", fmt::format("leaves no tick at {} Hz", slowest.to_string()));
  }
}

}  // namespace attest
