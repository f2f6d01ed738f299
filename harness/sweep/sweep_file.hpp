// A sweep file: a flight, the dispersions of its values, the design of the samples, and the
// requirements on the flights. SCHEMA.md lists every key.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "harness/compare/metric.hpp"
#include "harness/core/loop_rate.hpp"
#include "harness/core/result.hpp"
#include "harness/core/toml_document.hpp"
#include "harness/sweep/design.hpp"
#include "harness/sweep/distribution.hpp"

namespace attest {

// A number of the case file or the vehicle file that is dispersed.
struct DispersedKey {
  enum class Document { vehicle, the_case };
  Document document = Document::vehicle;
  std::string path;  // in the document, as for TomlDocument
  double base = 0;   // the number in the document; 0 if the document has no such key
};

struct Dispersion {
  std::string name;
  std::vector<DispersedKey> keys;  // all of them get the same drawn number
  // What the drawn number is: the value itself, a factor of the base, or an addition to it.
  enum class As { value, factor, offset };
  As as = As::value;
  Distribution distribution;
  std::uint64_t levels = 0;  // in a grid
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
  // The sweep ends at the first sample after which sequential intervals decide all requirements.
  // With a port, there must also be enough samples for the sign tests (pairs_to_compare()).
  bool stop_when_decided = false;
  // A difference between port and reference does not count up to this part of the metric's size:
  // the reference's on this sample, or the reference's median size over all samples if that is
  // larger.
  double tie = 1e-3;
};

// `samples` replaces the number of samples in the file, unless it is 0. Errors, with file:line and
// all in one message: those of TomlFile, values out of range, a matrix that is not positive
// definite.
Result<SweepFile> parse_sweep(std::string_view text, const std::filesystem::path& file,
                              std::uint64_t samples = 0);

// Sets the base values. Errors, with the line of the sweep file: a key that is no number, a key
// with two dispersions, a factor or offset for a key that the document does not have, a requirement
// on a metric that the case does not have.
Result<void> bind_sweep(const TomlDocument& the_case, const TomlDocument& vehicle,
                        const std::vector<Metric>& metrics, SweepFile& sweep);

}  // namespace attest
