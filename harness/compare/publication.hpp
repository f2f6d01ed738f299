// Which outputs a step published: the flag `published` of each topic, of any module.
#pragma once

#include "harness/trace/channels.hpp"

namespace attest {

// Whether the topic of this output was published. Mixer and battery estimate publish at every step.
// REQUIRES: an output of the module of `sample`.
bool is_published(const Channel& output, const Sample& sample);

}  // namespace attest
