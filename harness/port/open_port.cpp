// The table of the kinds of port, and what is asked of a kind by the specification of a port.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <elf.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "harness/core/file.hpp"
#include "harness/port/builtin.hpp"
#include "harness/port/fault_port.hpp"
#include "harness/port/port.hpp"
#include "harness/port/port_files.hpp"
#include "harness/port/program_port.hpp"

namespace attest {

Result<std::unique_ptr<Port>> open_shared_library(const std::string& path);  // shared_library.cpp

namespace {

std::vector<std::string> files_of_folder(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& file : files_below(folder).value_or(std::vector<std::filesystem::path>())) {
    files.push_back(file.string());
  }
  return files;
}

// An ELF file without an interpreter. A program, also one that may be loaded at any address, names
// the dynamic linker as its interpreter.
bool is_shared_library(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Elf64_Ehdr head{};
  file.read(reinterpret_cast<char*>(&head), sizeof head);
  if (!file || std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 || head.e_type != ET_DYN) {
    return false;
  }
  for (std::uint16_t i = 0; i < head.e_phnum; ++i) {
    Elf64_Phdr part{};
    file.seekg(static_cast<std::streamoff>(head.e_phoff + i * sizeof part));
    file.read(reinterpret_cast<char*>(&part), sizeof part);
    if (file && part.p_type == PT_INTERP) return false;
  }
  return true;
}

Result<std::unique_ptr<Port>> refuse_unknown(const std::string& specification) {
  std::error_code unreadable;
  if (std::filesystem::is_regular_file(specification, unreadable)) {
    if (specification.ends_with(".py")) {
      return fail(fmt::format("{0}: is not executable; write `proc:python3 {0}`", specification));
    }
    return fail(
        fmt::format("{}: neither a shared library nor an executable file; a port is one of "
                    "{}",
                    specification, names_of_port_kinds(true)));
  }
  const std::filesystem::path path = specification;
  if (std::filesystem::is_directory(path, unreadable)) {
    const bool is_python = std::filesystem::exists(path / "port.py", unreadable);
    const std::string name = is_python ? "port.py" : "port.so";
    return fail(
        fmt::format("{}: is a folder, not a port; name the library or program in it, such "
                    "as {}, or start its script {}",
                    specification, (path / name).string(), (path / "check").string()));
  }
  if (path.has_extension() || path.has_parent_path()) {
    const std::filesystem::path script = path.parent_path() / "check";
    const bool is_unbuilt = std::filesystem::is_regular_file(script, unreadable);
    return fail(
        fmt::format("{}: no such file{}; a port is a file or one of {}", specification,
                    is_unbuilt ? "; build it, as the script " + script.string() + " does" : "",
                    names_of_port_kinds(true)));
  }
  return fail(
      fmt::format("unknown port `{}`; use one of {}", specification, names_of_port_kinds(true)));
}

// In the order of the help.
constexpr PortKind kinds[] = {
    {"builtin", "", false, nullptr,
     [](const std::string&) -> Result<std::unique_ptr<Port>> { return open_builtin(); }},
    {"lib:", "PATH", false, [](const std::string& path) { return std::vector{path}; },
     open_shared_library},
    {"proc:", "COMMAND", true, files_of_program, open_program},
    {"fault:", "ID", false, nullptr, [](const std::string& ids) { return open_fault(ids); }},
    {"recorded:", "DIR", false, files_of_folder, nullptr},
};
constexpr PortKind unknown_kind{"", "", false, nullptr, refuse_unknown};

}  // namespace

const PortKind& kind_of(const std::string& specification) {
  for (const PortKind& kind : kinds) {
    if (kind.argument.empty() ? specification == kind.prefix
                              : specification.starts_with(kind.prefix)) {
      return kind;
    }
  }
  return unknown_kind;
}

std::string argument_of(const std::string& specification) {
  return specification.substr(kind_of(specification).prefix.size());
}

std::string port_of_file(const std::string& given) {
  const std::filesystem::path file = given;
  std::error_code unreadable;
  if (!kind_of(given).prefix.empty() || !std::filesystem::is_regular_file(file, unreadable)) {
    return given;
  }
  // dlopen() and a shell look for a name without a folder elsewhere.
  const std::string path = file.has_parent_path() ? given : "./" + given;
  if (is_shared_library(path)) return "lib:" + path;
  return ::access(path.c_str(), X_OK) == 0 ? "proc:" + path : given;
}

std::vector<std::string> files_of(const std::string& specification) {
  const PortKind& kind = kind_of(specification);
  return kind.files ? kind.files(argument_of(specification)) : std::vector<std::string>();
}

std::string names_of_port_kinds(bool only_callable) {
  std::vector<std::string> names;
  for (const PortKind& kind : kinds) {
    if (only_callable && !kind.is_callable()) continue;
    names.push_back(fmt::format("`{}{}`", kind.prefix, kind.argument));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

Result<std::unique_ptr<Port>> open_port(const std::string& specification, const PortFiles* files) {
  if (files != nullptr) {
    if (auto same = files->check(PortFiles::Untouched::skipped); !same) {
      return tl::unexpected(same.error());
    }
  }
  const PortKind& kind = kind_of(specification);
  return kind.open ? kind.open(argument_of(specification)) : refuse_unknown(specification);
}

}  // namespace attest
