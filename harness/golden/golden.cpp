#include "harness/golden/golden.hpp"

#include <array>
#include <cstdio>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>

#include "harness/core/file.hpp"
#include "harness/core/version.hpp"
#include "harness/trace/csv.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

std::string file_name(const RunConfiguration& configuration) {
  return configuration.label() + ".csv";
}

std::string how_to_bless(const Case& the_case) {
  return fmt::format("`attest bless --filter '{}' --reason \"...\"` makes it", the_case.id());
}

// Writes those of `columns` that the trace has. Keyframes have no parameters and no in/updated
// bits; `columns` has them if the same case keeps every tick at slower rates.
Result<std::string> write_trace(const fs::path& path, const Trace& trace, CsvColumns columns) {
  if (trace.parameters.empty()) columns.parameters.clear();
  columns.channels &= trace.present;
  if (auto written = write_csv(path, trace, columns); !written) {
    return tl::unexpected(written.error());
  }
  return sha256_of_file(path);
}

std::vector<Trace> samples_of(const std::vector<GoldenTrace>& traces) {
  std::vector<Trace> samples;
  for (const GoldenTrace& trace : traces) samples.push_back(trace.trace);
  return samples;
}

// Notes the folder of the base, and the SHA-256 of its files as they are now.
Result<void> note_base(const GoldenBase& base, const Case& the_case, Provenance& provenance) {
  const fs::path above = fs::path("..") / ".." / "..";
  provenance.base = (above / the_case.profiles.front() / the_case.group / the_case.name).string();
  for (const auto& [name, hash] : provenance.sha256) {
    auto of_base = sha256_of_file(base.folder / name);
    if (!of_base) return tl::unexpected(of_base.error());
    provenance.base_sha256[name] = *of_base;
  }
  return {};
}

// Columns that stay the same are stored once, in the provenance.
Result<void> write_folder(const fs::path& folder, const Case& the_case,
                          const std::vector<GoldenTrace>& traces,
                          const std::vector<fs::path>& vehicle_files, const Making& making,
                          const GoldenBase* base) {
  const Division division =
      base ? divide(samples_of(traces), samples_of(base->traces)) : divide(samples_of(traces));
  Provenance provenance;
  provenance.profile = the_case.profile;
  provenance.case_id = the_case.id();
  provenance.case_sha256 = the_case.sha256;
  provenance.reference = making.reference;
  provenance.compiler = compiler();
  provenance.reason = making.reason;
  provenance.constants = division.constants;
  for (const auto& [configuration, trace, is_whole, horizon_s, metrics] : traces) {
    const std::string name = file_name(configuration);
    auto hash = write_trace(folder / name, trace, division.columns);
    if (!hash) return tl::unexpected(hash.error());
    provenance.sha256[name] = *hash;
    if (!the_case.mixer.empty()) provenance.mixers[configuration.label()] = the_case.mixer;
    if (horizon_s) provenance.horizon_s[configuration.label()] = *horizon_s;
    for (const auto& [metric, value] : metrics) {
      provenance.metrics[metric_key(configuration, metric)] = value;
    }
  }
  for (const fs::path& file : vehicle_files) {
    auto hash = sha256_of_file(file);
    if (!hash) return tl::unexpected(hash.error());
    provenance.models[file.filename().string()] = *hash;
  }
  if (base) {
    if (auto noted = note_base(*base, the_case, provenance); !noted) return noted;
  }
  return write_file(folder / provenance_name, sealed(to_toml(provenance)));
}

}  // namespace

std::string metric_key(const RunConfiguration& configuration, const std::string& metric) {
  return fmt::format("{}.{}", configuration.label(), metric);
}

bool keeps_every_tick(std::size_t ticks) {
  constexpr std::size_t most = 1000;
  return ticks <= most;
}

bool is_long(const Case& the_case) {
  const std::int64_t ticks = tick_count(the_case.duration, the_case.rates.back().unit);
  return !the_case.flight && !keeps_every_tick(static_cast<std::size_t>(ticks));
}

