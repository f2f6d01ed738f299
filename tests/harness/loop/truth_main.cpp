// Prints the tables of models/README.md: `ci/truth`. Exits 1 if a bound was missed.
#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "tests/harness/loop/loop_truth.hpp"
#include "tests/harness/plant/truth.hpp"

namespace {

// Bold if the value is not within it.
std::string judged(const std::string& bound, bool within) {
  return within ? bound : "**" + bound + "**";
}

bool print_plants() {
  bool met = true;
  fmt::print("| what | against | plant | measured | bound |\n|---|---|---|---|---|\n");
  for (const auto& [what, against, plant, unit, measured, min, max] : attest::test::truths()) {
    const bool within = measured >= min && measured <= max;
    met = met && within;
    const std::string suffix = unit == "1" ? "" : " " + unit;
    const std::string bound =
        min > 0 ? fmt::format("{:g} to {:g}", min, max) : fmt::format("{:g}{}", max, suffix);
    fmt::print("| {} | {} | {} | {:.2g}{} | {} |\n", what, against, plant, measured, suffix,
               judged(bound, within));
  }
  return met;
}

bool print_loop() {
  constexpr int setpoints = 20'000;
  bool met = true;
  fmt::print("| of | what | simpler model | measured | exact | difference | bound |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  for (const auto& [what, of, unit, simple, measured, exact, difference, bound] :
       attest::test::loop_truths(setpoints)) {
    const bool within = difference <= bound;
    met = met && within;
    const std::string suffix = unit.empty() ? "" : " " + unit;
    const std::string other = simple ? fmt::format("{:.2g}{}", *simple, suffix) : "";
    fmt::print("| {} | {} | {} | {:.3g}{} | {:.3g}{} | {:.2g} | {} |\n", of, what, other, measured,
               suffix, exact, suffix, difference, judged(fmt::format("{:g}", bound), within));
  }
  return met;
}

}  // namespace

int main() {
  const bool plants = print_plants();
  fmt::print("\n");
  const bool loop = print_loop();
  return plants && loop ? 0 : 1;
}
