// Functions for all pages: their styles and scripts, the symbols of verdicts, data for mustache.
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

// Does not set an empty value, because mustache shows a section also for an empty text.
void set_text(data& out, const char* name, std::string_view value);

template <typename Items, typename ToData>
data list_of(const Items& items, ToData to_data) {
  data list(data::type::list);
  for (const auto& item : items) list.push_back(to_data(item));
  return list;
}

std::string_view symbol_of(Verdict verdict);  // one character

// Adds the styles, dygraphs, the shared script and `scripts` under their names in the template, and
// the hashes of all scripts for the content security policy.
void add_files(data& page, const std::vector<std::pair<const char*, std::string_view>>& scripts);

}  // namespace attest
