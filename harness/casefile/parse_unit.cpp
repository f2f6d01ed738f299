#include "harness/casefile/parse_unit.hpp"

#include <algorithm>
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

UnitTiming parse_unit(const TomlTable& root, const char* name) {
  UnitTiming unit;
  if (!root.has(name)) return unit;
  const TomlTable table = root.table(name);
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
    table.error("drop_every",
                "must be 2 or more: of each group of this many ticks, the last is left out");
  }
  if (table.has("stall")) unit.stall = parse_stall(table.table("stall"));
  if (table.has("trigger")) {
    unit.on_estimate = table.text("trigger") == "estimator";
    if (!unit.on_estimate) table.error("trigger", "must be \"estimator\"");
    if (!root.has("flight")) table.error("trigger", "needs a [flight], which has an estimator");
  }
  return unit;
}

void check_unit(const TomlTable& root, const char* name, const UnitTiming& unit,
                const std::vector<Rate>& rates, const Span& duration) {
  const bool is_known = duration.amount > 0 && !rates.empty();
  if (!root.has(name) || !is_known) return;
  const TomlTable table = root.table(name);
  const auto [slowest_at, fastest_at] = std::minmax_element(rates.begin(), rates.end());
  const Rate &slowest = *slowest_at, &fastest = *fastest_at;
  // Jitter reduces the time between ticks, and timestamps must increase by at least 1 us.
  if (!unit.heavy_tail && unit.jitter > 0 && (1 - unit.jitter) * fastest.period_s() < 1e-6) {
    table.error("jitter",
                fmt::format("leaves less than 1 us between ticks at {} Hz", fastest.to_string()));
  }
  if (const auto& stall = unit.stall;
      stall && !(stall->length.on(slowest) < stall->every.on(slowest) &&
                 stall->length.on(fastest) < stall->every.on(fastest))) {
    table.error("stall", "must end before the next one begins: `for` must be less than `every`");
  }
  const std::set<std::int64_t> drops(unit.drop_ticks.begin(), unit.drop_ticks.end());
  if (drops.empty()) return;
  const std::int64_t last = tick_count(duration, fastest) - 1;
  if (*drops.begin() < 0 || *drops.rbegin() > last) {
    table.error("drop_ticks", fmt::format("must be ticks of the case: from 0 to {}", last));
    return;
  }
  const std::int64_t fewest = tick_count(duration, slowest);
  if (std::distance(drops.begin(), drops.lower_bound(fewest)) == fewest) {
    table.error("drop_ticks", fmt::format("leaves no tick at {} Hz", slowest.to_string()));
  }
}

}  // namespace attest
