#include "harness/sweep/sweep_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/suggestion.hpp"
#include "harness/core/toml.hpp"
#include "harness/sweep/parse_dispersions.hpp"

namespace attest {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::int64_t sweep_schema = 1;
// The report keeps all numbers of the table in memory: 1.6 GB for this many samples with 20
// numbers.
constexpr std::uint64_t most_samples = 10'000'000;

LoopRate parse_rate(const TomlTable& root) {
  constexpr const char* key = "rate";
  const TomlKind kind = root.kind(key);
  const bool is_number = kind == TomlKind::integer || kind == TomlKind::number;
  const std::string text = is_number ? fmt::format("{}", root.number(key)) : root.text(key);
  const auto rate = LoopRate::parse(text);
  if (rate) return *rate;
  if (root.has(key)) root.error(key, rate.error().message);
  return {};
}

std::vector<std::uint64_t> levels_of(const std::vector<Dispersion>& dispersions) {
  std::vector<std::uint64_t> levels;
  for (const std::size_t i : dimensions_of(dispersions)) levels.push_back(dispersions[i].levels);
  return levels;
}

// The product of the levels. Ends as soon as it is above most_samples, so it does not overflow.
std::uint64_t product(const std::vector<std::uint64_t>& levels) {
  std::uint64_t samples = 1;
  for (const std::uint64_t count : levels) {
    samples *= std::max<std::uint64_t>(count, 1);
    if (samples > most_samples) return samples;
  }
  return samples;
}

void parse_samples(const TomlTable& root, std::uint64_t replaced, SweepFile& sweep) {
  constexpr const char* key = "samples";
  Design& design = sweep.design;
  if (design.kind == DesignKind::grid) {
    design.levels = levels_of(sweep.dispersions);
    design.samples = product(design.levels);
    if (root.has(key)) root.error(key, "a grid has the product of its levels; leave it out");
    if (replaced != 0) root.error("design", "a grid has fixed samples; leave --samples out");
  } else {
    const std::int64_t samples = root.integer(key);
    if (root.has(key) && samples < 1) root.error(key, "must be positive");
    design.samples = replaced != 0 ? replaced : static_cast<std::uint64_t>(std::max(samples, 0l));
  }
  if (design.kind == DesignKind::saltelli && design.samples % design.block() != 0) {
    root.error(key, fmt::format("must be a multiple of {}: a block is two points, and one more for "
                                "each of {} dispersions",
                                design.block(), design.dimensions));
  }
  if (design.samples > most_samples) {
    root.error(
        design.kind == DesignKind::grid ? "design" : key,
        fmt::format("has {} samples; at most {} are possible", design.samples, most_samples));
  }
}

Requirement parse_requirement(const TomlTable& all, const std::string& name) {
  const TomlTable table = all.table(name);
  Requirement requirement{name, table.text("metric", name), -infinity, infinity, 1, all.line(name)};
  requirement.min = table.number("min", requirement.min);
  requirement.max = table.number("max", requirement.max);
  if (!table.has("min") && !table.has("max")) {
    all.error(name, "needs `min` or `max`; without a bound, every flight holds it");
  } else if (!(requirement.min <= requirement.max)) {
    table.error(table.has("max") ? "max" : "min", "no number is within these bounds");
  }
  requirement.probability = table.number("probability");
  const bool is_probability = requirement.probability > 0 && requirement.probability < 1;
  if (table.has("probability") && !is_probability) {
    table.error("probability", "must be between 0 and 1; samples cannot show a probability of 1");
  }
  return requirement;
}

void parse_requirements(const TomlTable& root, SweepFile& sweep) {
  if (root.has("require")) {
    const TomlTable all = root.table("require");
    for (const std::string& name : all.keys()) {
      sweep.requirements.push_back(parse_requirement(all, name));
    }
  }
  const DesignKind design = sweep.design.kind;
  if (!sweep.requirements.empty() &&
      (design == DesignKind::sobol || design == DesignKind::saltelli)) {
    root.error("require", "needs the design `monte_carlo`, `latin_hypercube` or `grid`");
  }
  constexpr const char* key = "stop_when_decided";
  sweep.stop_when_decided = root.boolean(key, false);
  if (!sweep.stop_when_decided) return;
  if (sweep.requirements.empty()) root.error(key, "needs a requirement: [require.NAME]");
  if (design != DesignKind::monte_carlo) {
    root.error(key, "needs independent samples: use the design `monte_carlo`");
  }
}

void parse_root(const TomlTable& root, std::uint64_t samples, SweepFile& sweep) {
  if (root.integer("schema") != sweep_schema && root.has("schema")) {
    root.error("schema", fmt::format("must be {}", sweep_schema));
  }
  sweep.case_name = root.text("case");
  sweep.vehicle = root.text("vehicle", "");
  sweep.plant = root.text("plant", "");
  sweep.rate = parse_rate(root);
  const auto design = parse_design(root.text("design"));
  if (design) sweep.design.kind = *design;
  if (!design && root.has("design")) root.error("design", design.error().message);
  sweep.dispersions = parse_dispersions(root, sweep.design.kind);
  sweep.design.dimensions = dimensions_of(sweep.dispersions).size();
  sweep.design.correlation = parse_correlation(root, sweep.dispersions, sweep.design.kind);
  parse_samples(root, samples, sweep);
  sweep.confidence = root.number("confidence", sweep.confidence);
  if (!(sweep.confidence >= 0.5 && sweep.confidence < 1)) {
    root.error("confidence", "must be from 0.5 to below 1");
  }
  sweep.tie = root.number("tie", sweep.tie);
  if (!(sweep.tie >= 0 && sweep.tie < 1)) root.error("tie", "must be from 0 to below 1");
  parse_requirements(root, sweep);
}

Result<void> bind_key(const TomlDocument& document, const std::string& file,
                      const Dispersion& dispersion, DispersedKey& key) {
  const auto wrong = [&](const std::string& what) {
    return fail_at(file, fmt::format("[disperse.{}]: {}", dispersion.name, what), dispersion.line);
  };
  const auto number = document.number(key.path);
  if (!number) return wrong(number.error().message);
  if (!*number && dispersion.as != Dispersion::As::value) {
    return wrong(fmt::format(
        "`{}` has no value in the {}, so it has no factor or offset; use "
        "`as = \"value\"`",
        key.path, key.document == DispersedKey::Document::vehicle ? "vehicle" : "case"));
  }
  key.base = number->value_or(0);
  return {};
}

}  // namespace

