// Prints the table of models/README.md: `ci/truth`. Exits 1 if a bound was missed.
#include <cstdio>

#include <fmt/format.h>

#include "tests/harness/plant/truth.hpp"

int main() {
  bool met = true;
  fmt::print("| what | against | plant | measured | bound |\n|---|---|---|---|---|\n");
  for (const auto& [what, against, plant, unit, measured, min, max] : attest::test::truths()) {
    const bool within = measured >= min && measured <= max;
    met = met && within;
    const std::string bound = min > 0 ? fmt::format("{:g} to {:g}", min, max)
                                      : fmt::format("{:g}{}", max, unit == "1" ? "" : " " + unit);
    fmt::print("| {} | {} | {} | {:.2g}{} | {} |\n", what, against, plant, measured,
               unit == "1" ? "" : " " + unit, within ? bound : "**" + bound + "**");
  }
  return met ? 0 : 1;
}
