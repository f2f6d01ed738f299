#include "harness/verify/recorded_vectors.hpp"

#include <map>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "harness/host/manifest.hpp"
#include "harness/host/recorded_outputs.hpp"
#include "harness/trace/provenance.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/fixed_step.hpp"

namespace attest {
namespace {

bool can_run(const Declarations& port, const Case& the_case,
             const RunConfiguration& configuration) {
  VectorResult ignored;
  return !the_case.flight && the_case.instances == Instances::one &&
         !has_other_steps(port, the_case, configuration.rate.motor_unit, ignored);
}

std::string id_of(const Case& the_case, const RunConfiguration& configuration) {
  return result_for(the_case, configuration).id();
}

// The manifest of the folder, or a new one.
Result<Manifest> manifest_for(const std::filesystem::path& folder, std::optional<Rate> fixed_step,
                              const std::vector<ParameterChange>& parameters) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder / manifest_name, ignored)) {
    Manifest made;
    made.fixed_step = fixed_step;
    made.parameters = parameters;
    return made;
  }
  auto manifest = read_manifest(folder);
  if (!manifest) return manifest;
  const auto another = [&](const std::string& what) {
    return fail_at((folder / manifest_name).string(),
                   fmt::format("is for {}; write these vectors to another folder", what));
  };
  if (manifest->fixed_step != fixed_step) {
    return another("a fixed step of " +
                   (manifest->fixed_step ? manifest->fixed_step->to_string() + " Hz" : "none"));
  }
  if (manifest->parameters != parameters) {
    return another(manifest->parameters.empty() ? "the parameters of the cases"
                                                : text_of(manifest->parameters, ", "));
  }
  return manifest;
}

Result<void> write_vector(const std::filesystem::path& folder, const FileFormat& format,
                          const Case& the_case, const std::string& id, Trace inputs) {
  const std::filesystem::path file = folder / input_file(id, format);
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  if (failed) {
    return fail_at(file.parent_path().string(), "cannot be made: " + failed.message());
  }
  std::map<std::string, std::string> mixers;
  if (the_case.module == Module::mixer) mixers[file.stem().string()] = the_case.mixer;
  if (auto added = add_origin(file.parent_path(), the_case.profile, mixers); !added) return added;
  inputs.present &= ~channels_of(the_case.module, "out/");
  return AtomicFile::open(file).and_then(
      [&](AtomicFile&& out) { return format.write(std::move(out), inputs); });
}

}  // namespace

Result<std::size_t> write_recorded_vectors(const std::filesystem::path& folder,
                                           const FileFormat& format,
                                           const std::vector<SelectedCase>& cases,
                                           std::optional<Rate> fixed_step,
                                           const std::vector<ParameterChange>& parameters) {
  auto manifest = manifest_for(folder, fixed_step, parameters);
  if (!manifest) return tl::unexpected(manifest.error());
  Declarations port;
  port.fixed_step = fixed_step;
  std::size_t count = 0;
  for (const auto& [the_case, configurations] : cases) {
    for (const RunConfiguration& configuration : configurations) {
      if (!can_run(port, the_case, configuration)) continue;
      const Trace inputs = inputs_for(port, the_case, configuration.rate.motor_unit, parameters);
      const std::string id = id_of(the_case, configuration);
      if (auto written = write_vector(folder, format, the_case, id, inputs); !written) {
        return tl::unexpected(written.error());
      }
      manifest->vectors[id] = sha256_of_inputs(inputs);
      ++count;
    }
  }
  if (count == 0) {
    return fail(
        "no vector that can be recorded is selected: the inputs of a flight depend on the port's "
        "outputs (`attest sim` writes a flown trace), some cases need two instances of a port, and "
        "with --fixed-step only regular ticks at that rate are left");
  }
  if (auto written = write_manifest(folder, *manifest); !written) {
    return tl::unexpected(written.error());
  }
  return count;
}

Result<RecordedVectors> check_recorded_vectors(const std::filesystem::path& folder,
                                               const Declarations& port,
                                               const std::vector<SelectedCase>& cases) {
  const auto manifest = read_manifest(folder);
  if (!manifest) return tl::unexpected(manifest.error());
  RecordedVectors found;
  for (const auto& [the_case, configurations] : cases) {
    for (const RunConfiguration& configuration : configurations) {
      if (!can_run(port, the_case, configuration)) continue;
      ++found.selected;
      const std::string id = id_of(the_case, configuration);
      const auto known = manifest->vectors.find(id);
      const auto file = find_output_file(folder, id);
      if (!file) return tl::unexpected(file.error());
      if (known == manifest->vectors.end() || file->empty()) continue;
      if (known->second !=
          sha256_of_inputs(
              inputs_for(port, the_case, configuration.rate.motor_unit, manifest->parameters))) {
        return fail_at((folder / manifest_name).string(),
                       fmt::format("the inputs of {} are not those of this suite: another version "
                                   "of it wrote them. Write them again with `attest vectors`, and "
                                   "record new outputs",
                                   id));
      }
      if (found.answered++ > 0) continue;
      found.first = file->string();
      const auto table = read_as<&FileFormat::read_table>(*file, std::size_t{1});
      if (table) found.ignored = ignored_columns(*table, *manifest, the_case.module);
    }
  }
  if (found.answered > 0) return found;
  return fail_at(folder.string(),
                 fmt::format("has outputs of none of the {} selected vectors", found.selected));
}

}  // namespace attest
