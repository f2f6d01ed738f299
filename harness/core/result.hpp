// A value, or an error that a person can act on.
//
// Each kind of failure has its own channel. Bad input is an Error with its place. A bug of attest
// ends the program with an error (or, in a child process, an abort). A failure of a port under test
// is a verdict (verify/verdict.hpp), never an Error.
#pragma once

#include <string>

#include <tl/expected.hpp>

namespace attest {

// What is wrong, where, and what to do. `file` is empty when there is no file; `line` and `column`
// count from 1 and are 0 when unknown.
struct Error {
  std::string message;
  std::string file = {};
  int line = 0;
  int column = 0;

  // "file:line:column: message", without the unknown parts.
  std::string to_string() const;
};

template <typename T>
using Result = tl::expected<T, Error>;

// For the return statement: `return fail("no such group");`. The message may quote a file or a
// port, so printable() is applied to it.
tl::unexpected<Error> fail(const std::string& message);
tl::unexpected<Error> fail_at(std::string file, const std::string& message, int line = 0,
                              int column = 0);

}  // namespace attest
