// The table behind channels(), for this folder.
#pragma once

#include <array>

#include "harness/trace/channels.hpp"

namespace attest {

extern const std::array<Channel, max_channels> channel_table;

}  // namespace attest
