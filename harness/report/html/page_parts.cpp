#include "harness/report/html/page_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/file.hpp"
#include "harness/report/html/base64.hpp"
#include "harness/report/html/embedded.hpp"

namespace attest {
namespace {

// Runs before the body is shown. The class `scripted` hides the table of all results, so that a
// browser does not lay it out; page.js replaces it by a list.
constexpr std::string_view boot_script = "document.documentElement.classList.add('scripted')";

// 'sha256-...' of a script, as a content security policy names it.
std::string policy_hash(std::string_view script) {
  const std::string hex = sha256(script);
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  return fmt::format("'sha256-{}'", base64(bytes));
}

}  // namespace

data text(std::string_view value) { return data(std::string(value)); }

void set_text(data& out, const char* name, std::string_view value) {
  if (!value.empty()) out.set(name, text(value));
}

std::string_view symbol_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "\u2713";  // check mark
    case Verdict::fail:
      return "\u2717";  // ballot x
    case Verdict::crash:
      return "\u2738";  // star
    case Verdict::timeout:
      return "\u25f7";  // clock face
    case Verdict::protocol:
      return "\u00a7";  // section sign
    case Verdict::non_finite:
      return "\u221e";  // infinity
    case Verdict::unsupported:
      return "\u2013";  // dash
    case Verdict::skip:
      return "\u25cb";  // circle
    case Verdict::xfail:
      return "\u25c7";  // white diamond
    case Verdict::xpass:
      return "\u25c6";  // black diamond
  }
  return "";
}

void add_files(data& page, const std::vector<std::pair<const char*, std::string_view>>& scripts) {
  std::vector<std::pair<const char*, std::string_view>> all = {
      {"boot", boot_script},
      {"dygraphs", dygraphs_script()},
      {"synchronizer", dygraphs_synchronizer()},
      {"shared_script", shared_script()}};
  all.insert(all.end(), scripts.begin(), scripts.end());
  std::vector<std::string> hashes;
  for (const auto& [name, script] : all) {
    set_text(page, name, script);
    hashes.push_back(policy_hash(script));
  }
  set_text(page, "script_hashes", fmt::format("{}", fmt::join(hashes, " ")));
  set_text(page, "style", page_style());
  set_text(page, "results_style", results_style());
  set_text(page, "dygraphs_style", dygraphs_style());
  set_text(page, "dygraphs_licence", dygraphs_licence());
}

}  // namespace attest
