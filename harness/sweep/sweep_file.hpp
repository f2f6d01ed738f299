// A sweep file: a flight, the values of it that are dispersed, the design of the samples, and what
// the flights must hold. SCHEMA.md lists every key.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "harness/compare/metric.hpp"
#include "harness/core/result.hpp"
#include "harness/core/toml_document.hpp"
#include "harness/schedule/loop_rate.hpp"
#include "harness/sweep/design.hpp"
#include "harness/sweep/distribution.hpp"

namespace attest {

// Where a dispersed value goes.
struct DispersedKey {
  enum class Document { vehicle, the_case };
  Document document = Document::vehicle;
  std::string path;  // in the document, as for TomlDocument
  double base = 0;   // the value there without dispersion; 0 where there is none
};

struct Dispersion {
  std::string name;
  std::vector<DispersedKey> keys;  // all of them get the same drawn number
  // What the drawn number is: the value itself, or a factor or an addition to the value there.
  enum class As { value, factor, offset };
  As as = As::value;
  Distribution distribution;
  std::uint64_t levels = 0;  // of a grid
  int line = 0;              // in the sweep file

  double value_for(const DispersedKey& key, double drawn) const;
};

// The share of flights with a metric from `min` to `max` is at least `probability`.
struct Requirement {
  std::string name, metric;
  double min, max;  // infinite: no bound
  double probability = 1;
  int line = 0;

  bool holds(double value) const { return value >= min && value <= max; }
};

struct SweepFile {
  std::filesystem::path file;
  std::string text;
  std::string case_name;       // as for find_flight()
  std::string vehicle, plant;  // empty: the lead vehicle and the first plant of the case
  LoopRate rate;
  Design design;                        // its dimensions are the dispersions, except seeds
  std::vector<Dispersion> dispersions;  // in the order of the file
  std::vector<Requirement> requirements;
  double confidence = 0.95;
  // End at the first sample after which all requirements are decided, by sequential intervals, and
  // with a port there are enough samples for the sign tests (pairs_to_compare()).
  bool stop_when_decided = false;
  double tie = 1e-3;  // the largest relative difference of a metric that counts as none
};

// `samples` replaces the number of samples in the file, unless it is 0. Errors, all reported
// together with file:line: those of TomlFile, values out of range, a matrix that is not positive
// definite.
Result<SweepFile> parse_sweep(std::string_view text, const std::filesystem::path& file,
                              std::uint64_t samples = 0);

// Sets the base values. Errors, with the line of the sweep file: a key that is no number, a factor
// or offset to a value that is missing, a requirement on a metric that the case does not have.
Result<void> bind_sweep(const TomlDocument& the_case, const TomlDocument& vehicle,
                        const std::vector<Metric>& metrics, SweepFile& sweep);

}  // namespace attest
