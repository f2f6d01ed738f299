#include "harness/report/rate_sweep_text.hpp"

#include <fmt/format.h>

#include "harness/report/text.hpp"

namespace attest {
namespace {

std::string cell(double value, const char* unit) {
  return value < 0 ? "none" : fmt::format("{:g} {}", value, unit);
}

std::string csv_cell(double value) { return value < 0 ? "" : fmt::format("{:g}", value); }

}  // namespace

std::vector<RateSweepRow> rate_sweep_rows(const std::vector<RateSweepResult>& results) {
  std::vector<RateSweepRow> rows;
  for (const auto& [result, lowest_rate_hz, largest_delay_ms, trials] : results) {
    if (rows.empty() || rows.back().plant_configuration != *result.plant_configuration) {
      rows.push_back({*result.plant_configuration, -1, {}, {}});
    }
    RateSweepRow& row = rows.back();
    if (result.verdict != Verdict::pass && row.failure.empty()) {
      row.failure = fmt::format("{}: {}", name_of(result.verdict), one_line(result.reason));
    }
    if (lowest_rate_hz) row.lowest_rate_hz = *lowest_rate_hz;
    if (largest_delay_ms) row.largest_delay_ms.push_back(*largest_delay_ms);
  }
  return rows;
}

std::string render_rate_sweep(const std::vector<RateSweepRow>& rows,
                              const std::vector<LoopRate>& rates) {
  std::string out = fmt::format("{:<14}{:<8}{:>12}", "vehicle", "plant", "lowest rate");
  for (const LoopRate& rate : rates) out += fmt::format("{:>17}", "at " + rate.to_string() + " Hz");
  out += "\n";
  for (const RateSweepRow& row : rows) {
    out += fmt::format("{:<14}{:<8}{:>12}", row.plant_configuration.vehicle,
                       name_of(row.plant_configuration.plant), cell(row.lowest_rate_hz, "Hz"));
    for (const double delay : row.largest_delay_ms) out += fmt::format("{:>17}", cell(delay, "ms"));
    if (!row.failure.empty()) out += "  " + row.failure;
    out += "\n";
  }
  return out;
}

std::string rate_sweep_csv(const std::vector<RateSweepRow>& rows,
                           const std::vector<LoopRate>& rates) {
  std::string out = "vehicle,plant,rate_hz,largest_delay_ms,lowest_rate_hz\n";
  for (const RateSweepRow& row : rows) {
    for (std::size_t i = 0; i < row.largest_delay_ms.size(); ++i) {
      out += fmt::format("{},{},{},{},{}\n", row.plant_configuration.vehicle,
                         name_of(row.plant_configuration.plant), rates[i].to_string(),
                         csv_cell(row.largest_delay_ms[i]), csv_cell(row.lowest_rate_hz));
    }
  }
  return out;
}

}  // namespace attest
