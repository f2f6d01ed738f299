#include "harness/sweep/flight_sampler.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "harness/casefile/parse.hpp"
#include "harness/core/file.hpp"
#include "harness/sweep/parse_dispersions.hpp"

namespace attest {
namespace {

using Document = DispersedKey::Document;

// Drawn seeds are below this, so that every reader of TOML accepts them as integers.
constexpr std::uint64_t most_seed = 1ull << 31;
// The lowest and the highest number of a point (DesignPoints::at).
constexpr double lowest_probability = 0x1p-53, highest_probability = 1 - 0x1p-53;

bool is_dispersed(const SweepFile& sweep, Document document) {
  const auto of_document = [&](const DispersedKey& key) { return key.document == document; };
  return std::any_of(sweep.dispersions.begin(), sweep.dispersions.end(), [&](const Dispersion& d) {
    return std::any_of(d.keys.begin(), d.keys.end(), of_document);
  });
}

TomlDocument::Replacements replacements_in(Document document, const SweepFile& sweep,
                                           const std::vector<double>& drawn) {
  TomlDocument::Replacements replacements;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const Dispersion& dispersion = sweep.dispersions[i];
    for (const DispersedKey& key : dispersion.keys) {
      if (key.document != document) continue;
      replacements.emplace_back(key.path, dispersion.value_for(key, drawn[i]));
    }
  }
  return replacements;
}

std::string line_of(const std::string& text, int line) {
  std::size_t begin = 0;
  for (int i = 1; i < line && begin != std::string::npos; ++i) begin = text.find('\n', begin + 1);
  if (begin == std::string::npos) return "";
  if (line > 1) ++begin;
  return text.substr(begin, text.find('\n', begin) - begin);
}

// "inertia_kg_m2" of "inertia_kg_m2[0]", "to" of "flight.wind_m_s.north.to".
std::string last_name(const std::string& path) {
  const std::string last = path.substr(path.rfind('.') + 1);
  return last.substr(0, last.find('['));
}

std::string identity_of(const SweepFile& sweep, const NominalFlight& nominal) {
  std::string all =
      fmt::format("attest sweep 1\n{}\n{}\n{}\n{}\n", sha256(sweep.text), sha256(nominal.case_text),
                  sha256(nominal.vehicle_text), nominal.vehicle_model->vehicle().mjcf_sha256);
  all += fmt::format("{} {} {} {}\n", nominal.the_case.id(), nominal.plant_configuration.vehicle,
                     name_of(nominal.plant_configuration.plant), sweep.design.samples);
  return sha256(all);
}

using NamedNumber = std::pair<const char*, double>;

std::vector<NamedNumber> ends_of(const Distribution& distribution) {
  if (distribution.kind != Distribution::Kind::choice) {
    return {{"lowest", quantile(distribution, lowest_probability)},
            {"highest", quantile(distribution, highest_probability)}};
  }
  const auto [lowest, highest] =
      std::minmax_element(distribution.values.begin(), distribution.values.end());
  return {{"lowest", *lowest}, {"highest", *highest}};
}

}  // namespace

FlightSampler::FlightSampler(SweepFile sweep, NominalFlight nominal, TomlDocument case_document,
                             TomlDocument vehicle_document)
    : sweep_(std::move(sweep)),
      nominal_(std::move(nominal)),
      case_document_(std::move(case_document)),
      vehicle_document_(std::move(vehicle_document)),
      sha256_(identity_of(sweep_, nominal_)),
      stream_(sha256_),
      points_(std::make_shared<const DesignPoints>(sweep_.design, stream_)) {}

Result<FlightSampler> FlightSampler::make(SweepFile sweep, NominalFlight nominal) {
  auto case_document = TomlDocument::parse(nominal.case_text, nominal.the_case.file.string());
  if (!case_document) return tl::unexpected(case_document.error());
  const Vehicle& vehicle = nominal.vehicle_model->vehicle();
  auto vehicle_document = TomlDocument::parse(nominal.vehicle_text, vehicle.file.string());
  if (!vehicle_document) return tl::unexpected(vehicle_document.error());
  const auto& metrics = nominal.the_case.flight->metrics;
  const auto bound = bind_sweep(*case_document, *vehicle_document, metrics, sweep);
  if (!bound) return tl::unexpected(bound.error());
  FlightSampler sampler(std::move(sweep), std::move(nominal), *std::move(case_document),
                        *std::move(vehicle_document));
  if (auto checked = sampler.check_ends(); !checked) return tl::unexpected(checked.error());
  return sampler;
}

