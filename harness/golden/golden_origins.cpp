#include "harness/golden/golden_origins.hpp"

#include <fmt/format.h>

#include "harness/core/file.hpp"
#include "harness/core/toml.hpp"

namespace attest {
namespace {

constexpr std::string_view seal_prefix = "# SHA-256 of the lines above: ";

// Appends the SHA-256 of the text as a last line, which is a comment in TOML.
std::string sealed(std::string_view toml) {
  return fmt::format("{}{}{}\n", toml, seal_prefix, sha256(toml));
}

Result<void> check_seal(std::string_view text, const std::filesystem::path& file) {
  const std::size_t seal = text.rfind(seal_prefix);
  if (seal != std::string_view::npos && text == sealed(text.substr(0, seal))) return {};
  return fail_at(file.string(),
                 "was changed after it was blessed (the SHA-256 in its last line is of other "
                 "text); restore it from version control, or remove it and bless its goldens anew");
}

}  // namespace

std::filesystem::path origins_file(const std::filesystem::path& golden_root,
                                   const std::string& profile) {
  return golden_root / profile / "provenance.toml";
}

Result<GoldenOrigins> parse_origins(std::string_view text, const std::filesystem::path& file) {
  if (auto intact = check_seal(text, file); !intact) return tl::unexpected(intact.error());
  const auto toml = TomlFile::parse(text, file.string());
  if (!toml) return tl::unexpected(toml.error());
  const TomlTable root = toml->root();
  GoldenOrigins origins;
  for (const std::string& id : root.keys()) {
    const TomlTable table = root.table(id);
    origins[id] = {table.text("sha256"),      table.text("case_sha256"), table.text("reference"),
                   table.text("compiler"),    table.text("reason"),      table.text_table("models"),
                   table.text_table("inputs")};
  }
  if (const auto done = toml->finish(); !done) return tl::unexpected(done.error());
  return origins;
}

std::string to_text(const GoldenOrigins& origins) {
  TomlWriter toml;
  for (const auto& [id, origin] : origins) {
    toml.set(id, "sha256", origin.sha256);
    toml.set(id, "case_sha256", origin.case_sha256);
    toml.set(id, "reference", origin.reference);
    toml.set(id, "compiler", origin.compiler);
    toml.set(id, "reason", origin.reason);
    for (const auto& [name, hash] : origin.models) toml.set(id, "models", name, hash);
    for (const auto& [rate, hash] : origin.inputs) toml.set(id, "inputs", rate, hash);
  }
  return sealed(toml.to_string());
}

}  // namespace attest
