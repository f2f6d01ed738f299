#include "harness/host/manifest.hpp"

#include <bit>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

#include "harness/core/file.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/core/toml.hpp"
#include "harness/port/port.hpp"

namespace attest {
namespace {

constexpr const char* heading =
    "# The inputs that `attest vectors` wrote, and how their outputs are to be read.\n"
    "#\n"
    "# Write the outputs for PROFILE/GROUP/NAME/RATE.csv next to it, as RATE.out.csv or\n"
    "# RATE.out.mat: a column for each output signal (`attest list --channels`), a row for each\n"
    "# row of the inputs. A column `timestamp` is checked if there is one. Then:\n"
    "#\n"
    "#     attest run --port recorded:FOLDER\n"
    "#\n"
    "# You may change the values of these tables:\n"
    "#\n"
    "#     [port]     name, version; arithmetic = \"fixed:22\" of a port in fixed point;\n"
    "#                unsupported_groups; lacks: outputs, features and constant parameters\n"
    "#                that the port has not, such as \"mc_att_ctrl_status\" or \"battery\"\n"
    "#     [outputs]  time: the unit of `timestamp`, \"s\", \"ms\" or \"us\"\n"
    "#     [columns]  your name = \"its signal\", for columns that have other names\n"
    "\n";

std::vector<std::string> texts(const TomlTable& table, std::string_view key) {
  return table.has(key) ? table.texts(key) : std::vector<std::string>{};
}

// The output channels with that name. An error at `key` if there is none.
ChannelSet outputs_named(const std::string& name, const TomlTable& table, std::string_view key) {
  if (name == "timestamp" || name.starts_with("out/")) {
    if (const ChannelSet named = channels_named(name); named.any()) return named;
  }
  std::vector<std::string> names{"timestamp"};
  for (const std::string_view known : names_of(ChannelSet().set())) {
    if (known.starts_with("out/")) names.emplace_back(known);
  }
  table.error(key, fmt::format("no output signal `{}`{}; `attest list --channels` shows all", name,
                               suggestion(name, names)));
  return {};
}

void read_port(const TomlTable& table, Manifest& manifest) {
  manifest.port_name = table.text("name", manifest.port_name);
  manifest.port_version = table.text("version", "");
  manifest.unsupported_groups = texts(table, "unsupported_groups");
  const auto wrong =
      wrong_in_declared(manifest.port_name, manifest.port_version, manifest.unsupported_groups);
  if (!wrong.empty()) table.error("name", wrong);
  const auto lacks = Lacks::parse(texts(table, "lacks"));
  if (lacks) manifest.lacks = *lacks;
  if (!lacks) table.error("lacks", lacks.error().message);
  if (const std::string arithmetic = table.text("arithmetic", ""); !arithmetic.empty()) {
    const auto bits = parse_fraction_bits(arithmetic);
    if (bits) manifest.fraction_bits = *bits;
    if (!bits) table.error("arithmetic", bits.error().message);
  }
  if (const std::string step = table.text("fixed_step_hz", ""); !step.empty()) {
    const auto rate = Rate::parse(step);
    if (rate) manifest.fixed_step = *rate;
    if (!rate) table.error("fixed_step_hz", rate.error().message);
  }
}

void read_outputs(const TomlTable& table, Manifest& manifest) {
  manifest.time = table.text("time", manifest.time);
  if (manifest.time != "s" && manifest.time != "ms" && manifest.time != "us") {
    table.error("time", fmt::format("`{}` is no unit of time; write s, ms or us", manifest.time));
  }
}

}  // namespace

Result<Manifest> read_manifest(const std::filesystem::path& folder) {
  const auto toml = TomlFile::read(folder / manifest_name);
  if (!toml) return tl::unexpected(toml.error());
  const TomlTable root = toml->root();
  Manifest manifest;
  if (root.has("port")) read_port(root.table("port"), manifest);
  if (root.has("outputs")) read_outputs(root.table("outputs"), manifest);
  if (root.has("columns")) {
    const TomlTable table = root.table("columns");
    for (const std::string& name : table.keys()) {
      manifest.columns[name] = table.text(name);
      outputs_named(manifest.columns[name], table, name);
    }
  }
  if (root.has("parameters")) {
    const TomlTable table = root.table("parameters");
    for (const std::string& name : table.keys()) {
      manifest.parameters.push_back({0, name, static_cast<float>(table.number(name))});
    }
  }
  const TomlTable vectors = root.table("vectors");
  for (const std::string& id : vectors.keys()) manifest.vectors[id] = vectors.text(id);
  if (auto done = toml->finish(); !done) return tl::unexpected(done.error());
  return manifest;
}

Result<void> write_manifest(const std::filesystem::path& folder, const Manifest& manifest) {
  TomlWriter toml;
  toml.set("port", "name", manifest.port_name);
  toml.set("port", "version", manifest.port_version);
  toml.set("port", "unsupported_groups", manifest.unsupported_groups);
  const std::string arithmetic =
      manifest.fraction_bits ? fmt::format("fixed:{}", *manifest.fraction_bits) : "";
  toml.set("port", "lacks", manifest.lacks.words);
  toml.set("port", "arithmetic", arithmetic);
  if (manifest.fixed_step) toml.set("port", "fixed_step_hz", manifest.fixed_step->to_string());
  toml.set("outputs", "time", manifest.time);
  for (const auto& [name, channel] : manifest.columns) toml.set("columns", name, channel);
  for (const ParameterChange& set : manifest.parameters) {
    toml.set("parameters", set.name, static_cast<double>(set.value));
  }
  for (const auto& [id, hash] : manifest.vectors) toml.set("vectors", id, hash);
  return write_file(folder / manifest_name, heading + toml.to_string());
}

std::string sha256_of_inputs(const Trace& trace) {
  std::string bytes;
  for (const Column& column : inputs_of(trace)) {
    bytes += column.name;
    for (const double value : column.values) {
      const auto bits = std::bit_cast<std::uint64_t>(value);
      bytes.append(reinterpret_cast<const char*>(&bits), sizeof bits);
    }
  }
  return sha256(bytes);
}

namespace {

// PROFILE/GROUP/NAME/RATE: the path of a vector's files without their extension.
std::string stem_of(const std::string& vector_id) {
  std::string stem = vector_id;
  if (const std::size_t at = stem.rfind('@'); at != std::string::npos) stem[at] = '/';
  return stem;
}

}  // namespace

std::filesystem::path input_file(const std::string& vector_id, const FileFormat& format) {
  return fmt::format("{}.{}", stem_of(vector_id), format.name);
}

std::string wanted_output_file(const std::filesystem::path& folder, const std::string& vector_id) {
  return (folder / (stem_of(vector_id) + ".out.csv")).string();
}

Result<std::filesystem::path> find_output_file(const std::filesystem::path& folder,
                                               const std::string& vector_id) {
  std::filesystem::path found;
  for (const FileFormat& format : file_formats()) {
    if (format.read_table == nullptr) continue;
    const auto path = folder / fmt::format("{}.out.{}", stem_of(vector_id), format.name);
    // A symbolic link counts as a file even if its target is missing: reading it gives an error.
    std::error_code ignored;
    const auto status = std::filesystem::symlink_status(path, ignored);
    if (!std::filesystem::exists(status)) continue;
    if (!found.empty()) {
      return fail_at(found.string(),
                     fmt::format("there is also {}; remove one of them", path.string()));
    }
    found = path;
  }
  return found;
}

}  // namespace attest
