#include "harness/core/suggestion.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace attest {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// The least number of edits that turn `a` into `b`: insertions, deletions, substitutions, swaps of
// two neighbours. Ignores case, so that mc_roll_p suggests MC_ROLL_P.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> two_above(b.size() + 1);
  std::vector<std::size_t> above(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_above.swap(above);
    above.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0u : 1u)});
      const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                           lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], two_above[j - 2] + 1);
    }
  }
  return row[b.size()];
}

// Other names for a thing, which no distance finds.
struct Synonym {
  std::string_view unknown, known;
};
constexpr std::array synonyms{Synonym{"c++", "cpp"}, Synonym{"--seconds", "--duration"}};

bool are_synonyms(std::string_view unknown, std::string_view candidate) {
  return std::ranges::any_of(synonyms, [&](const Synonym& one) {
    return one.unknown == unknown && one.known == candidate;
  });
}

// "px4-v1.18" of "px4-v1.18.0": a release without its last number.
std::string_view release_of(std::string_view name) {
  const std::size_t dot = std::min(name.find('.'), name.size());
  return name.substr(0, name.find('.', dot + 1));
}

}  // namespace

std::string suggestion(std::string_view unknown, const std::vector<std::string>& candidates) {
  // A text of more than 200 bytes is not a misspelt name, but comes from a file of another kind.
  constexpr std::size_t longest_name = 200;
  if (unknown.size() > longest_name) return "";
  // It is known, but not with the options that were given.
  if (std::ranges::find(candidates, unknown) != candidates.end()) return "";
  for (const std::string& candidate : candidates) {
    if (are_synonyms(unknown, candidate)) return fmt::format("; did you mean `{}`?", candidate);
  }
  for (const std::string& candidate : candidates) {  // v1.5.5 and 1.5.5 for px4-v1.5.5
    const bool is_end = !unknown.empty() && candidate.ends_with(unknown) && candidate != unknown;
    const bool lacks_v = !unknown.empty() && candidate.ends_with("-v" + std::string(unknown));
    if (lacks_v || (is_end && candidate[candidate.size() - unknown.size() - 1] == '-')) {
      return fmt::format("; did you mean `{}`?", candidate);
    }
  }
  // px4-v1.16 and v1.16 for px4-v1.16.0, px4-v1.18.0 and v1.18.0 for px4-v1.18
  const std::string_view release = release_of(unknown);
  for (const std::string& candidate : candidates) {
    const std::string begin = std::string(unknown) + ".";
    const std::size_t part = candidate.find('-') + 1;  // 0: it has one part
    const bool is_release = release.size() < unknown.size() &&
                            (release_of(candidate) == release ||
                             release_of(std::string_view(candidate).substr(part)) == release);
    if (is_release || candidate.starts_with(begin) ||
        candidate.compare(part, begin.size(), begin) == 0) {
      return fmt::format("; did you mean `{}`?", candidate);
    }
  }
  const std::size_t allowed = (unknown.size() + 1) / 3;
  const std::string* best = nullptr;
  std::size_t best_distance = allowed + 1;
  for (const std::string& candidate : candidates) {
    // Saves time: the distance is at least the difference of the lengths.
    const std::size_t longer = std::max(unknown.size(), candidate.size());
    if (2 * longer - unknown.size() - candidate.size() >= best_distance) continue;
    const std::size_t d = distance(unknown, candidate);
    if (d >= best_distance) continue;
    best = &candidate;
    best_distance = d;
  }
  if (best == nullptr) {  // attitude for attitude_unit
    const auto longer = std::ranges::find_if(candidates, [&](const std::string& candidate) {
      return !unknown.empty() && candidate.starts_with(std::string(unknown) + "_");
    });
    if (longer != candidates.end()) best = &*longer;
  }
  return best == nullptr ? "" : fmt::format("; did you mean `{}`?", *best);
}

}  // namespace attest
