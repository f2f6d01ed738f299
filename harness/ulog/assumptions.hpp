// Assumptions about a flight, for topics of which its log has no sample.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/ulog/log_contents.hpp"

namespace attest {

// The words of --assume, each once: all words, or those of a module. If `by_default` is true, only
// the words that hold without --assume.
std::vector<std::string> assumption_words();
std::vector<std::string> assumption_words(Module module, bool by_default);

// Sets the inputs of `sample`, the sample before the first step, as these words say for the module
// of `log`. Without words, the default words are used. The bits of their topics in `updated` are
// set. Topics with samples in the log stay as they are. Returns the words that had an effect.
std::vector<std::string> assume(const std::vector<std::string>& words,
                                const ulog::ModuleContents& log, Sample& sample);

// Errors: a word that none of the modules has; a word whose topics all have samples in the log.
Result<void> check_assumed(const std::vector<std::string>& words,
                           std::span<const ulog::ModuleContents* const> modules);

}  // namespace attest