double Dispersion::value_for(const DispersedKey& key, double drawn) const {
  switch (as) {
    case As::value:
      return drawn;
    case As::factor:
      return key.base * drawn;
    case As::offset:
      return key.base + drawn;
  }
  return drawn;
}

Result<SweepFile> parse_sweep(std::string_view text, const std::filesystem::path& file,
                              std::uint64_t samples) {
  auto toml = TomlFile::parse(text, file.string());
  if (!toml) return tl::unexpected(toml.error());
  SweepFile sweep;
  sweep.file = file;
  sweep.text = text;
  parse_root(toml->root(), samples, sweep);
  if (auto done = toml->finish(); !done) return tl::unexpected(done.error());
  return sweep;
}

Result<void> bind_sweep(const TomlDocument& the_case, const TomlDocument& vehicle,
                        const std::vector<Metric>& metrics, SweepFile& sweep) {
  const std::string file = sweep.file.string();
  std::map<std::pair<DispersedKey::Document, std::string>, std::string> owners;
  for (Dispersion& dispersion : sweep.dispersions) {
    for (DispersedKey& key : dispersion.keys) {
      const auto [owner, is_new] = owners.try_emplace({key.document, key.path}, dispersion.name);
      if (!is_new) {
        return fail_at(file,
                       fmt::format("[disperse.{}]: `{}` is dispersed by [disperse.{}], too; each "
                                   "number can have one dispersion",
                                   dispersion.name, key.path, owner->second),
                       dispersion.line);
      }
      const bool of_vehicle = key.document == DispersedKey::Document::vehicle;
      const auto bound = bind_key(of_vehicle ? vehicle : the_case, file, dispersion, key);
      if (!bound) return bound;
    }
  }
  std::vector<std::string> known;
  for (const Metric& metric : metrics) known.push_back(metric.name);
  for (const Requirement& requirement : sweep.requirements) {
    if (std::find(known.begin(), known.end(), requirement.metric) != known.end()) continue;
    return fail_at(file,
                   fmt::format("[require.{}]: the case has no metric `{}`{}; it has {}",
                               requirement.name, requirement.metric,
                               suggestion(requirement.metric, known), fmt::join(known, ", ")),
                   requirement.line);
  }
  return {};
}

}  // namespace attest
