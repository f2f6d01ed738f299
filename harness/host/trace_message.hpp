// Parts of the messages between a process and a fork of it (host_protocol.hpp): structs are sent as
// they are in memory, all other data in the JSON of the head. Functions that read a head report a
// member that is missing, of another type or out of its range to the reader, and then return a
// value in the range.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/casefile/run_configuration.hpp"
#include "harness/core/json_reader.hpp"
#include "harness/loop/unit_driver.hpp"
#include "harness/plant/plant.hpp"
#include "harness/process/child.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The values are sent as bits, because JSON has no NaN.
nlohmann::json changes_json(const std::vector<ParameterChange>& changes);
// Range: ticks up to `ticks`. A name is any text: the judge compares it with that of the case.
std::vector<ParameterChange> changes_from(JsonReader& head, const char* key, std::size_t ticks);

// Of a flight: the plant configuration is set. The judge is trusted.
nlohmann::json to_json(const RunConfiguration& configuration);
RunConfiguration configuration_from(const nlohmann::json& json);

// Writes and reads how a port's outputs, or its flight, ended. Range: a tick up to `ticks`, a time
// from 0 to `longest`. A process cannot report its own crash or timeout. If the port is a program
// (`of_program`), its process can report the program's crash.
void set_end(const std::optional<PortFault>& fault, const std::optional<Divergence>& lost,
             nlohmann::json& head);
std::optional<PortFault> fault_from(JsonReader& head, std::size_t ticks, bool of_program);
// Adds what the port last printed: before it reported a failure, or, if it is a program, before it
// ended or broke the protocol.
std::optional<PortFault> with_words(std::optional<PortFault> fault, const Child& child,
                                    bool of_program);
std::optional<Divergence> divergence_from(JsonReader& head, Nanoseconds longest);

// The member `error` of a head.
tl::unexpected<Error> error_in(JsonReader& head);

// Reads the blobs that follow a head, one after the other.
class BlobReader {
 public:
  // `read` fills the given memory; it returns false if it failed.
  BlobReader(std::vector<std::size_t> sizes, std::function<bool(void*, std::size_t)> read)
      : sizes_(std::move(sizes)), read_(std::move(read)) {}

  std::size_t left() const { return sizes_.size() - next_; }

  // The next blob. Empty when it does not arrive, or does not have the size of `count` objects.
  // REQUIRES: there is memory for `count` objects, so the caller must not take `count` from an
  // untrusted process.
  template <typename T>
  std::optional<std::vector<T>> read(std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (left() == 0 || sizes_[next_] != count * sizeof(T)) return std::nullopt;
    ++next_;
    std::vector<T> objects(count);
    if (!read_(objects.data(), count * sizeof(T))) return std::nullopt;
    return objects;
  }

 private:
  std::vector<std::size_t> sizes_;
  std::size_t next_ = 0;
  std::function<bool(void*, std::size_t)> read_;
};

// The next blob, which must have `count` objects.
template <typename T>
std::vector<T> objects_from(BlobReader& blobs, std::size_t count, const char* what,
                            JsonReader& head) {
  auto objects = blobs.read<T>(count);
  if (objects) return *std::move(objects);
  head.wrong(std::string("the ") + what + " have a wrong size");
  return {};
}

}  // namespace attest
