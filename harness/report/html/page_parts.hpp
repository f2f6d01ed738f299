// What the pages have in common: their files, the symbols of verdicts, data for mustache.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <kainjow/mustache.hpp>

#include "harness/verify/verdict.hpp"

namespace attest {

using kainjow::mustache::data;

data text(std::string_view value);

// An empty value stays absent: mustache shows a section for each text, empty ones too.
void set_text(data& out, const char* name, std::string_view value);

template <typename Items, typename ToData>
data list_of(const Items& items, ToData to_data) {
  data list(data::type::list);
  for (const auto& item : items) list.push_back(to_data(item));
  return list;
}

std::string_view symbol_of(Verdict verdict);  // one character

// Adds the styles, dygraphs, the shared script and these scripts, by the names in the template, and
// the hashes of all scripts for the content security policy.
void add_files(data& page, const std::vector<std::pair<const char*, std::string_view>>& scripts);

}  // namespace attest