std::vector<double> FlightSampler::drawn(std::uint64_t index) const {
  const std::vector<double> point = points_->at(index);
  std::vector<double> numbers;
  std::size_t dimension = 0;
  for (std::size_t i = 0; i < sweep_.dispersions.size(); ++i) {
    const Distribution& of = sweep_.dispersions[i].distribution;
    if (of.kind == Distribution::Kind::seed) {
      const std::uint64_t bits =
          stream_.bits(SampleStream::Purpose::seed, sweep_.design.with_seeds(index), i);
      numbers.push_back(static_cast<double>(bits % most_seed));
    } else {
      numbers.push_back(quantile(of, point[dimension++]));
    }
  }
  return numbers;
}

Error FlightSampler::refused(const std::string& what, Document document, const std::string& text,
                             const std::vector<double>& drawn, const Error& error) const {
  const char* const prefix = document == Document::vehicle ? "vehicle" : "case";
  const std::string quoted = line_of(text, error.line);
  std::string names;
  int line = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const Dispersion& dispersion = sweep_.dispersions[i];
    for (const DispersedKey& key : dispersion.keys) {
      if (key.document != document) continue;
      const bool is_here = quoted.find(last_name(key.path)) != std::string::npos;
      if (line != 0 && !is_here) continue;
      if (line == 0 || is_here) line = dispersion.line;
      if (!is_here) continue;
      names +=
          fmt::format("{}.{} = {:.6g}, ", prefix, key.path, dispersion.value_for(key, drawn[i]));
    }
  }
  const std::string first = error.message.substr(0, error.message.find('\n'));
  return {fmt::format("{}: {}the {} refuses `{}`: {}", what, names, prefix, quoted, first),
          sweep_.file.string(), line};
}

Result<void> FlightSampler::apply(const std::string& what, SampledFlight& flight) const {
  const auto text = [&](Document document, const TomlDocument& from) {
    return from.with(replacements_in(document, sweep_, flight.drawn));
  };
  flight.the_case = nominal_.the_case;
  flight.case_text = nominal_.case_text;
  if (is_dispersed(sweep_, Document::the_case)) {
    auto changed = text(Document::the_case, case_document_);
    if (!changed) return tl::unexpected(changed.error());
    flight.case_text = *std::move(changed);
    auto parsed = parse_case_text(flight.case_text, nominal_.the_case.file);
    if (!parsed) {
      return tl::unexpected(
          refused(what, Document::the_case, flight.case_text, flight.drawn, parsed.error()));
    }
    flight.the_case = parsed->in_profile(nominal_.the_case.profile);
  }
  flight.vehicle_model = nominal_.vehicle_model;
  flight.vehicle_text = nominal_.vehicle_text;
  if (!is_dispersed(sweep_, Document::vehicle)) return {};
  auto changed = text(Document::vehicle, vehicle_document_);
  if (!changed) return tl::unexpected(changed.error());
  flight.vehicle_text = *std::move(changed);
  auto vehicle = parse_vehicle(flight.vehicle_text, nominal_.vehicle_model->vehicle().file);
  if (!vehicle) {
    return tl::unexpected(
        refused(what, Document::vehicle, flight.vehicle_text, flight.drawn, vehicle.error()));
  }
  auto model = nominal_.vehicle_model->with_numbers_of(*std::move(vehicle));
  if (!model) return tl::unexpected(model.error());
  flight.vehicle_model = *std::move(model);
  return {};
}

Result<void> FlightSampler::check_ends() const {
  SampledFlight flight;
  for (const Dispersion& dispersion : sweep_.dispersions) {
    const bool is_seed = dispersion.distribution.kind == Distribution::Kind::seed;
    flight.drawn.push_back(is_seed ? 1 : quantile(dispersion.distribution, 0.5));
  }
  const std::vector<double> middle = flight.drawn;
  for (const std::size_t i : dimensions_of(sweep_.dispersions)) {
    const Dispersion& dispersion = sweep_.dispersions[i];
    for (const auto& [which, number] : ends_of(dispersion.distribution)) {
      flight.drawn = middle;
      flight.drawn[i] = number;
      const std::string what =
          fmt::format("[disperse.{}] at its {} number, {:.6g}", dispersion.name, which, number);
      if (auto applied = apply(what, flight); !applied) {
        Error error = applied.error();
        error.line = dispersion.line;
        error.message += "; use a bounded distribution, such as truncated_normal, or other bounds";
        return tl::unexpected(std::move(error));
      }
    }
  }
  return {};
}

Result<SampledFlight> FlightSampler::sample(std::uint64_t index) const {
  SampledFlight flight;
  flight.index = index;
  flight.drawn = drawn(index);
  if (auto applied = apply(fmt::format("sample {}", index), flight); !applied) {
    return tl::unexpected(applied.error());
  }
  return flight;
}

}  // namespace attest
