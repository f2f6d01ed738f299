#include "harness/run/recorded.hpp"

#include <fmt/format.h>

#include "controller/actuation/mixer.hpp"
#include "harness/trace/csv.hpp"
#include "harness/trace/mixer_csv.hpp"
#include "harness/trace/provenance.hpp"

namespace attest {
namespace {

constexpr const char* default_profile = "px4-v1.5.5";

std::string mixer_of(const std::filesystem::path& file, const Provenance& provenance) {
  const std::string stem = file.stem().string();
  const auto found = provenance.mixers.find(stem);
  if (found != provenance.mixers.end()) return found->second;
  const std::string unscaled = fmt::format("R: {} 10000 10000 10000 0", stem);
  return actuation::parse_mixer(unscaled) ? unscaled : "";
}

Result<void> check_mixer(const Trace& trace, const std::string& definition) {
  if (definition.empty()) {
    return fail_at(trace.source, "which mixer made it? pass --mixer \"R: 4x 10000 10000 10000 0\"");
  }
  const auto mixer = actuation::parse_mixer(definition);
  if (!mixer)
    return fail_at(trace.source, fmt::format("mixer `{}`: {}", definition, mixer.error()));
  const ChannelSet outputs = channels_of(Part::mixer, "out/actuator_outputs.") & trace.present;
  if (outputs.count() == mixer->rotors.size()) return {};
  return fail_at(trace.source, fmt::format("has {} rotors, mixer `{}` has {}", outputs.count(),
                                           definition, mixer->rotors.size()));
}

}  // namespace

Result<Recorded> read_recorded(const std::filesystem::path& file, const std::string& profile,
                               const std::string& mixer) {
  auto trace = looks_like_mixer_csv(file) ? read_mixer_csv(file)
                                          : read_csv(file, CsvNeed::inputs_and_outputs);
  if (!trace) return tl::unexpected(trace.error());
  const Provenance provenance =
      read_provenance(file.parent_path() / provenance_name).value_or(Provenance{});
  Recorded recorded{std::move(*trace), {profile, Part::mc_att_control, ""}};
  Subject& subject = recorded.subject;
  subject.part = part_of(recorded.trace.present);
  if (subject.profile.empty()) subject.profile = provenance.profile;
  if (subject.profile.empty()) subject.profile = default_profile;
  if (subject.part != Part::mixer) return recorded;
  subject.mixer = mixer.empty() ? mixer_of(file, provenance) : mixer;
  if (auto checked = check_mixer(recorded.trace, subject.mixer); !checked) {
    return tl::unexpected(checked.error());
  }
  return recorded;
}

}  // namespace attest
