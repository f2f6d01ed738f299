#include "harness/measure/cost_budget.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/file.hpp"
#include "harness/core/json_reader.hpp"
#include "harness/core/json_text.hpp"

namespace attest {
namespace {

using nlohmann::json;

constexpr const char* schema = "attest-cost-budget-1";

std::string row_of(const CostGroup& group, const WorstCost& worst) {
  return text_of(json{{"profile", group.profile},
                      {"module", group.module},
                      {"group", group.group},
                      {"rate_hz", group.rate_hz},
                      {"cost", worst.cost},
                      {"vector", worst.vector},
                      {"tick", worst.tick}});
}

void read_row(JsonReader row, CostBudget& budget) {
  CostGroup group{row.text("profile"), row.text("module"), row.text("group"), row.text("rate_hz")};
  WorstCost worst;
  worst.cost = row.integer("cost", 0, std::numeric_limits<std::uint32_t>::max());
  worst.vector = row.text("vector");
  worst.tick = row.count("tick");
  if (!budget.worst.emplace(group, std::move(worst)).second) {
    row.wrong("has " + group.to_string() + " twice");
  }
}

double growth(const CostChange& change) {
  if (!change.before) return std::numeric_limits<double>::infinity();
  return *change.before > 0 ? change.growth_percent()
                            : 100.0 * static_cast<double>(change.now.cost);
}

}  // namespace

std::string CostGroup::to_string() const {
  return fmt::format("{}/{} at {} Hz, {}", profile, group, rate_hz, module);
}

CostBudget cost_budget_of(const CorpusTimes& times, std::string port, const CostCounter& counter) {
  CostBudget budget{std::move(port), counter, {}};
  for (const VectorTimes& vector : times.vectors) {
    if (!vector.is_timed()) continue;
    const VectorResult& result = vector.result;
    WorstCost& worst = budget.worst[{result.profile, std::string(name_of(vector.module)),
                                     result.group, result.rate.to_string()}];
    const std::int64_t cost = vector.slowest().count();
    if (worst.vector.empty() || cost > worst.cost) {
      worst = {cost, result.id(), vector.slowest_tick()};
    }
  }
  return budget;
}

std::string text_of(const CostBudget& budget) {
  std::string out = fmt::format(R"({{"schema": "{}", "port": {}, "unit": "{}")", schema,
                                text_of(json(budget.port)), name_of(budget.counter.unit));
  if (budget.counter.unit == CostUnit::cycles) {
    out += fmt::format(R"(, "clock_hz": {})", text_of(json(budget.counter.clock_hz)));
  }
  out += ", \"worst\": [\n";
  const char* separator = "";
  for (const auto& [group, worst] : budget.worst) {
    out += separator + row_of(group, worst);
    separator = ",\n";
  }
  return out + "\n]}\n";
}

Result<CostBudget> read_cost_budget(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  const auto parsed = parse_json(*text, path.string());
  if (!parsed) return tl::unexpected(parsed.error());
  std::string error;
  JsonReader reader(*parsed, error);
  if (!parsed->is_object() || !reader.has("schema") || reader.text("schema") != schema) {
    return fail_at(path.string(), fmt::format("is no budget file of costs: its `schema` is not "
                                              "`{}`; `attest time --write-budget-file` writes one",
                                              schema));
  }
  CostBudget budget;
  budget.port = reader.text("port");
  std::optional<double> clock_hz;
  if (reader.has("clock_hz")) clock_hz = reader.real("clock_hz");
  const auto counter = CostCounter::make(reader.text("unit"), clock_hz);
  if (!counter) reader.wrong("is wrong: " + counter.error().message);
  if (counter) budget.counter = *counter;
  for (const json& row : reader.list("worst")) read_row(JsonReader(row, error), budget);
  if (!error.empty()) return fail_at(path.string(), error);
  return budget;
}

Result<void> check_same_port(const CostBudget& file, const CostBudget& now,
                             const std::filesystem::path& path) {
  if (file.port != now.port) {
    return fail_at(path.string(),
                   fmt::format("is of the port `{}`, and this is `{}`", file.port, now.port));
  }
  if (file.counter != now.counter) {
    return fail_at(path.string(), fmt::format("has {}, and this port counts {}",
                                              file.counter.to_string(), now.counter.to_string()));
  }
  for (const auto& [group, worst] : now.worst) {
    const std::string& profile = group.profile;
    const bool has_profile = std::ranges::any_of(
        file.worst, [&](const auto& row) { return row.first.profile == profile; });
    if (!has_profile) {
      return fail_at(
          path.string(),
          fmt::format("has no costs of {}; select its profiles with --profile", profile));
    }
  }
  return {};
}

double CostChange::growth_percent() const {
  const auto old = static_cast<double>(*before);
  return 100 * (static_cast<double>(now.cost) - old) / old;
}

std::string CostChange::to_string() const {
  if (!before) return fmt::format("{} is not in the file ({})", group.to_string(), now.vector);
  std::string growth = "from 0";
  if (*before > 0) {
    const bool is_small = std::abs(growth_percent()) < 0.1;
    growth = is_small ? fmt::format("{:+.1g}%", growth_percent())
                      : fmt::format("{:+.1f}%", growth_percent());
  }
  return fmt::format("{} -> {}, {}, in {}", count_text(*before), count_text(now.cost), growth,
                     now.vector);
}

std::vector<CostChange> changes(const CostBudget& file, const CostBudget& now,
                                double allowed_growth_percent) {
  std::vector<CostChange> found;
  for (const auto& [group, worst] : now.worst) {
    const auto row = file.worst.find(group);
    CostChange change{group, std::nullopt, worst};
    if (row != file.worst.end()) change.before = row->second.cost;
    if (change.before == worst.cost) continue;
    change.fails = growth(change) > allowed_growth_percent;
    found.push_back(std::move(change));
  }
  std::ranges::stable_sort(
      found, [](const CostChange& a, const CostChange& b) { return growth(a) > growth(b); });
  return found;
}

}  // namespace attest
