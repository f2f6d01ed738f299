#include "harness/casefile/parse_rates.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace attest {
namespace {

std::vector<LoopRate> default_rates(Module module) {
  const auto hertz = info_of(module).default_rates_hz;
  if (hertz.empty()) return {standard_rates().begin(), standard_rates().end()};
  std::vector<LoopRate> rates;
  for (const int one : hertz) rates.emplace_back(Rate::hz(one));
  return rates;
}

// Common pairs of rates [Hz]: attitude unit, rate unit.
std::vector<LoopRate> cascade_rates() {
  std::vector<LoopRate> rates;
  for (const auto& [attitude, rate] :
       {std::pair(50, 250), {100, 400}, {200, 400}, {250, 1000}, {250, 2000}, {250, 8000}}) {
    rates.emplace_back(Rate::hz(attitude), Rate::hz(rate));
  }
  return rates;
}

std::vector<std::string> rate_texts(const TomlTable& table, const char* key, bool is_cascade) {
  if (is_cascade) return table.texts(key);
  std::vector<std::string> texts;
  for (const double hertz : table.numbers(key)) texts.push_back(fmt::format("{}", hertz));
  return texts;
}

}  // namespace

std::vector<LoopRate> parse_loop_rates(const TomlTable& table, const char* key, bool is_cascade) {
  std::vector<LoopRate> rates;
  for (const std::string& text : rate_texts(table, key, is_cascade)) {
    const auto rate = LoopRate::parse(text);
    if (!rate) {
      table.error(key, rate.error().message);
    } else if (is_cascade && !rate->attitude_unit) {
      table.error(key, fmt::format("`{}` is one rate; a flight of the cascade needs that of the "
                                   "attitude unit too, as in \"250:1000\"",
                                   text));
    } else {
      rates.push_back(*rate);
    }
  }
  std::sort(rates.begin(), rates.end());
  if (rates.empty()) table.error(key, "names no rate");
  if (std::adjacent_find(rates.begin(), rates.end()) != rates.end()) {
    table.error(key, "names a rate twice");
  }
  return rates;
}

std::vector<LoopRate> parse_rates(const TomlTable& root, const Case& parsed) {
  constexpr const char* key = "rates_hz";
  if (!root.has(key)) {
    if (root.has("rates_why")) root.error("rates_why", "explains `rates_hz`, which is not there");
    return parsed.attitude_loop ? cascade_rates() : default_rates(parsed.module);
  }
  root.text("rates_why");  // required: a case that leaves out rates must say why
  return parse_loop_rates(root, key, parsed.attitude_loop.has_value());
}

}  // namespace attest
