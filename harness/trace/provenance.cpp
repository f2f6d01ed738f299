#include "harness/trace/provenance.hpp"

#include "harness/core/file.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/core/toml.hpp"

namespace attest {
Result<Provenance> read_provenance(const std::filesystem::path& file) {
  const auto text = read_suite_file(file);
  if (!text) return tl::unexpected(text.error());
  const auto toml = TomlFile::parse(*text, file.string());
  if (!toml) return tl::unexpected(toml.error());
  const TomlTable root = toml->root();
  Provenance provenance;
  provenance.profile = root.text("profile", "");
  provenance.reference = root.text("reference", "");
  provenance.compiler = root.text("compiler", "");
  provenance.reason = root.text("reason", "");
  if (root.has("covers")) provenance.covers = root.texts("covers");
  provenance.mixers = root.text_table("mixers");
  provenance.sha256 = root.text_table("sha256");
  if (const auto done = toml->finish(); !done) return tl::unexpected(done.error());
  return provenance;
}

Result<Provenance> provenance_in(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / provenance_name;
  return is_suite_file(file) ? read_provenance(file) : Provenance{};
}

std::string to_toml(const Provenance& provenance) {
  TomlWriter toml;
  const auto set = [&](std::string_view key, const std::string& value) {
    if (!value.empty()) toml.set("", key, value);
  };
  set("profile", provenance.profile);
  set("reference", provenance.reference);
  set("compiler", provenance.compiler);
  set("reason", provenance.reason);
  for (const auto& [stem, geometry] : provenance.mixers) toml.set("mixers", stem, geometry);
  for (const auto& [name, hash] : provenance.sha256) toml.set("sha256", name, hash);
  return toml.to_string();
}

Result<void> add_origin(const std::filesystem::path& folder, const std::string& profile,
                        const std::map<std::string, std::string>& mixers) {
  auto provenance = provenance_in(folder);
  if (!provenance) return tl::unexpected(provenance.error());
  provenance->profile = profile;
  for (const auto& [stem, mixer] : mixers) provenance->mixers[stem] = mixer;
  return write_file(folder / provenance_name, to_toml(*provenance), AtomicFile::Special::replaced);
}

}  // namespace attest
