#include "tests/harness/casefile/case_files.hpp"

#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

namespace attest {

namespace fs = std::filesystem;

fs::path CaseFiles::write(std::string_view group, std::string_view name, std::string_view text,
                          std::string_view profile) const {
  const fs::path place = folder() / profile / group;
  fs::create_directories(place);
  const fs::path file = place / (std::string(name) + ".toml");
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

void CaseFiles::name_vehicle(std::string_view name) const {
  const fs::path models = folder().parent_path() / "models";
  fs::create_directories(models);
  std::ofstream(models / (std::string(name) + ".toml"));
}

std::string CaseFiles::with(std::string_view body) {
  return "schema = 1\nprofiles = [\"px4-v1.5.5\"]\ngroup = \"tests\"\nwhy = \"a test\"\n"
         "duration_ticks = 10\n" +
         std::string(body);
}

Result<Case> CaseFiles::parse(std::string_view text) const {
  return parse_case(write("tests", "the_case", text));
}

Case case_of(std::string_view body) {
  auto parsed = CaseFiles().parse(CaseFiles::with(body));
  if (!parsed) throw std::invalid_argument(parsed.error().to_string());
  return *std::move(parsed);
}

Case unit_case_of(Module module, std::string_view profile, std::string_view body) {
  const std::string text = fmt::format(
      "schema = 1\nprofiles = [\"{}\"]\ngroup = \"tests\"\nmodule = \"{}\"\nwhy = \"a test\"\n"
      "duration_ticks = 10\n{}",
      profile, name_of(module), body);
  const CaseFiles files;
  auto parsed = parse_case(files.write("tests", "the_case", text, profile));
  if (!parsed) throw std::invalid_argument(parsed.error().to_string());
  return *std::move(parsed);
}

std::string errors_of_text(std::string_view text) {
  const auto parsed = CaseFiles().parse(text);
  if (parsed) return "";
  std::string all = parsed.error().to_string();
  const std::string file = parsed.error().file + ":";
  for (std::size_t at; (at = all.find(file)) != std::string::npos;) all.erase(at, file.size());
  return all;
}

std::string errors_of(std::string_view body) { return errors_of_text(CaseFiles::with(body)); }

}  // namespace attest
