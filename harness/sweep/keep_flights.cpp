#include "harness/sweep/keep_flights.hpp"

#include <system_error>

#include <fmt/format.h>

#include "harness/core/file.hpp"
#include "harness/core/suite_files.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

Result<void> keep(const FlightSampler& sampler, std::uint64_t index, const fs::path& folder) {
  const auto sample = sampler.sample(index);
  if (!sample) return tl::unexpected(sample.error());
  const Case& the_case = sampler.nominal().the_case;
  const std::string& vehicle = sampler.nominal().plant_configuration.vehicle;
  const fs::path cases = folder / "cases" / the_case.profiles.front() / the_case.group;
  std::error_code failed;
  fs::create_directories(cases, failed);
  if (failed) return fail_at(cases.string(), "cannot be made: " + failed.message());
  auto written = write_file(cases / (kept_name(the_case.name, index) + ".toml"), sample->case_text,
                            AtomicFile::Special::replaced);
  if (!written) return written;
  // The kept vehicle has no MJCF file, so its `mjcf_of` names the vehicle that has it.
  const std::string& other = sampler.nominal().vehicle_model->vehicle().mjcf_of;
  const std::string mjcf = other.empty() ? fmt::format("mjcf_of = \"{}\"\n", vehicle) : "";
  return write_file(folder / "models" / (kept_name(vehicle, index) + ".toml"),
                    mjcf + sample->vehicle_text, AtomicFile::Special::replaced);
}

}  // namespace

std::string kept_name(const std::string& name, std::uint64_t sample) {
  return fmt::format("{}_sample_{}", name, sample);
}

Result<void> keep_flights(const FlightSampler& sampler, const std::vector<std::uint64_t>& samples,
                          const fs::path& models, const fs::path& folder) {
  std::error_code failed;
  fs::remove_all(folder, failed);
  if (samples.empty()) return {};
  if (!failed) fs::create_directories(folder, failed);
  if (failed) return fail_at(folder.string(), "cannot be made: " + failed.message());
  if (auto copied = copy_suite_files(models, folder / "models"); !copied) return copied;
  for (const std::uint64_t sample : samples) {
    if (auto kept = keep(sampler, sample, folder); !kept) return kept;
  }
  return {};
}

}  // namespace attest
