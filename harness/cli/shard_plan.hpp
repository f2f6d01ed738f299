// `attest sweep --plan`: the files with which another program flies the shards of a sweep on many
// machines.
#pragma once

#include "harness/cli/globals.hpp"
#include "harness/cli/prepare_sweep.hpp"
#include "harness/core/result.hpp"

namespace attest::cli {

// Makes the folder options.out, and returns a text that tells the user what to do with it. For
// machines that share the folder it also makes the folder of each shard, with the identity of its
// results: a machine with another attest, sweep, vehicle or port is then refused before it flies.
// Errors: an unknown kind of plan; more shards than samples or than the program allows; a path that
// the machines of a CI service do not have; a name with a control character.
Result<std::string> plan_shards(const PreparedSweep& sweep, const SweepOptions& options,
                                const Globals& globals);

}  // namespace attest::cli
