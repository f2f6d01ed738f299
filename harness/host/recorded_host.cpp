#include "harness/host/recorded_host.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "harness/host/manifest.hpp"
#include "harness/host/recorded_outputs.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

PortFault unanswered(std::string why) { return {PortFault::Kind::unanswered, 0, std::move(why)}; }

PortFault unusable(const Error& error) { return {PortFault::Kind::protocol, 0, error.to_string()}; }

std::string profile_of(const std::string& vector_id) {
  return vector_id.substr(0, vector_id.find('/'));
}

// The modules that a port has which answered the vector `id`. A port of one version of the law is
// not thereby one of the laws alone, which all versions have.
ModuleSet modules_of(const std::string& profile, const std::string& id) {
  const std::size_t begin = profile.size() + 1;
  const auto alone = module_named(id.substr(begin, id.find('/', begin) - begin));
  if (alone && info_of(*alone).is_law()) return only(*alone);
  const ProfileInfo* const known = find_profile(profile);
  if (!known) return only(Module::mc_att_control);
  ModuleSet modules = known->modules;
  for (const ModuleInfo& info : attest::modules()) {
    if (info.is_law()) modules.reset(static_cast<std::size_t>(info.module));
  }
  return modules;
}

Declarations said_by(const Manifest& manifest) {
  Declarations says;
  says.name = manifest.port_name;
  says.version = manifest.port_version;
  says.unsupported_groups = manifest.unsupported_groups;
  says.lacks = manifest.lacks;
  says.fraction_bits = manifest.fraction_bits;
  says.fixed_step = manifest.fixed_step;
  says.is_recorded = true;
  for (const auto& [id, hash] : manifest.vectors) {
    const std::string profile = profile_of(id);
    if (says.profiles.empty() || says.profiles.back() != profile) says.profiles.push_back(profile);
    says.modules |= modules_of(profile, id);
  }
  return says;
}

class RecordedHost final : public PortHost {
 public:
  RecordedHost(std::filesystem::path folder, Manifest manifest)
      : folder_(std::move(folder)),
        manifest_(std::move(manifest)),
        declarations_(said_by(manifest_)) {}

  const Declarations& declarations() const override { return declarations_; }

  std::optional<PortFault> drive(const ModuleUnderTest& subject, Trace& trace) override {
    if (subject.instances != Instances::one) {
      return unanswered("a recorded port has one instance; this case needs two");
    }
    const auto file = find_output_file(folder_, trace.source);
    if (!file) return unusable(file.error());
    if (file->empty() || !manifest_.vectors.contains(trace.source)) {
      return unanswered("not answered: the folder has no outputs of this vector");
    }
    // One row more than there are ticks shows that the file has too many.
    const auto table = read_as<&FileFormat::read_table>(*file, trace.samples.size() + 1);
    if (!table) return unusable(table.error());
    auto set = set_recorded_outputs(*table, manifest_, file->string(), trace);
    if (!set) return unusable(set.error());
    return std::nullopt;
  }

  Result<Flown> fly(const FlightPlan&) override {
    Flown none;
    none.fault = unanswered("a recorded port does not fly");
    return none;
  }

  Result<LiveFlight> fly_live(const LivePlan&, const LiveWatch&) override {
    LiveFlight none;
    none.fault = unanswered("a recorded port does not fly");
    return none;
  }

  Result<StepTimes> time_steps(const ModuleUnderTest&, const Trace&, bool) override {
    StepTimes none;
    none.fault = unanswered("a recorded port cannot be timed");
    return none;
  }

  bool supports(const std::string& profile) override {
    return std::find(declarations_.profiles.begin(), declarations_.profiles.end(), profile) !=
           declarations_.profiles.end();
  }

 private:
  std::filesystem::path folder_;
  Manifest manifest_;
  Declarations declarations_;
};

bool has_outputs(const std::filesystem::path& folder, const Manifest& manifest) {
  return std::any_of(manifest.vectors.begin(), manifest.vectors.end(), [&](const auto& vector) {
    const auto file = find_output_file(folder, vector.first);
    return !file || !file->empty();  // several files, an error here, are outputs too
  });
}

}  // namespace

Result<std::unique_ptr<PortHost>> open_recorded_host(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(folder / manifest_name, ignored)) {
    return fail_at(
        folder.string(),
        fmt::format("has no {}; `attest vectors DIR` writes it, with the inputs to answer",
                    manifest_name));
  }
  auto manifest = read_manifest(folder);
  if (!manifest) return tl::unexpected(manifest.error());
  if (manifest->vectors.empty()) {
    return fail_at((folder / manifest_name).string(), "has no vectors");
  }
  if (!has_outputs(folder, *manifest)) {
    return fail_at(folder.string(),
                   fmt::format("has no outputs; write those of {} to {}, for example",
                               input_file(manifest->vectors.begin()->first, file_formats().front())
                                   .replace_extension()
                                   .string(),
                               wanted_output_file(folder, manifest->vectors.begin()->first)));
  }
  return std::make_unique<RecordedHost>(folder, *std::move(manifest));
}

}  // namespace attest