fs::path golden_folder(const fs::path& golden_root, const Case& the_case) {
  return golden_root / the_case.profile / the_case.group / the_case.name;
}

namespace {

// The text of a provenance. Errors: it has another hash in `suite`.
Result<std::string> provenance_text(const fs::path& file, const FileHashes* suite) {
  auto text = read_file(file);
  if (!text || suite == nullptr) return text;
  if (auto same = suite->check(file, sha256(*text)); !same) {
    return tl::unexpected(same.error());
  }
  return text;
}

// The provenance in the folder `base` of another golden.
Result<Provenance> provenance_of_base(const fs::path& base, const FileHashes* suite) {
  const fs::path file = base / provenance_name;
  const auto text = provenance_text(file, suite);
  if (!text) return tl::unexpected(text.error());
  if (auto intact = check_seal(*text, file); !intact) return tl::unexpected(intact.error());
  return parse_provenance(*text, file);
}

}  // namespace

Result<Golden> Golden::open(const fs::path& golden_root, const Case& the_case,
                            const FileHashes* suite) {
  const fs::path folder = golden_folder(golden_root, the_case);
  if (!fs::exists(folder / provenance_name)) {
    return fail_at(folder.string(),
                   fmt::format("no golden for {}; {}", the_case.id(), how_to_bless(the_case)));
  }
  const auto text = provenance_text(folder / provenance_name, suite);
  if (!text) return tl::unexpected(text.error());
  auto provenance = parse_provenance(*text, folder / provenance_name);
  if (!provenance) return tl::unexpected(provenance.error());
  if (provenance->case_sha256 != the_case.sha256) {
    return fail_at((folder / provenance_name).string(),
                   fmt::format("the golden is stale: {} has changed since it was blessed; {} anew",
                               the_case.file.string(), how_to_bless(the_case)));
  }
  if (auto intact = check_seal(*text, folder / provenance_name); !intact) {
    return tl::unexpected(intact.error());
  }
  Golden golden(folder);
  golden.provenance_ = std::move(*provenance);
  if (golden.provenance_.base.empty()) return golden;
  auto of_base = provenance_of_base((folder / golden.provenance_.base).lexically_normal(), suite);
  if (!of_base) return tl::unexpected(of_base.error());
  golden.of_base_ = std::move(*of_base);
  return golden;
}

Result<Trace> Golden::read(const RunConfiguration& configuration) const {
  const std::string name = file_name(configuration);
  const fs::path path = folder_ / name;
  const auto blessed = provenance_.sha256.find(name);
  if (blessed == provenance_.sha256.end()) {
    return fail_at((folder_ / provenance_name).string(),
                   fmt::format("no golden {}; `attest bless` makes it", name));
  }
  const auto text = blessed_text(path, blessed->second);
  if (!text) return tl::unexpected(text.error());
  const TraceText own{path, *text, provenance_};
  // The case makes all inputs, so the file may lack some.
  if (!of_base_) return parse_csv(own, nullptr, TraceNeed::outputs);
  const auto of_base = provenance_.base_sha256.find(name);
  const bool is_known = of_base != provenance_.base_sha256.end();
  const fs::path base = (folder_ / provenance_.base / name).lexically_normal();
  const auto base_text = blessed_text(base, is_known ? of_base->second : "");
  if (!base_text) return tl::unexpected(base_text.error());
  const TraceText below{base, *base_text, *of_base_};
  return parse_csv(own, &below, TraceNeed::outputs);
}

// The text of a trace. Errors: its hash is not `blessed`.
Result<std::string> Golden::blessed_text(const fs::path& path, const std::string& blessed) const {
  auto text = read_file(path);
  if (!text || sha256(*text) == blessed) return text;
  return fail_at(
      path.string(),
      fmt::format("is not the file that was blessed (its SHA-256 is another than in {}); "
                  "restore it from version control, or bless it anew",
                  (folder_ / provenance_name).string()));
}

