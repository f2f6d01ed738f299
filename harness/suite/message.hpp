// What a worker process says to its parent: one JSON object a line.
//
//     {"begin": 3}                 task 3 begins, or a part of it: the time limit starts anew, at
//                                  most as often as the task has parts
//     {"result": {...}}            the verdict on it, or
//     {"error": {...}}             why there is none
//     {"done": true}               after the last task
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>

#include "harness/core/result.hpp"
#include "harness/suite/verdict.hpp"

namespace attest {

struct TaskBegins {
  std::size_t task;
};
struct BatchDone {};

using Message = std::variant<TaskBegins, CaseResult, Error, BatchDone>;

std::string encode(const Message& message);

// Empty when the line is none of the above. The worker shares its process with a port, so nothing
// is taken on trust: the pool accepts a message only in its turn.
std::optional<Message> decode(const std::string& line);

}  // namespace attest
