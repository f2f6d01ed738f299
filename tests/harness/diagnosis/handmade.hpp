// Handmade similarities: vectors of 10 ticks, the failing ones first.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "harness/diagnosis/diagnose.hpp"

namespace attest {

inline constexpr std::size_t ticks = 10;

// Faults of three stages, in the order of the catalogue.
inline constexpr const char* tilt_fault = "tilt-in-world";
inline constexpr const char* yaw_fault = "yaw-weight-dropped";
inline constexpr const char* tpa_fault = "tpa-missing";

inline std::size_t index_of(const char* id) {
  const auto all = faults::catalogue();
  const auto found = std::find(all.begin(), all.end(), faults::find_fault(id));
  EXPECT_NE(found, all.end()) << id;
  return static_cast<std::size_t>(found - all.begin());
}

class HandMade {
 public:
  // At first no fault matches any tick.
  HandMade(std::size_t failing, std::size_t passing) {
    VectorSimilarity vector;
    vector.ticks = ticks;
    vector.similarities.resize(faults::catalogue().size());
    vector.deviates = true;
    vectors_.assign(failing, vector);
    vector.deviates = false;
    vectors_.insert(vectors_.end(), passing, vector);
    for (std::size_t i = 0; i < vectors_.size(); ++i) {
      vectors_[i].case_id = "case " + std::to_string(i);
    }
  }

  Similarity& of(const char* id, std::size_t vector) {
    return vectors_.at(vector).similarities[index_of(id)];
  }
  // The fault matches `matched` ticks in each of the vectors from `first` to before `end`.
  HandMade& matches(const char* id, std::size_t first, std::size_t end,
                    std::size_t matched = ticks) {
    for (std::size_t vector = first; vector < end; ++vector) of(id, vector).matched = matched;
    return *this;
  }
  // Numbers of values of a vector that deviate: in both port and fault, or in either.
  HandMade& deviates(const char* id, std::size_t vector, std::size_t both, std::size_t either) {
    of(id, vector).intersection = both;
    of(id, vector).union_size = either;
    return *this;
  }

  // The stages of the port's first deviation.
  HandMade& deviates_first(std::size_t vector, const StageSet& stages) {
    vectors_.at(vector).stages = stages;
    return *this;
  }

  // These sets of calls of the C library give the port's outputs.
  HandMade& explained_by(std::size_t vector, std::initializer_list<LibraryCalls> sets) {
    for (const LibraryCalls calls : sets) {
      matches_with(vector, calls, ticks);
    }
    return *this;
  }
  // With these calls, the reference has the port's outputs at `matched` ticks.
  HandMade& matches_with(std::size_t vector, LibraryCalls calls, std::size_t matched) {
    vectors_.at(vector).library.with_set.resize(library_call_sets);
    vectors_.at(vector).library.with_set[calls] = matched;
    return *this;
  }
  HandMade& matches_with(std::size_t vector, const LibraryCall& single, std::size_t matched) {
    vectors_.at(vector).library.with_single[single] = matched;
    return *this;
  }

  operator const std::vector<VectorSimilarity>&() const { return vectors_; }

 private:
  std::vector<VectorSimilarity> vectors_;
};

inline std::vector<std::string_view> ids_of(const std::vector<const faults::Fault*>& faults) {
  std::vector<std::string_view> ids;
  for (const faults::Fault* fault : faults) ids.push_back(fault->id);
  return ids;
}

inline std::vector<std::string_view> suspected(const Diagnosis& diagnosis) {
  std::vector<const faults::Fault*> faults;
  for (const Suspect& suspect : diagnosis.suspects) faults.push_back(suspect.fault);
  return ids_of(faults);
}

}  // namespace attest
