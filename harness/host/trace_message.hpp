// Parts of the messages between a process and a fork of it (host_protocol.hpp): structs are sent as
// they are in memory, all other data in the JSON of the head. Functions that read a head throw
// nlohmann::json::exception if a member is missing or of another type.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/core/large_pages.hpp"
#include "harness/loop/unit_driver.hpp"
#include "harness/plant/plant.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The values are sent as bits, because JSON has no NaN.
nlohmann::json changes_json(const std::vector<ParameterChange>& changes);
std::vector<ParameterChange> changes_from(const nlohmann::json& list);

// Writes and reads how a port's outputs, or its flight, ended. A process cannot report its own
// crash or timeout: if it does, the fault is read as one of kind protocol. If the port is a program
// (`of_program`), the process can report the program's crash.
void set_end(const std::optional<PortFault>& fault, const std::optional<Divergence>& lost,
             nlohmann::json& head);
std::optional<PortFault> fault_from(const nlohmann::json& head, bool of_program);
std::optional<Divergence> divergence_from(const nlohmann::json& head);

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
    std::vector<T> objects;
    reserve_large(objects, count);
    objects.resize(count);
    if (!read_(objects.data(), count * sizeof(T))) return std::nullopt;
    return objects;
  }

 private:
  std::vector<std::size_t> sizes_;
  std::size_t next_ = 0;
  std::function<bool(void*, std::size_t)> read_;
};

}  // namespace attest
