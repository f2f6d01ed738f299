// What a port declares that it has not (Lacks): which vectors cannot be judged because of it, and
// which declarations are not true.
#pragma once

#include <vector>

#include "harness/compare/tolerance.hpp"
#include "harness/host/port_host.hpp"
#include "harness/loop/flight.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// Adds the constants of the port that differ from the defaults to `parameters`, which replace those
// of the inputs. False, and the result is unsupported: the inputs or `parameters` give one of the
// constants another value. VectorResult::lacking then names it.
bool adds_constants(const Lacks& lacks, const ModuleUnderTest& subject, const Trace& inputs,
                    std::vector<ParameterChange>& parameters, VectorResult& result);

// The features that the port lacks and these inputs use.
FeatureSet lacking_features(const Lacks& lacks, const Trace& inputs,
                            const ModuleUnderTest& subject);

// A judged vector that uses features which the port lacks becomes unsupported. If it passed, and
// uses one of them only, VectorResult::has_after_all names it.
void leave_out(const FeatureSet& lacking, VectorResult& result);

// Adds the output topics that the port lacks, but publishes, to VectorResult::has_after_all.
void note_published(const Lacks& lacks, const Trace& answered, VectorResult& result);

// Whether the flight needs an output that the port lacks: one that the other units or the motors
// read. The result is then unsupported.
bool excludes_flight(const Lacks& lacks, const Case& the_case, VectorResult& result);

// The features that the port lacks and the flight used. Sets the result to unsupported if the port
// has other constants than the flight.
FeatureSet lacking_features(const Lacks& lacks, const Flown& flown, VectorResult& result);

// Whether the port has the parameter VectorResult::lacking after all: its outputs for `inputs`,
// which give it another value than that of the constant, agree with the law's. If so,
// VectorResult::has_after_all names it. The value does not matter here if the law's outputs are the
// same with that of the constant: then clears `lacking`.
void try_constant(const ModuleUnderTest& subject, const Trace& inputs, const Tolerances& tolerances,
                  PortHost& host, VectorResult& result);

// What the port declares that it lacks, but has: an output topic that it published, and a feature
// or a parameter if all vectors pass that use it and no other one that the port lacks.
std::vector<std::string> needless_lacks(const std::vector<VectorResult>& results);

}  // namespace attest