Result<ReferenceFlight> Golden::read_flight(const RunConfiguration& configuration,
                                            const Vehicle& vehicle) const {
  const std::array<const std::string*, 2> loaded{&vehicle.sha256, &vehicle.mjcf_sha256};
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    const fs::path file = vehicle.files()[i];
    const auto blessed = provenance_.models.find(file.filename().string());
    if (blessed != provenance_.models.end() && blessed->second == *loaded[i]) continue;
    const char* const why = blessed == provenance_.models.end() ? "is new" : "has changed";
    return fail_at((folder_ / provenance_name).string(),
                   fmt::format("the golden is stale: {} {} since it was blessed; `attest "
                               "bless --filter '{}' --reason \"...\"` makes it anew",
                               file.string(), why, provenance_.case_id));
  }
  auto rows = read(configuration);
  if (!rows) return tl::unexpected(rows.error());
  const auto horizon = provenance_.horizon_s.find(configuration.label());
  if (horizon == provenance_.horizon_s.end()) {
    return fail_at((folder_ / provenance_name).string(),
                   fmt::format("no horizon_s for {}; bless it anew", configuration.label()));
  }
  ReferenceFlight flight{std::move(*rows), horizon->second, {}};
  const std::string prefix = metric_key(configuration, "");
  for (const auto& [key, value] : provenance_.metrics) {
    if (key.starts_with(prefix)) flight.metrics[key.substr(prefix.size())] = value;
  }
  return flight;
}

NewGolden::NewGolden(fs::path folder, fs::path written)
    : folder_(std::move(folder)), written_(std::move(written)) {}

NewGolden::NewGolden(NewGolden&& other) noexcept
    : folder_(std::move(other.folder_)), written_(std::exchange(other.written_, {})) {}

NewGolden::~NewGolden() {
  if (written_.empty()) return;
  std::error_code ignored;
  fs::remove_all(written_, ignored);
  // Removes the folders of the group and the profile, too, if they are empty now; remove() keeps a
  // folder that is not empty.
  fs::remove(written_.parent_path(), ignored);
  fs::remove(written_.parent_path().parent_path(), ignored);
}

std::string Making::own_reference() { return fmt::format("attest {}", version); }

Result<NewGolden> NewGolden::write(const fs::path& golden_root, const Case& the_case,
                                   const std::vector<GoldenTrace>& traces,
                                   const std::vector<fs::path>& vehicle_files, const Making& making,
                                   const GoldenBase* base) {
  const fs::path folder = golden_folder(golden_root, the_case);
  NewGolden golden(folder, fs::path(folder).concat(".new"));
  std::error_code error;
  fs::remove_all(golden.written_, error);  // left by a run that was killed
  fs::create_directories(golden.written_, error);
  if (error) {
    return fail_at(golden.written_.string(), fmt::format("cannot be made: {}", error.message()));
  }
  auto done = write_folder(golden.written_, the_case, traces, vehicle_files, making, base);
  if (!done) return tl::unexpected(done.error());
  return golden;
}

Result<void> NewGolden::put_in_place() {
  const bool exchanged =
      ::renameat2(AT_FDCWD, written_.c_str(), AT_FDCWD, folder_.c_str(), RENAME_EXCHANGE) == 0;
  if (exchanged) return {};  // the old one is in `written_` now, and the destructor removes it
  // There is no old golden, or the file system cannot exchange. An old golden is moved away first.
  const fs::path old = fs::path(folder_).concat(".old");
  std::error_code error;
  if (fs::exists(folder_)) fs::rename(folder_, old, error);
  if (!error) fs::rename(written_, folder_, error);
  if (error) {
    std::error_code ignored;
    if (!fs::exists(folder_, ignored)) fs::rename(old, folder_, ignored);
    return fail_at(folder_.string(), fmt::format("cannot be replaced: {}", error.message()));
  }
  written_.clear();
  fs::remove_all(old, error);
  return {};
}

}  // namespace attest
