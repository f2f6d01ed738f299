#include "harness/golden/golden.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/suite_files.hpp"
#include "harness/golden/shared_golden.hpp"
#include "harness/host/manifest.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

// `goldens`: the folder `golden` of the suite.
std::string how_to_bless(const std::string& case_id, const fs::path& goldens) {
  return fmt::format("`attest --suite '{}' bless --filter '{}' --reason \"...\"` makes it",
                     (goldens.has_parent_path() ? goldens.parent_path() : ".").string(), case_id);
}

// The text of a golden: in the file at its place, or in the new one that a killed bless left next
// to it. Errors: none of them has the hash of `origin`; the file cannot be read.
Result<std::string> blessed_text(const fs::path& file, const std::string& profile,
                                 const GoldenOrigin& origin) {
  // The place is read again at the end, because a bless at the same time moves the new golden
  // there.
  Result<std::string> text;
  for (const fs::path& place : {file, new_golden_file(file), file}) {
    text = read_suite_file(place);
    if (!text) continue;
    std::string golden = golden_of_profile(*text, profile);
    if (sha256(golden) == origin.sha256) return golden;
  }
  const bool exists = is_suite_file(file);
  if (exists && !text) return text;
  return fail_at(
      file.string(),
      fmt::format("{}; restore it from version control, or bless it anew",
                  exists ? fmt::format("is not the file that was blessed (the SHA-256 of "
                                       "its traces of {} is another than in the "
                                       "provenance.toml of this profile)",
                                       profile)
                         : "is missing"));
}

}  // namespace

std::string key_of(const Case& the_case) {
  const bool has_folder = !the_case.profiles.empty();
  const std::string& folder = has_folder ? the_case.profiles.front() : the_case.profile;
  return fmt::format("{}/{}/{}", folder, the_case.group, the_case.name);
}

std::string id_of(const std::string& profile, const std::string& key) {
  return profile + key.substr(std::min(key.find('/'), key.size()));
}

std::map<std::string, std::string> hashes_of(const Vehicle& vehicle) {
  const auto files = vehicle.files();
  return {{files[0].filename().string(), vehicle.sha256},
          {files[1].filename().string(), vehicle.mjcf_sha256}};
}

fs::path golden_file(const fs::path& golden_root, const std::string& key) {
  return golden_root / (key + ".csv");
}

fs::path new_golden_file(const fs::path& golden) { return fs::path(golden).concat(".new"); }

bool keeps_every_tick(std::size_t ticks) {
  constexpr std::size_t most = 1000;
  return ticks <= most;
}

bool is_long(const Case& the_case) {
  const std::int64_t ticks = tick_count(the_case.duration, the_case.rates.back().motor_unit);
  return !the_case.flight && !keeps_every_tick(static_cast<std::size_t>(ticks));
}

Golden::Golden(fs::path file, GoldenOrigin origin, std::vector<GoldenTrace> traces)
    : file_(std::move(file)), origin_(std::move(origin)), traces_(std::move(traces)) {
  for (std::size_t i = 0; i < traces_.size(); ++i) {
    traces_[i].outputs.source = file_.string();
    for (const std::string& label : traces_[i].configurations) trace_of_[label] = i;
  }
}

Result<const GoldenTrace*> Golden::trace(const RunConfiguration& configuration) const {
  const auto found = trace_of_.find(configuration.label());
  if (found != trace_of_.end()) return &traces_[found->second];
  return fail_at(file_.string(),
                 fmt::format("no trace for {}; `attest bless` makes it", configuration.label()));
}

Result<void> Golden::check_vehicle(const Vehicle& vehicle) const {
  for (const auto& [name, loaded] : hashes_of(vehicle)) {
    const auto blessed = origin_.models.find(name);
    if (blessed != origin_.models.end() && blessed->second == loaded) continue;
    const char* const why = blessed == origin_.models.end() ? "is new" : "has changed";
    return fail_at(file_.string(),
                   fmt::format("the golden is stale: {} {} since it was blessed; `attest bless` "
                               "makes it anew",
                               (vehicle.file.parent_path() / name).string(), why));
  }
  return {};
}

Result<void> Golden::check_inputs(const Trace& inputs,
                                  const RunConfiguration& configuration) const {
  const auto blessed = origin_.inputs.find(configuration.label());
  if (blessed != origin_.inputs.end() && blessed->second == sha256_of_inputs(inputs)) return {};
  return fail_at(file_.string(),
                 fmt::format("at {}, the case has other inputs than those for which the outputs "
                             "were recorded; bless it anew",
                             configuration.label()));
}

Result<Golden> Goldens::open(const Case& the_case) const {
  const auto& origins = origins_of(the_case.profile);
  if (!origins) return tl::unexpected(origins.error());
  const std::string key = key_of(the_case);
  const fs::path file = golden_file(root_, key);
  const auto origin = origins->find(key);
  if (origin == origins->end()) {
    return fail_at(file.string(), fmt::format("no golden for {}; {}", the_case.id(),
                                              how_to_bless(the_case.id(), root_)));
  }
  if (origin->second.case_sha256 != the_case.sha256) {
    return fail_at(file.string(),
                   fmt::format("the golden is stale: {} has changed since it was blessed; {} anew",
                               the_case.file.string(), how_to_bless(the_case.id(), root_)));
  }
  const auto text = blessed_text(file, the_case.profile, origin->second);
  if (!text) return tl::unexpected(text.error());
  auto traces = parse_golden(*text, file, the_case.module);
  // Without the line, which is not that of the file: other profiles may have lines before it.
  if (!traces) return fail_at(file.string(), traces.error().message);
  return Golden(file, origin->second, *std::move(traces));
}

const Result<GoldenOrigins>& Goldens::origins_of(const std::string& profile) const {
  const auto known = origins_.find(profile);
  if (known != origins_.end()) return known->second;
  return origins_.emplace(profile, read_origins(profile)).first->second;
}

bool Goldens::has(const Case& the_case) const {
  const auto& origins = origins_of(the_case.profile);
  const std::string key = key_of(the_case);
  return !origins || origins->contains(key) || is_suite_file(golden_file(root_, key));
}

std::string Goldens::reference() const {
  std::set<std::string> ports;
  for (const fs::path& folder : suite_folders_in(root_).value_or(std::vector<fs::path>())) {
    const auto& origins = origins_of(folder.filename().string());
    if (!origins) continue;
    for (const auto& [key, origin] : *origins) {
      if (!origin.inputs.empty()) ports.insert(origin.reference);
    }
  }
  return fmt::format("{}", fmt::join(ports, "; "));
}

std::vector<std::string> Goldens::without_case(const std::string& profile,
                                               const std::set<std::string>& keys_of_cases) const {
  std::vector<std::string> keys;
  const auto& origins = origins_of(profile);
  if (!origins) return keys;
  for (const auto& [key, origin] : *origins) {
    if (!keys_of_cases.contains(key)) keys.push_back(key);
  }
  return keys;
}

Result<GoldenOrigins> Goldens::read_origins(const std::string& profile) const {
  const fs::path file = origins_file(root_, profile);
  if (!is_suite_file(file)) return GoldenOrigins{};
  const auto text = read_suite_file(file);
  if (!text) return tl::unexpected(text.error());
  if (suite_) {
    if (auto same = suite_->check(file, sha256(*text)); !same) return tl::unexpected(same.error());
  }
  return parse_origins(*text, file);
}

}  // namespace attest
