// What is assumed of a flight whose log has no sample of a topic.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/ulog/log_contents.hpp"

namespace attest {

// The words of --assume, each once: all, or those of a module. If `by_default` is true, only those
// that hold without --assume.
std::vector<std::string> assumption_words();
std::vector<std::string> assumption_words(Module module, bool by_default);

// Sets the inputs of `sample`, which is the sample before the first step, as these words say for
// this module. Without words, the default ones are used. `updated` is set for their topics. Topics
// with samples in the log are left out. Returns the words that were used.
std::vector<std::string> assume(const std::vector<std::string>& words,
                                const ulog::ModuleContents& log, Sample& sample);

// Errors: an unknown word; one that no module of the log has; one for topics that the log has.
Result<void> check_assumed(const std::vector<std::string>& words,
                           std::span<const ulog::ModuleContents* const> modules);

}  // namespace attest
